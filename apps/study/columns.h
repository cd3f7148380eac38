/* The study's tables: the single definition of each column, for headers, the folder's README.md and the JSON sidecars.
   All [main]. */
#ifndef ETHD__APPS_STUDY_COLUMNS_H
#define ETHD__APPS_STUDY_COLUMNS_H

#include <stdbool.h>
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

/* The same for a simulation's taps, which have more columns: study, point, those of taps, and the grid's gains. */
char *ethd__simulation_header(const ethd__protocol *protocol);

/* The study and the setup to which tables belong. */
typedef struct ethd__table_scope {
  const ethd__protocol *protocol;
  const ethd_setup *setup; /* a simulation's, with the gains' units; NULL: the tables of a session */
} ethd__table_scope;

/* A column. levels: "word=meaning|..", NULL: none. */
typedef struct ethd__column {
  const char *name, *unit, *meaning, *levels;
} ethd__column;

typedef struct ethd__columns {
  const ethd__column *row;
  size_t count;
} ethd__columns;

/* Whether the table is a simulation's taps, which have more columns. */
bool ethd__is_simulated(ethd__study_table table, const ethd__table_scope *scope);

/* The columns of a table, and a simulation's columns before them. */
ethd__columns ethd__columns_of(ethd__study_table table);
ethd__columns ethd__columns_first(ethd__study_table table, const ethd__table_scope *scope);

/* Calls `each` for the questions with answers in the table, after its columns. */
void ethd__columns_asked(ethd__study_table table, const ethd__protocol *protocol, void *user,
                         void (*each)(void *user, const char *column, const ethd__question *question));

/* Returns a gain of the grid by its name, "section.key"; NULL if the configuration's own laws lack it, because it
   belongs to another strategy. */
const ethd_param *ethd__gain_of(const ethd_setup *setup, const char *name, ethd_setup_key *key);

#endif
