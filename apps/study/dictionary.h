/* The README.md that every folder of a study brings along. */
#ifndef ETHD_STUDY_DICTIONARY_H
#define ETHD_STUDY_DICTIONARY_H

#include "study/columns.h"

/* Freed by the caller; NULL: no memory. [main] */
char *ethd__dictionary(const ethd__table_scope *scope);

/* The survey's questions, our own words for what the paper asks; and the same with their answers as one text. */
extern const ethd__question ethd__paper_questions[3];
extern const char *const ethd__questions[3];

#endif
