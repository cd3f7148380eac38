/* The study's tables: what each column holds, once, for their headers, the folder's README.md and the JSON sidecars.
   All [main]. */
#ifndef ETHD_STUDY_COLUMNS_H
#define ETHD_STUDY_COLUMNS_H

#include <stdio.h>

#include "study/protocol.h"

typedef enum ethd__study_table {
  ETHD_TABLE_TAPS,
  ETHD_TABLE_SURVEY,
  ETHD_TABLE_EVENTS,
  ETHD_TABLE_PARTICIPANTS,
  ETHD_TABLE_ORDERS,
  ETHD_TABLES
} ethd__study_table;

/* "taps", for taps.csv and taps.json. */
extern const char *const ethd__table_names[ETHD_TABLES];

/* "participant,block,..", freed by the caller; exit 1 without memory. The survey's ends with q1, q2 .. of the study;
   ethd__tap_row and those who write the others' rows follow its order. */
char *ethd__table_header(ethd__study_table table, const ethd__protocol *protocol);

/* A simulation's taps have more columns: study, point, those of taps, and the gains of the grid. Likewise. */
char *ethd__simulation_header(const ethd__protocol *protocol);

/* Whose tables they are. */
typedef struct ethd__table_scope {
  const ethd__protocol *protocol;
  const ethd_setup *setup; /* a simulation's, which knows the gains' units; NULL: the tables are a session's */
} ethd__table_scope;

/* Rows of a Markdown table: column, unit, meaning. */
void ethd__table_describe(FILE *file, ethd__study_table table, const ethd__table_scope *scope);

/* A JSON object: Description, Units and Levels of each column, as BIDS's sidecars have them. */
void ethd__table_sidecar(FILE *file, ethd__study_table table, const ethd__table_scope *scope);

/* dataset_description.json. */
void ethd__dataset_describe(FILE *file, const ethd__protocol *protocol);

#endif
