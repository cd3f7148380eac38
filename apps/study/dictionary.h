/* The pages in every folder of a study that say what its tables hold: README.md for people, JSON for programs. All [main]. */
#ifndef ETHD__APPS_STUDY_DICTIONARY_H
#define ETHD__APPS_STUDY_DICTIONARY_H

#include "study/columns.h"

/* Returns the text of README.md, which the caller frees; NULL: no memory. */
char *ethd__dictionary(const ethd__table_scope *scope);

/* Writes a JSON object: Description, Units and Levels of each column of a table, as BIDS's sidecars have them. */
void ethd__table_sidecar(FILE *file, ethd__study_table table, const ethd__table_scope *scope);

/* Writes dataset_description.json. */
void ethd__dataset_describe(FILE *file, const ethd__protocol *protocol);

/* The survey's questions, our own words for what the paper asks; and the same with their answers as one text. */
extern const ethd__question ethd__paper_questions[3];
extern const char *const ethd__questions[3];

#endif
