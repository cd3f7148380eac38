#include "ethd/law.h"

#include <stdbool.h>

/* Outside the wall the ring tracks, inside it the wall pushes, without a transition: the paper's baseline. */

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  (void)p, (void)block;
  bool inside = c->d_re < 0;
  out->beta = inside ? 0 : 1;
  out->share = inside ? 1 : 0;
  out->state = inside ? ETHD_VO : ETHD_TRANSPARENT;
  return ETHD_OK;
}

const ethd_transition_law ethd_transition_abrupt = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, 0, "abrupt",
            "tracking outside the wall, the wall's force inside", NULL, 0, NULL, NULL},
    .step = step,
    .gains = &(const ethd_gains){NULL, NULL},
};
