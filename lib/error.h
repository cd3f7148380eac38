/* Filling an ethd_error; every function returns the status it was given. [main] */
#ifndef ETHD__ERROR_H
#define ETHD__ERROR_H

#include "ethd/status.h"

ethd_status ethd__error(ethd_error *error, ethd_status status, const char *name);
ethd_status ethd__refuse(ethd_error *error, ethd_status status, const char *name, double found, double min, double max);

/* Puts "prefix." before the name: "contact" + "k_e". */
void ethd__error_prefix(ethd_error *error, const char *prefix);

/* ETHD_E_NOT_FINITE for NaN, ETHD_E_RANGE outside of [min, max], else ETHD_OK. */
ethd_status ethd__check_number(ethd_error *error, const char *name, double value, double min, double max);

#endif
