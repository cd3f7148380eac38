#include "properties.h"

#include <check.h>
#include <math.h>

/* ck_assert tells its parent of every call: too slow for every tick. */
#define require(condition, ...)                  \
  do {                                           \
    if (!(condition)) ck_abort_msg(__VA_ARGS__); \
  } while (0)

#define WALL 0.238
#define R_R 0.012
#define K_E 2500.0
#define B_E 45.0
#define B_D 100.0
#define V_TH 0.020
#define BETA_MIN 0.1

/* Distances: the wall lies at smaller x. */
static double to_wall(double x, double radius) { return x - radius - WALL; }
/* As recorded, where it is: the sign of the last bit chooses a branch. */
static double ring_gap(const ethd_trace *k) { return isnan(k->d_re) ? to_wall(k->x[0], R_R) : k->d_re; }
static double speed_in(const ethd_trace *k) { return -k->v[0]; }
static double force_in(const ethd_trace *k) { return -k->fe[0]; } /* along n; < 0 pushes out */

/* ---- finite, limits ---- */

static int finite2(const double v[2]) { return isfinite(v[0]) && isfinite(v[1]); }

void assert_finite(const ethd__tap_rows *rows, const char *where) {
  for (size_t i = 0; i < rows->count; i++) {
    const ethd_trace *k = &rows->trace[i];
    const ethd_truth *t = &rows->truth[i];
    int good = finite2(k->x) && finite2(k->v) && finite2(k->xf) && finite2(k->vf) && finite2(k->qd) &&
               finite2(k->eps_q) && finite2(k->eps_q_dot) && finite2(k->fe) && finite2(k->fd) && finite2(k->tau_raw) &&
               finite2(k->tau) && isfinite(k->beta) && isfinite(k->eps);
    good = good && finite2(t->ring) && finite2(t->ring_v) && finite2(t->motor) && finite2(t->finger) &&
           finite2(t->finger_v) && finite2(t->hand) && isfinite(t->pad) && isfinite(t->pad_force);
    require(good && !k->fault, "%s: tick %zu: not finite", where, i);
  }
}

void assert_torque_within(const ethd__tap_rows *rows, const gains *with, const char *where) {
  for (size_t i = 0; i < rows->count; i++)
    for (int j = 0; j < 2; j++)
      require(fabs(rows->trace[i].tau[j]) <= with->torque_max, "%s: tick %zu: torque %g", where, i,
              rows->trace[i].tau[j]);
}

/* ---- forces ---- */

/* Eq. 3 and 7: (K d - B v) n entering or standing, K d n leaving, never attractive. */
static double wall_force(double gap, double v) {
  if (!(gap < 0)) return 0;
  return fmin(0, v > 0 ? K_E * gap - B_E * v : K_E * gap);
}

static double expected_force(const ethd_trace *k, kind law) {
  if (law == OFFSET) return k->state == ETHD_VO ? wall_force(ring_gap(k) + k->eps, speed_in(k)) : 0;
  return wall_force(ring_gap(k), speed_in(k));
}

void assert_forces(const ethd__tap_rows *rows, kind law, const char *where) {
  for (size_t i = 0; i < rows->count; i++) {
    const ethd_trace *k = &rows->trace[i];
    require(fabs(ring_gap(k) - to_wall(k->x[0], R_R)) <= 1e-12, "%s: tick %zu: d_re %.12g", where, i, k->d_re);
    double braking = k->state == ETHD_BRAKING ? B_D * k->v[0] : 0;
    require(force_in(k) <= 0, "%s: tick %zu: the wall pulls with %g N", where, i, force_in(k));
    require(k->fe[1] == 0 && k->fd[1] == 0, "%s: tick %zu: a force along the wall", where, i);
    require(fabs(force_in(k) - expected_force(k, law)) <= 1e-9, "%s: tick %zu: F_e %.12g, not %.12g", where, i,
            force_in(k), expected_force(k, law));
    require(fabs(-k->fd[0] - braking) <= 1e-9, "%s: tick %zu: F_d %.12g, not %.12g", where, i, -k->fd[0], braking);
    if (i && rows->trace[i - 1].state == ETHD_BRAKING && k->state == ETHD_VO)
      require(k->fe[0] == 0 && fabs(k->eps + ring_gap(k)) < 1e-12 && fabs(k->v[0]) < V_TH,
              "%s: tick %zu: braking -> vo with F_e %g N", where, i, k->fe[0]);
  }
}

/* ---- beta ---- */

/* Eq. 4 and 8. */
static double beta_of(double d, double d_beta) {
  if (d > d_beta) return 1;
  return d > 0 ? (1 - BETA_MIN) / d_beta * d + BETA_MIN : BETA_MIN;
}

static double finger_gap(const ethd_trace *k, kind law, const gains *with) {
  return to_wall(k->xf[0], law == OFFSET ? R_R : with->finger_radius);
}

void assert_beta(const ethd__tap_rows *rows, kind law, const gains *with, const char *where) {
  double d_beta = R_R - with->finger_radius_max;
  for (size_t i = 0; i < rows->count; i++) {
    const ethd_trace *k = &rows->trace[i];
    double d = finger_gap(k, law, with) + (law == OFFSET && k->state == ETHD_VO ? k->eps : 0);
    double beta = law == ABRUPT ? (ring_gap(k) < 0 ? 0 : 1) : beta_of(d, d_beta);
    require(fabs(k->beta - beta) <= 1e-9, "%s: tick %zu: beta %.12g, not %.12g", where, i, k->beta, beta);
  }
}

/* A tick moves beta by at most the slope times what its argument moved; where the argument's wall changes,
   by what the change itself allows besides: (1 - beta_min) |n.(X_f - X_r)| / d_beta. */
void assert_beta_jumps(const ethd__tap_rows *rows, kind law, const gains *with, const char *where) {
  double slope = (1 - BETA_MIN) / (R_R - with->finger_radius_max);
  if (law == ABRUPT) return;
  for (size_t i = 1; i < rows->count; i++) {
    const ethd_trace *k = &rows->trace[i], *before = k - 1;
    double bound = slope * fabs(k->xf[0] - before->xf[0]);
    int shifted = (k->state == ETHD_VO) != (before->state == ETHD_VO);
    if (law == OFFSET && shifted) bound += slope * fabs(k->xf[0] - k->x[0]);
    require(fabs(k->beta - before->beta) <= bound + 1e-9, "%s: tick %zu: beta jumps by %g, %g is allowed", where, i,
            k->beta - before->beta, bound);
  }
}

/* ---- energy ---- */

/* Leaving from depth p the wall gives back at most K p^2 / 2, and K step^2 / 2 for each tick's hold. */
void assert_energy(const ethd__tap_rows *rows, const char *where) {
  double given = 0, allowed = 0;
  for (size_t i = 0; i + 1 < rows->count; i++) {
    const ethd_trace *k = &rows->trace[i];
    double depth = -(ring_gap(k) + k->eps), step = k[1].x[0] - k->x[0];
    int leaving = force_in(k) < 0 && speed_in(k) <= 0;
    if (!leaving) {
      given = allowed = 0;
      continue;
    }
    if (allowed == 0) allowed = K_E * depth * depth / 2;
    given += -force_in(k) * step;
    allowed += K_E * step * step / 2;
    require(given <= allowed + 1e-12, "%s: tick %zu: the wall gives back %g J, %g are allowed", where, i, given,
            allowed);
  }
}
