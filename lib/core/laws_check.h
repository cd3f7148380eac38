/* The laws of a setup of either front. [main] */
#ifndef ETHD__CORE_LAWS_CHECK_H
#define ETHD__CORE_LAWS_CHECK_H

#include "core/plan.h"

typedef struct ethd__laws {
  const ethd_tracking_law *tracking;
  const ethd_contact_law *contact;
  const ethd_transition_law *transition;
  const double *tracking_p, *contact_p, *transition_p; /* their parameters, ETHD_PARAMS_MAX of each */
} ethd__laws;

/* Gives the laws of a setup, whose fields have the same names in both fronts. */
#define ETHD__LAWS(setup)                                                                             \
  (&(const ethd__laws){(setup)->tracking, (setup)->contact, (setup)->transition, (setup)->tracking_p, \
                       (setup)->contact_p, (setup)->transition_p})

/* Puts the section into a failure's name, and returns the status. */
ethd_status ethd__within(const char *section, ethd_status status, ethd_error *error);

/* Check a law's parameters, by its table and by itself, and three laws with theirs. */
ethd_status ethd__law_values_check(const ethd_law *law, const double *p, ethd_error *error);
ethd_status ethd__laws_check(const ethd__laws *laws, ethd_error *error);

/* Puts checked laws into a plan that knows its kind of command. */
void ethd__laws_plan(const ethd__laws *laws, ethd__core_plan *out);

#endif
