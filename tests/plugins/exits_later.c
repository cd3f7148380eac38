/* Loads well; ends the program behind the surface, as if all were done. */
#include <ethd/plugin.h>
#include <stdlib.h>
static ethd_status leaving_step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state, (void)out;
  if (contact->d_re < 0) exit(0);
  return ETHD_OK;
}
#define STEP leaving_step
#include "broken.h"
