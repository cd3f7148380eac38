/* Parameters as tables: the table is the documentation (ethd-laws prints it) and the check. Links from libethd. */
#ifndef ETHD_PARAM_H
#define ETHD_PARAM_H

#include <stdint.h>

#include "ethd/status.h"

ETHD_BEGIN_DECLS

/* At most so many parameters in one table. Frozen within an ABI. */
#define ETHD_PARAMS_MAX 16
#define ETHD_BRIEF_MAX 200 /* characters of a unit or a brief: printable ASCII, one line */

/* One number. `unit` is an SI unit ("N/m", "1"), or the words of a choice joined by '|'
   ("velocity|difference"): the value is then the word's index. A value is valid iff min <= value <= max;
   it may be infinite only where the table's max is. Frozen within an ABI. */
typedef struct ethd_param {
  const char *name;
  const char *unit;
  double min, max, def;
  const char *brief;
} ethd_param;

/* A named table, for what isn't a law: velocity estimators, ring fits, finger filters. */
typedef struct ethd_method {
  const char *id;
  const char *brief;
  const ethd_param *params;
  uint32_t param_count;
} ethd_method;

/* ETHD_E_TABLE with the offending name unless: at most ETHD_PARAMS_MAX; names of 1 to 31 characters
   a-z 0-9 _ , unique; unit and brief of 1 to ETHD_BRIEF_MAX printable ASCII characters; min <= def <= max, min finite, nothing NaN; a choice has
   min 0, max its words - 1 and a whole default. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_params_check_table(const ethd_param *params, uint32_t count,
                                                             ethd_error *error);

/* Every value against its row: ETHD_E_NOT_FINITE or ETHD_E_RANGE with name, found, min, max. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_params_check(const ethd_param *params, uint32_t count, const double *values,
                                                       ethd_error *error);

/* values[i] = params[i].def. [any] */
ETHD_API void ethd_params_default(const ethd_param *params, uint32_t count, double *values);

/* Index of a name, -1 if the table hasn't it. [any] */
ETHD_API int ethd_params_find(const ethd_param *params, uint32_t count, const char *name);

/* Number of words of a choice ("a|b" 2), 0 if the unit isn't one; index of a word, -1 if unknown. [any] */
ETHD_API uint32_t ethd_param_words(const ethd_param *param);
ETHD_API int ethd_param_word(const ethd_param *param, const char *word);

ETHD_END_DECLS

#endif
