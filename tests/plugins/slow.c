/* Loads well; takes some milliseconds behind the surface. */
#include <ethd/plugin.h>
static ethd_status slow_step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state, (void)out;
  volatile double sum = 0;
  if (contact->d_re < 0)
    for (int i = 0; i < 3000000; i++) sum = sum + 1;
  return ETHD_OK;
}
#define STEP slow_step
#include "broken.h"
