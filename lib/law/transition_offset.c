#include "law/offset.h"

/* VO-B: brake first, then render the wall where the ring stopped (eq. 6-8, figure 5).

                    d_re < 0                abs(v) < v_th, or a cap: eps := -d_re
     transparent --------------> braking ------------------------------------> vo
        ^  ^                        |                                            |
        |  '---- d_re > d_beta -----'                                            |
        '----------------------------- d_re > d_beta ----------------------------'

   A tick follows at most one arrow, before it computes the forces. */

static const ethd_param params[ETHD__OFFSET_COUNT] = {ETHD__OFFSET_PARAMS};

_Static_assert(sizeof(ethd__offset) <= ETHD_STATE_MAX, "state");

#define TIME_TOLERANCE 1e-9 /* s: bound on the rounding error of a sum of periods */

void ethd__offset_enter(ethd__offset *s, int phase, double eps) {
  s->phase = phase;
  s->eps = eps;
  s->braked = s->rest = 0;
}

/* Adds a period to the time of braking by Kahan's summation, so that a long sum has the error of one rounding. */
static void add_time(ethd__offset *s, double period) {
  double term = period - s->rest, sum = s->braked + term;
  s->rest = sum - s->braked - term;
  s->braked = sum;
}

static void brake(const double *p, ethd__offset *s, const ethd_contact *c) {
  add_time(s, c->period);
  if (fabs(c->v) < p[ETHD__V_TH])
    ethd__offset_enter(s, ETHD_VO, -c->d_re);
  else if (c->d_re > c->d_beta)
    ethd__offset_enter(s, ETHD_TRANSPARENT, 0);
  else if (-c->d_re >= p[ETHD__EPS_MAX] || s->braked >= p[ETHD__T_MAX] - TIME_TOLERANCE)
    ethd__offset_enter(s, ETHD_VO, -c->d_re);
}

static void advance(const double *p, ethd__offset *s, const ethd_contact *c) {
  if (s->phase == ETHD_BRAKING)
    brake(p, s, c);
  else if (s->phase == ETHD_VO && c->d_re > c->d_beta)
    ethd__offset_enter(s, ETHD_TRANSPARENT, 0);
  else if (s->phase == ETHD_TRANSPARENT && c->d_re < 0)
    ethd__offset_enter(s, ETHD_BRAKING, 0);
}

void ethd__offset_step(const double *p, ethd__offset *s, const ethd_contact *c, ethd_ruling *out) {
  advance(p, s, c);
  out->state = (int32_t)s->phase;
  out->offset = s->eps;
  out->share = s->phase == ETHD_VO ? 1 : 0;
  out->damping = s->phase == ETHD_BRAKING ? p[ETHD__B_D] : 0;
  out->argument = c->d_fr + s->eps;
  out->beta = ethd__beta(p[ETHD__BETA_MIN], c->d_beta, out->argument);
}

void ethd__offset_adopt(const double *p, ethd__offset *s, const ethd_past *past) {
  int walled = past->state != ETHD_TRANSPARENT && past->state != ETHD_BRAKING;
  int rests = fabs(past->v) < p[ETHD__V_TH] || past->since >= ETHD__RESTED;
  if (walled && rests) ethd__offset_enter(s, ETHD_VO, past->offset);
}

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  ethd__offset_step(p, block, c, out);
  return ETHD_OK;
}

static void adopt(const double *p, void *block, const ethd_past *past) ETHD_RT { ethd__offset_adopt(p, block, past); }

const ethd_transition_law ethd_transition_offset = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, sizeof(ethd__offset), "offset",
            "VO-B: brake, then the wall where the ring stopped", params, ETHD__OFFSET_COUNT, NULL, NULL},
    .step = step,
    .adopt = adopt,
    .gains = &(const ethd_gains){NULL, "b_d"},
};
