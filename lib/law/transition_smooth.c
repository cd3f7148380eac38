#include "law/beta.h"

/* VO-A (Gonzalez et al. 2015a; eq. 3, 4): tracking fades as the finger nears the wall. It has no state. */

enum { BETA_MIN, COUNT };

static const ethd_param params[COUNT] = {ETHD__BETA_MIN_PARAM};

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  (void)block;
  out->beta = ethd__beta(p[BETA_MIN], c->d_beta, c->d_fe);
  out->share = 1;
  out->state = c->d_re < 0 ? ETHD_VO : ETHD_TRANSPARENT;
  return ETHD_OK;
}

const ethd_transition_law ethd_transition_smooth = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, 0, "smooth", "VO-A: tracking fades near the wall",
            params, COUNT, NULL, NULL},
    .step = step,
    .gains = &(const ethd_gains){NULL, NULL},
};
