/* Filling an ethd_error; every function returns the status it was given. [main] */
#ifndef ETHD__ERROR_H
#define ETHD__ERROR_H

#include <math.h>

#include "ethd/base.h"

/* A found number and its allowed range; NaN for those that don't apply. */
typedef struct ethd__found {
  double value, min, max;
} ethd__found;

static const ethd__found ethd__unsaid = {(double)NAN, (double)NAN, (double)NAN};

/* Fill `error`, which may be NULL, with a `name`, which may not; ethd__error does so without numbers. */
ethd_status ethd__error(ethd_error *error, ethd_status status, const char *name);
ethd_status ethd__refuse(ethd_error *error, ethd_status status, const char *name, ethd__found found);

/* Puts "prefix." before the error's name: "k_e" becomes "contact.k_e". */
void ethd__error_prefix(ethd_error *error, const char *prefix);

/* Returns ETHD_E_NOT_FINITE for NaN, ETHD_E_RANGE outside of [min, max], else ETHD_OK. */
ethd_status ethd__check_number(ethd_error *error, const char *name, double value, double min, double max);

#endif
