/* Loads well; reports a failure behind the surface. */
#include <ethd/plugin.h>
static ethd_status failing_step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state, (void)out;
  return contact->d_re < 0 ? ETHD_E_LAW : ETHD_OK;
}
#define STEP failing_step
#include "broken.h"
