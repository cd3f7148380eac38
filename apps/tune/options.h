/* ethd-tune's command line. [main] */
#ifndef ETHD__APPS_TUNE_OPTIONS_H
#define ETHD__APPS_TUNE_OPTIONS_H

#include "tune/score.h"

typedef struct ethd__tune_options {
  const char *plant, *config, *law, *out, *csv, *plot;
  const char *ranges[ETHD_TUNE_KEYS_MAX];
  size_t range_count;
  ethd__tune_hands hands;
  ethd__bounds_margin margin;
  bool passive;
  int prefer; /* the goal that counts twice; -1: none */
  int64_t points, taps;
  uint64_t seed;
} ethd__tune_options;

/* Reads the command line. Prints --help, or one line and exits 2. */
void ethd__tune_options_read(int argc, char **argv, ethd__tune_options *out);

#endif
