/* The state machine of VO-B, for laws that extend it. */
#ifndef ETHD__LAW_OFFSET_H
#define ETHD__LAW_OFFSET_H

#include "law/beta.h"

/* The first parameters of such a law, in this order. */
enum { ETHD__B_D, ETHD__V_TH, ETHD__BETA_MIN, ETHD__EPS_MAX, ETHD__T_MAX, ETHD__OFFSET_COUNT };

#define ETHD__OFFSET_PARAMS                                                                                    \
  {"b_d", "Ns/m", 0, 1e4, 100, "damping while braking (B_d)"},                                                 \
      {"v_th", "m/s", 1e-6, 10, 0.020, "below this speed the ring stands still (v_th)"}, ETHD__BETA_MIN_PARAM, \
      {"eps_max", "m", 0, (double)INFINITY, 0.006, "braking ends at this depth; inf: never, as in the paper"}, \
      {"t_max", "s", 0, (double)INFINITY, 0.050, "braking ends after this time; inf: never, as in the paper"}

typedef struct ethd__offset {
  double phase;        /* ETHD_TRANSPARENT, ETHD_BRAKING, ETHD_VO */
  double eps;          /* wall offset, 0 outside of vo */
  double braked, rest; /* s since braking began, and the compensation of its sum (Kahan 1965) */
} ethd__offset;

#define ETHD__RESTED 0.05 /* s at a wall after which a ring counts as resting, even if a noisy speed differs */

/* All [rt]. */
void ethd__offset_enter(ethd__offset *s, int phase, double eps) ETHD_RT;
void ethd__offset_step(const double *p, ethd__offset *s, const ethd_contact *c, ethd_ruling *out) ETHD_RT;

/* Lets a resting contact keep its wall; a moving one begins anew and is braked. */
void ethd__offset_adopt(const double *p, ethd__offset *s, const ethd_past *past) ETHD_RT;

#endif
