/* ethd-tap's command line. [main] */
#ifndef ETHD__APPS_TAP_OPTIONS_H
#define ETHD__APPS_TAP_OPTIONS_H

#include <stdbool.h>

#include "cli/cli.h"
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
  /* with an arm */
  const char *arm, *plot, *plugin; /* NULL: not given */
  double delay, gap, bias, rate;   /* s, NaN: the table's; m; m; Hz */
  double wall[4];                  /* normal and distance; all 0: not given */
} ethd__tap_options;

/* Reads the command line. Prints --help, or one line and exits 2. */
void ethd__tap_options_read(int argc, char **argv, ethd__tap_options *out);
void ethd__tap_options_free(ethd__tap_options *options);

/* Of the options with an arm; its input is an ethd__tap_options. */
extern const struct argp ethd__reach_argp;

/* Reads the words of --speed; exits 2 on another word. */
void ethd__speeds_read(const ethd__tap_words *words, const ethd_plant *plant, ethd__speed *out);

/* Without a --law, chooses all laws of this library and of the configuration; with an arm, own NULL, all laws for
   velocity commands. */
void ethd__tap_laws_choose(ethd__tap_options *options, const char *own);

#endif
