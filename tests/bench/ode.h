/* What a peer that integrates exports: `peer_ode`, a table that ends with a NULL name (C linkage, const). */
#ifndef ETHD_TESTS_BENCH_ODE_H
#define ETHD_TESTS_BENCH_ODE_H

#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ETHD__ODE_SIZE = 8 };

/* y' = f(t, y), smooth while both watched numbers are positive; where number i becomes negative, the
   right-hand side is changed by `change(i)` and y goes on continuously. */
typedef struct ethd__ode {
  void *self;
  void (*rate)(void *self, double t, const double *y, double *out);
  void (*watch)(void *self, double t, const double *y, double out[2]);
  void (*change)(void *self, int i);
} ethd__ode;

typedef struct ethd__peer_ode {
  const char *name;
  double loosest, tightest, ratio; /* range and ratio of the tolerances, or lengths of steps, that get a point */
  int live;                        /* it has no events: rate() works out what touches each time */
  void *(*create)(const ethd__ode *ode, double tolerance);
  /* Integrates y in place from t to `end`, between which only watched numbers interrupt. */
  void (*work)(void *self, double t, double end, double *y);
  void (*destroy)(void *self);
} ethd__peer_ode;

#define ETHD__ODE_LOCATED 1e-12 /* s */

/* Returns which number is negative at the end of a step, the deeper one if both are, -1 if none is. */
static inline int ethd__ode_changed(const double g[2]) {
  if (!(g[0] < 0) && !(g[1] < 0)) return -1;
  return g[1] < g[0] ? 1 : 0;
}

/* For peers without event location: returns the step s within h at which g(s) < 0 first, by regula falsi (Illinois);
   `try_step` takes a step of s and returns g after it. */
static inline double ethd__ode_locate(double (*try_step)(void *self, double s), void *self, double before, double h,
                                      double after) {
  double low = 0, high = h, g_low = before, g_high = after;
  int side = 0;
  while (high - low > ETHD__ODE_LOCATED) {
    double s = g_low > 0 ? low + (high - low) * g_low / (g_low - g_high) : (low + high) / 2;
    s = fmin(fmax(s, low + ETHD__ODE_LOCATED / 4), high - ETHD__ODE_LOCATED / 4);
    double g = try_step(self, s);
    if (g < 0) {
      high = s;
      g_high = g;
      if (side == 1) g_low /= 2;
      side = 1;
    } else {
      low = s;
      g_low = g;
      if (side == -1) g_high /= 2;
      side = -1;
    }
  }
  return high;
}

#ifdef __cplusplus
}
#endif

#endif
