/* The numbers of a setup as rows: for defaults, checks, and setting by name. */
#ifndef ETHD__CONTROL_SETUP_H
#define ETHD__CONTROL_SETUP_H

#include "core/named.h"

/* Refuses a setup that ethd_setup_default didn't make (ETHD_E_ARGUMENT), or made for other headers (ETHD_E_SIZE). */
ethd_status ethd__setup_made(const void *setup, ethd_error *error);

/* Fills a setup that is zero, except for its cookie, with the defaults. */
void ethd__setup_defaults(ethd_setup *setup);

#define ETHD__D_BETA_MIN 1e-5 /* m: the least R_r - R_f,max */

/* The numbers that belong neither to a law nor to a method nor to the limits. */
#define ETHD__SETUP_FIELDS 15
extern const ethd__setup_field ethd__setup_fields[ETHD__SETUP_FIELDS];

double ethd__setup_field_get(const void *setup, const ethd__setup_field *field, uint32_t index);
void ethd__setup_field_set(void *setup, const ethd__setup_field *field, uint32_t index, double value);

#endif
