/* Loads well; its beta is not a number behind the surface. */
#include <ethd/plugin.h>
#include <math.h>
static ethd_status nan_step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state;
  if (contact->d_re < 0) out->beta = (double)NAN;
  return ETHD_OK;
}
#define STEP nan_step
#include "broken.h"
