/* The study's tables: says once what each column holds, for headers, the folder's README.md and the JSON sidecars.
   All [main]. */
#ifndef ETHD__APPS_STUDY_COLUMNS_H
#define ETHD__APPS_STUDY_COLUMNS_H

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

/* Names such as "taps", for taps.csv and taps.json. */
extern const char *const ethd__table_names[ETHD_TABLES];

/* Returns a table's header, "participant,block,..", which the caller frees; exit 1 without memory. The survey's ends
   with q1, q2 .. of the study, that of participants with before_q1 .. after_q1 ..  Rows must follow its order. */
char *ethd__table_header(ethd__study_table table, const ethd__protocol *protocol);

/* Does the same for a simulation's taps, which have more columns: study, point, those of taps, and the grid's gains. */
char *ethd__simulation_header(const ethd__protocol *protocol);

/* The study and the setup to which tables belong. */
typedef struct ethd__table_scope {
  const ethd__protocol *protocol;
  const ethd_setup *setup; /* a simulation's, which knows the gains' units; NULL: the tables are a session's */
} ethd__table_scope;

/* Writes rows of a Markdown table: column, unit, meaning. */
void ethd__table_describe(FILE *file, ethd__study_table table, const ethd__table_scope *scope);

/* Writes a JSON object: Description, Units and Levels of each column, as BIDS's sidecars have them. */
void ethd__table_sidecar(FILE *file, ethd__study_table table, const ethd__table_scope *scope);

/* Writes dataset_description.json. */
void ethd__dataset_describe(FILE *file, const ethd__protocol *protocol);

#endif
