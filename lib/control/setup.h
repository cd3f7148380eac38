/* The numbers of a setup as rows, by which they get their defaults, are checked, and are set by name. */
#ifndef ETHD__CONTROL_SETUP_H
#define ETHD__CONTROL_SETUP_H

#include "ethd/control.h"

/* Refuses a setup that ethd_setup_default didn't make (ETHD_E_ARGUMENT), or made for other headers (ETHD_E_SIZE). */
ethd_status ethd__setup_made(const ethd_setup *setup, ethd_error *error);

/* Gives a setup that is all zero but for its cookie its defaults. */
void ethd__setup_defaults(ethd_setup *setup);

#define ETHD__D_BETA_MIN 1e-5 /* m: the least R_r - R_f,max */

/* `offset`: in ethd_setup, bytes; all are doubles but the arm's mechanism. If the default is NaN, the number may stay
   unknown. */
typedef struct ethd__setup_field {
  ethd_setup_key key;
  uint32_t offset;
} ethd__setup_field;

/* The numbers that belong neither to a law nor to a method nor to the limits. */
#define ETHD__SETUP_FIELDS 15
extern const ethd__setup_field ethd__setup_fields[ETHD__SETUP_FIELDS];

/* Returns how many of a table's parameters a setup has room for. An unchecked table may claim more, or be missing. */
static inline uint32_t ethd__setup_room(const ethd_param *params, uint32_t count) {
  if (!params) return 0;
  return count < ETHD_PARAMS_MAX ? count : ETHD_PARAMS_MAX;
}

double ethd__setup_field_get(const ethd_setup *setup, const ethd__setup_field *field, uint32_t index);
void ethd__setup_field_set(ethd_setup *setup, const ethd__setup_field *field, uint32_t index, double value);

#endif
