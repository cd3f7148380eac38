/* The pages in every folder of a study that describe its tables: README.md for people, JSON for programs. All
   [main]. */
#ifndef ETHD__APPS_STUDY_DICTIONARY_H
#define ETHD__APPS_STUDY_DICTIONARY_H

#include "study/columns.h"

/* Returns the text of README.md, which the caller frees. */
char *ethd__dictionary(const ethd__table_scope *scope);

/* Return JSON that the caller frees; NULL: no memory. A table's Description, Units and Levels of each column, as in
   BIDS's sidecars; and dataset_description.json. */
char *ethd__table_sidecar(ethd__study_table table, const ethd__table_scope *scope);
char *ethd__dataset_describe(const ethd__protocol *protocol);

/* The survey's questions: the paper's questions in our own words. */
extern const ethd__question ethd__paper_questions[3];

#endif
