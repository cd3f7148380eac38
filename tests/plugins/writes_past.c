/* Loads well; behind the surface it writes one word beside its 16 bytes of state: in the block's rest, behind the block
   or before it. */
#include <ethd/plugin.h>
static ethd_status careless_step(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT {
  static const int places[] = {2, ETHD_STATE_MAX / 8 - 1, ETHD_STATE_MAX / 8, ETHD_STATE_MAX / 8 + 1, -1, -2};
  (void)out;
  if (contact->d_re < 0) ((double *)state)[places[(int)p[0]]] = 0;
  return ETHD_OK;
}
static const ethd_param params[] = {{"place", "1", 0, 5, 0, "where it writes"}};
#define PARAMS params
#define PARAM_COUNT 1
#define STATE 16
#define STEP careless_step
#include "broken.h"
