/* The README.md in every folder of a study. */
#ifndef ETHD__APPS_STUDY_DICTIONARY_H
#define ETHD__APPS_STUDY_DICTIONARY_H

#include "study/columns.h"

/* Returns its text, which the caller frees; NULL: no memory. [main] */
char *ethd__dictionary(const ethd__table_scope *scope);

/* The survey's questions, our own words for what the paper asks; and the same with their answers as one text. */
extern const ethd__question ethd__paper_questions[3];
extern const char *const ethd__questions[3];

#endif
