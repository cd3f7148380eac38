/* ethd-tap's command line. [main] */
#ifndef ETHD__APPS_TAP_OPTIONS_H
#define ETHD__APPS_TAP_OPTIONS_H

#include <stdbool.h>

#include "tap/study.h"

#define ETHD_TAP_WORDS 32
#define ETHD_TAP_GAINS 32

typedef struct ethd__tap_words {
  const char *words[ETHD_TAP_WORDS];
  size_t count;
} ethd__tap_words;

typedef struct ethd__tap_options {
  const char *config, *plant, *finger, *csv, *record, *trace; /* NULL: not given */
  ethd__movement_form form;                                   /* of the recorded movement; its length is scaled */
  double scale;
  bool scaled, force;
  bool paper;   /* ethd__paper_print instead of a table */
  int64_t taps; /* for each law and speed */
  uint64_t seed;
  ethd__tap_words laws, speeds; /* no law: ethd__tap_laws_choose */
  ethd__validity validity;
  uint32_t learn;
  ethd__gain gains[ETHD_TAP_GAINS];
  size_t gain_count;
} ethd__tap_options;

/* Reads the command line. Prints --help, or one line and exits 2. */
void ethd__tap_options_read(int argc, char **argv, ethd__tap_options *out);
void ethd__tap_options_free(ethd__tap_options *options);

/* If no law is asked for, chooses all of this library and the configuration's own. */
void ethd__tap_laws_choose(ethd__tap_options *options, const char *own);

#endif
