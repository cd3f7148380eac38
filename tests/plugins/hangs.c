/* Loads well; never returns behind the surface. */
#include <ethd/plugin.h>
static ethd_status hanging_step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  volatile int on = contact->d_re < 0;
  (void)p, (void)state, (void)out;
  while (on) continue;
  return ETHD_OK;
}
#define STEP hanging_step
#include "broken.h"
