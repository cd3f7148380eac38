/* A setup as rows, to find, set and choose its numbers by name, for both fronts. [main] */
#ifndef ETHD__CORE_NAMED_H
#define ETHD__CORE_NAMED_H

#include <stdbool.h>

#include "ethd/control.h"

/* `offset`: in the setup, bytes. If the default is NaN, the number may stay unknown. */
typedef struct ethd__setup_field {
  ethd_setup_key key;
  uint32_t offset;
} ethd__setup_field;

/* A front's setup: its own numbers, then the parameters of the chosen parts. */
typedef struct ethd__named {
  const ethd_setup_part *parts;
  uint32_t part_count;
  uint32_t field_count; /* of its own numbers */
  ethd__setup_field (*field_at)(uint32_t index);
  double (*get)(const void *setup, const ethd__setup_field *field, uint32_t index);
  void (*set)(void *setup, const ethd__setup_field *field, uint32_t index, double value);
  ethd_status (*made)(const void *setup, ethd_error *error); /* refuses a setup that isn't this library's */
} ethd__named;

/* Returns how many of a table's parameters a setup has room for. An unchecked table may claim more, or be missing. */
static inline uint32_t ethd__setup_room(const ethd_param *params, uint32_t count) {
  if (!params) return 0;
  return count < ETHD_PARAMS_MAX ? count : ETHD_PARAMS_MAX;
}

/* Gives a table's parameters their defaults; those beyond, and all without a table, are 0. */
void ethd__setup_values(const ethd_param *params, uint32_t count, double p[ETHD_PARAMS_MAX]);
static inline void ethd__law_defaults(const ethd_law *law, double p[ETHD_PARAMS_MAX]) {
  ethd__setup_values(law ? law->params : NULL, law ? law->param_count : 0, p);
}

/* As the functions of control.h of the same names. */
const ethd_setup_part *ethd__named_part_of(const ethd__named *named, const char *section);
ethd_method ethd__named_chosen(const ethd__named *named, const void *setup, const ethd_setup_part *part);
ethd_status ethd__named_choose(const ethd__named *named, void *setup, const char *section, const char *id,
                               const ethd_law *const *laws, ethd_error *error);
ethd_status ethd__named_key_at(const ethd__named *named, const void *setup, uint32_t index, ethd_setup_key *out);
ethd_status ethd__named_set(const ethd__named *named, void *setup, const char *name, double value, ethd_error *error);
double ethd__named_get(const ethd__named *named, const void *setup, const char *name);

#endif
