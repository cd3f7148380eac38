/* Trials of finger fits: rays with normal noise, and the least error that any fit can have.

   A ray in direction u meets the circle about c at p = rho u: d rho / d (c, R) = (n, 1) / (n.u), n the circle's normal
   at p. With equal and independent noise of variance s^2 the information is the sum of g g^T / s^2 over the rays, and
   no unbiased estimate of c has less mean squared error than the trace of its inverse over c (Cramer, Rao). */
#ifndef ETHD_TESTS_BENCH_FIT_TRIALS_H
#define ETHD_TESTS_BENCH_FIT_TRIALS_H

#include "ethd/estimate.h"
#include "unit/draw.h"

#define FIT_RING 12e-3                          /* m */
#define FIT_FINGER 7.5e-3                       /* m */
#define FIT_NOISE (0.3e-3 / 1.7320508075688772) /* m, sd: normal, as much as +-0.3 mm uniform */

typedef struct fit_scenario {
  const char *name;
  int lost, outlier, skew; /* rays side by side; one ray 3 mm off; read one after the other within 3.33 ms at 0.4 m/s */
} fit_scenario;

static const fit_scenario fit_scenarios[] = {{"16 rays", 0, 0, 0},
                                             {"an arc of 8 rays lost", 8, 0, 0},
                                             {"one of 16 rays off by 3 mm", 0, 1, 0},
                                             {"16 rays read within 3.3 ms at 0.4 m/s", 0, 0, 1}};
enum { FIT_SCENARIOS = sizeof fit_scenarios / sizeof *fit_scenarios };

typedef struct fit_trial {
  double r[ETHD_RAYS];
  ethd_vec centre; /* in the middle of the frame's time, within 4 mm of the ring's */
  double bound[2]; /* m^2: of the squared error; radius sought, radius known */
} fit_trial;

static inline ethd_vec fit_polar(double r, double angle) { return (ethd_vec){r * cos(angle), r * sin(angle)}; }

static inline void fit_add_information(double m[3][3], ethd_vec c, double reach, int k) {
  ethd_vec u = fit_polar(1, M_PI * k / 8);
  ethd_vec n = ethd_vec_scale(1 / FIT_FINGER, ethd_vec_sub(ethd_vec_scale(reach, u), c));
  double along = ethd_vec_dot(n, u), g[3] = {n.x / along, n.y / along, 1 / along};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[i][j] += g[i] * g[j];
}

/* Returns the trace of the inverse over the centre; a sought radius takes its share of the information (Schur). */
static inline double fit_bound(double m[3][3], int known) {
  double share = known ? 0 : 1 / m[2][2];
  double a = m[0][0] - share * m[0][2] * m[0][2], b = m[0][1] - share * m[0][2] * m[1][2];
  double d = m[1][1] - share * m[1][2] * m[1][2];
  return FIT_NOISE * FIT_NOISE * (a + d) / (a * d - b * b);
}

static inline void fit_try(uint64_t i, const fit_scenario *what, fit_trial *out) {
  const uint64_t at = 64 * i;
  double m[3][3] = {{0}};
  int first = (int)draw(at, 0, ETHD_RAYS);
  ethd_vec v = fit_polar(what->skew ? 0.4 : 0, draw(at + 1, 0, 2 * M_PI));
  out->centre = fit_polar(4e-3 * sqrt(draw(at + 2, 0, 1)), draw(at + 3, 0, 2 * M_PI));
  for (int k = 0; k < ETHD_RAYS; k++) {
    double r[ETHD_RAYS], t = ((k + 0.5) / ETHD_RAYS - 0.5) * 3.33e-3;
    ethd_vec c = ethd_vec_add(out->centre, ethd_vec_scale(t, v));
    int lost = (k - first + ETHD_RAYS) % ETHD_RAYS < what->lost;
    ethd_fit_rays(FIT_RING, FIT_FINGER, c, r);
    out->r[k] = lost ? (double)NAN : r[k] + FIT_NOISE * draw_normal(at + 16 + (uint64_t)k);
    if (!lost) fit_add_information(m, c, FIT_RING - r[k], k);
  }
  if (what->outlier) out->r[first] += i % 2 ? 3e-3 : -3e-3;
  for (int known = 0; known < 2; known++) out->bound[known] = fit_bound(m, known);
}

#endif
