#include "core/laws_check.h"

#include <string.h>

#include "core/fence.h"
#include "error.h"

ethd_status ethd__within(const char *section, ethd_status status, ethd_error *error) {
  if (status < 0) ethd__error_prefix(error, section);
  return status;
}

/* Calls the law's own check. If it doesn't fill the error, the error's name is the law's id. */
static ethd_status ask_law(const ethd_law *law, const double *p, ethd_error *error) {
  ethd_error own;
  ethd__error(&own, ETHD_OK, law->id);
  ethd_status status = law->check ? law->check(p, &own) : ETHD_OK;
  if (status >= 0) return ETHD_OK;
  own.status = status;
  if (error) *error = own;
  return status;
}

ethd_status ethd__law_values_check(const ethd_law *law, const double *p, ethd_error *error) {
  ethd_status status = ethd_params_check(law->params, law->param_count, p, error);
  return status < 0 ? status : ask_law(law, p, error);
}

static ethd_status check(const char *kind, uint32_t number, const ethd_law *law, const double *p, ethd_error *error) {
  if (!law) return ethd__error(error, ETHD_E_ARGUMENT, kind);
  ethd_status status = ethd__within(kind, ethd_law_check(law, error), error);
  if (status < 0) return status;
  if (law->kind != number) return ethd__error(error, ETHD_E_ARGUMENT, kind);
  return ethd__within(kind, ethd__law_values_check(law, p, error), error);
}

ethd_status ethd__laws_check(const ethd__laws *l, ethd_error *error) {
  const ethd_law *tracking = l->tracking ? &l->tracking->law : NULL, *contact = l->contact ? &l->contact->law : NULL,
                 *transition = l->transition ? &l->transition->law : NULL;
  ethd_status status = check("tracking", ETHD_TRACKING, tracking, l->tracking_p, error);
  if (status >= 0) status = check("contact", ETHD_CONTACT, contact, l->contact_p, error);
  if (status >= 0) status = check("transition", ETHD_TRANSITION, transition, l->transition_p, error);
  return status;
}

void ethd__laws_plan(const ethd__laws *l, ethd__core_plan *out) {
  out->tracking = l->tracking;
  out->contact = l->contact;
  out->transition = l->transition;
  memcpy(out->tracking_p, l->tracking_p, sizeof out->tracking_p);
  memcpy(out->contact_p, l->contact_p, sizeof out->contact_p);
  memcpy(out->transition_p, l->transition_p, sizeof out->transition_p);
  ethd__fence_prepare(out);
}
