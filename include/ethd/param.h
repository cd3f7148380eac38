/* Tables of parameters, for documentation (ethd-check --laws prints them) and for checks. Links from libethd. */
#ifndef ETHD_PARAM_H
#define ETHD_PARAM_H

#include <stdint.h>

#include "ethd/base.h"

ETHD_BEGIN_DECLS

/* The most parameters that one table may have. Frozen within an ABI. */
#define ETHD_PARAMS_MAX 16
#define ETHD_BRIEF_MAX 200 /* characters of a unit or a brief: printable ASCII, one line */

#define ETHD_WHOLE "whole" /* the unit of a whole number */

/* One number. `unit` is an SI unit ("N/m", "1"), ETHD_WHOLE, or the words of a choice joined by '|'
   ("velocity|difference"): the value is then the word's index. A value is valid iff min <= value <= max, and it is
   whole where the unit says so; it may be infinite only where the table's max is. Frozen within an ABI. */
typedef struct ethd_param {
  const char *name;
  const char *unit;
  double min, max, def;
  const char *brief;
} ethd_param;

/* A method: it is chosen by its id and has parameters like a law. Velocity estimators, finger fits and finger filters
   are methods. */
typedef struct ethd_method {
  const char *id;
  const char *brief;
  const ethd_param *params;
  uint32_t param_count;
} ethd_method;

/* Checks a table. It has at most ETHD_PARAMS_MAX rows; names are unique and of 1 to 31 characters a-z 0-9 _ ; units and
   briefs are 1 to ETHD_BRIEF_MAX printable ASCII characters; min <= def <= max, min is finite, none is NaN; the
   choice of a word has min 0, max one less than its words, and a whole default. Else ETHD_E_TABLE with the offending
   name. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_params_check_table(const ethd_param *params, uint32_t count,
                                                             ethd_error *error);

/* Checks every value, in the unit of its row, against its row: ETHD_E_NOT_FINITE or ETHD_E_RANGE with name, found, min,
   max. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_params_check(const ethd_param *params, uint32_t count, const double *values,
                                                       ethd_error *error);

/* Sets values[i] = params[i].def, in the unit of its row. [any] */
ETHD_API void ethd_params_default(const ethd_param *params, uint32_t count, double *values);

/* Returns the index of a name, -1 if the table doesn't have it. [any] */
ETHD_API int ethd_params_find(const ethd_param *params, uint32_t count, const char *name);

/* Returns how many words a choice has (2 for "a|b"), 0 if the unit isn't a choice. [any] */
ETHD_API uint32_t ethd_param_words(const ethd_param *param);

/* Returns the index of a word of a choice, -1 if it isn't one of them. [any] */
ETHD_API int ethd_param_word(const ethd_param *param, const char *word);

ETHD_END_DECLS

#endif
