/* The commands of ethd-study: a session, a simulation, a merge, a check. All [main]; each returns the exit
   code, and ends the program on bad input. */
#ifndef ETHD__APPS_SCREEN_COMMANDS_H
#define ETHD__APPS_SCREEN_COMMANDS_H

#include "study/shard.h"
#include "study/sitting.h"
#include "study/stations.h"

typedef struct ethd__study_options {
  const char *study, *out, *resume, *finger, *merge, *export, *verify, *describe, *markers;
  const char *decision, *reason;             /* withdraw, exclude, include; of a tap: accept, reject */
  const char *word[ETHD_STUDY_STATIONS + 1]; /* arguments without an option: the study, or further stations */
  size_t word_count;
  int64_t first, last; /* participants, from 1; 0: all */
  ethd__about decided;
  int64_t simulate;
  ethd__shard shard;
  int width, height; /* px of the screen; 0: none */
  bool ask, quiet, sharded, is_virtual, plan, words, plugins;
} ethd__study_options;

/* Begins a session in `out` or continues the one in `resume`. */
int ethd__command_session(const ethd__study_options *o);

/* Simulates one shard. */
int ethd__command_shard(const ethd__study_options *o);

/* Merges the shards of one folder, or the sessions of several folders into `out`. */
int ethd__command_merge(const ethd__study_options *o);

/* Writes a folder's tables again from its store. */
int ethd__command_export(const ethd__study_options *o);

/* Records a decision about a participant or a tap. */
int ethd__command_decide(const ethd__study_options *o);

/* Prints the screen's words as a section of a study file. */
int ethd__command_words(const ethd__study_options *o);

/* Prints the orders. */
int ethd__command_plan(const ethd__study_options *o);

/* Writes the description of a study, from one folder or several stations. */
int ethd__command_describe(const ethd__study_options *o);

/* Checks a folder's sums. */
int ethd__command_verify(const ethd__study_options *o);

#endif
