// flags: $(pkg-config --cflags --libs gsl 2>/dev/null || echo -lgsl -lgslcblas)
// The GNU Scientific Library's adaptive Runge-Kutta methods, started anew at each change.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>
#include <stdlib.h>
#include <string.h>

#include "bench/ode.h"

enum { N = ETHD__ODE_SIZE };

typedef struct gsl_solver {
  ethd__ode ode;
  gsl_odeiv2_system system;
  gsl_odeiv2_step *step, *trial;
  gsl_odeiv2_control *control;
  gsl_odeiv2_evolve *evolve;
  double h;
  /* the step that holds a change */
  double t, y[N], rate[N], out[N];
  int which;
} gsl_solver;

static int rate(double t, const double y[], double out[], void *self) {
  const gsl_solver *s = self;
  s->ode.rate(s->ode.self, t, y, out);
  return GSL_SUCCESS;
}

static void *create(const ethd__ode *ode, double tolerance, const gsl_odeiv2_step_type *type) {
  gsl_solver *s = calloc(1, sizeof *s);
  if (!s) return NULL;
  s->ode = *ode;
  s->system = (gsl_odeiv2_system){rate, NULL, N, s};
  s->step = gsl_odeiv2_step_alloc(type, N);
  s->trial = gsl_odeiv2_step_alloc(type, N);
  s->control = gsl_odeiv2_control_y_new(tolerance, 0);
  s->evolve = gsl_odeiv2_evolve_alloc(N);
  s->h = 1e-4;
  return s;
}

static void *create_rkf45(const ethd__ode *ode, double tolerance) {
  return create(ode, tolerance, gsl_odeiv2_step_rkf45);
}
static void *create_rk8pd(const ethd__ode *ode, double tolerance) {
  return create(ode, tolerance, gsl_odeiv2_step_rk8pd);
}

static double try_step(void *self, double h) {
  gsl_solver *s = self;
  double error[N], g[2];
  memcpy(s->out, s->y, sizeof s->y);
  gsl_odeiv2_step_apply(s->trial, s->t, h, s->out, error, s->rate, NULL, &s->system);
  s->ode.watch(s->ode.self, s->t + h, s->out, g);
  return g[s->which];
}

static void work(void *self, double t, double end, double *y) {
  gsl_solver *s = self;
  gsl_odeiv2_step_reset(s->step);
  gsl_odeiv2_evolve_reset(s->evolve);
  while (t < end) {
    double g[2], before[2], begin = t;
    memcpy(s->y, y, sizeof s->y);
    gsl_odeiv2_evolve_apply(s->evolve, s->control, s->step, &s->system, &t, end, &s->h, y);
    s->ode.watch(s->ode.self, t, y, g);
    s->which = ethd__ode_changed(g);
    if (s->which < 0) continue;
    s->ode.watch(s->ode.self, begin, s->y, before);
    s->ode.rate(s->ode.self, begin, s->y, s->rate);
    s->t = begin;
    double h = ethd__ode_locate(try_step, s, before[s->which], t - begin, g[s->which]);
    try_step(s, h);
    memcpy(y, s->out, sizeof s->out);
    s->ode.change(s->ode.self, s->which);
    t = begin + h;
    gsl_odeiv2_step_reset(s->step);
    gsl_odeiv2_evolve_reset(s->evolve);
  }
}

static void destroy(void *self) {
  gsl_solver *s = self;
  gsl_odeiv2_evolve_free(s->evolve);
  gsl_odeiv2_control_free(s->control);
  gsl_odeiv2_step_free(s->trial);
  gsl_odeiv2_step_free(s->step);
  free(s);
}

extern const ethd__peer_ode peer_ode[];
const ethd__peer_ode peer_ode[] = {
    {"GSL " GSL_VERSION " rkf45", 1e-4, 1e-12, 10, 0, create_rkf45, work, destroy},
    {"GSL " GSL_VERSION " rk8pd", 1e-4, 1e-12, 10, 0, create_rk8pd, work, destroy},
    {0},
};
