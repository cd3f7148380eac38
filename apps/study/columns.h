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

/* Rows of a Markdown table: column, unit, meaning. */
void ethd__table_describe(FILE *file, ethd__study_table table, const ethd__protocol *protocol);

/* A JSON object: Description, Units and Levels of each column, as BIDS's sidecars have them. */
void ethd__table_sidecar(FILE *file, ethd__study_table table, const ethd__protocol *protocol);

/* dataset_description.json. */
void ethd__dataset_describe(FILE *file, const ethd__protocol *protocol);

#endif
