#include "law/beta.h"

/* VO-B: brake first, then render the wall where the ring stopped (eq. 6-8, figure 5).

                    d_re < 0                abs(v) < v_th, or a cap: eps := -d_re
     transparent --------------> braking ------------------------------------> vo
        ^  ^                        |                                            |
        |  '---- d_re > d_beta -----'                                            |
        '----------------------------- d_re > d_beta ----------------------------'

   At most one arrow per tick, before the forces. */

enum { B_D, V_TH, BETA_MIN, EPS_MAX, T_MAX, COUNT };

static const ethd_param params[COUNT] = {
    {"b_d", "Ns/m", 0, 1e4, 100, "damping while braking (B_d)"},
    {"v_th", "m/s", 1e-6, 10, 0.020, "below this speed the ring stands still (v_th)"},
    ETHD__BETA_MIN_PARAM,
    {"eps_max", "m", 0, (double)INFINITY, 0.006, "braking ends at this depth; inf: never, as in the paper"},
    {"t_max", "s", 0, (double)INFINITY, 0.050, "braking ends after this time; inf: never, as in the paper"},
};

typedef struct offset_state {
  double phase;        /* ETHD_TRANSPARENT, ETHD_BRAKING, ETHD_VO */
  double eps;          /* m, offset of the wall; 0 in any phase but vo */
  double braked, rest; /* s since braking began, and the rounding that its sum still owes (Kahan 1965) */
} offset_state;

_Static_assert(sizeof(offset_state) <= ETHD_STATE_MAX, "state");

/* s: periods add up to t_max only within rounding. */
#define TIME_TOLERANCE 1e-9

static void enter(offset_state *s, int phase, double eps) ETHD_RT {
  s->phase = phase;
  s->eps = eps;
  s->braked = s->rest = 0;
}

/* Adds a period; the sum of any number of them is right within one rounding. */
static void add_time(offset_state *s, double period) ETHD_RT {
  double term = period - s->rest, sum = s->braked + term;
  s->rest = sum - s->braked - term;
  s->braked = sum;
}

static void brake(const double *p, offset_state *s, const ethd_contact *c) ETHD_RT {
  add_time(s, c->period);
  if (fabs(c->v) < p[V_TH])
    enter(s, ETHD_VO, -c->d_re);
  else if (c->d_re > c->d_beta)
    enter(s, ETHD_TRANSPARENT, 0);
  else if (-c->d_re >= p[EPS_MAX] || s->braked >= p[T_MAX] - TIME_TOLERANCE)
    enter(s, ETHD_VO, -c->d_re);
}

static void advance(const double *p, offset_state *s, const ethd_contact *c) ETHD_RT {
  if (s->phase == ETHD_BRAKING)
    brake(p, s, c);
  else if (s->phase == ETHD_VO && c->d_re > c->d_beta)
    enter(s, ETHD_TRANSPARENT, 0);
  else if (s->phase == ETHD_TRANSPARENT && c->d_re < 0)
    enter(s, ETHD_BRAKING, 0);
}

static ethd_status step(const double *p, void *block, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  offset_state *s = block;
  advance(p, s, c);
  out->state = (int32_t)s->phase;
  out->offset = s->eps;
  out->share = s->phase == ETHD_VO ? 1 : 0;
  out->damping = s->phase == ETHD_BRAKING ? p[B_D] : 0;
  out->argument = c->d_fr + s->eps;
  out->beta = ethd__beta(p[BETA_MIN], c->d_beta, out->argument);
  return ETHD_OK;
}

const ethd_transition_law ethd_transition_offset = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, sizeof(offset_state), "offset",
            "VO-B: brake, then the wall where the ring stopped", params, COUNT, NULL, NULL},
    .step = step,
};
