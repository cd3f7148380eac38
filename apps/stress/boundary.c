/* The sampled loop's boundary of stability: contact law kelvin-voigt with each linear velocity
   estimator, through the whole step, against the closed form.

   A constant push holds the ring in the wall and the hysteresis of the law's two branches holds it on
   the entering one, so that a small swing sees F = -K x - B v and nothing else. */
#include <math.h>

#include "bounds/stability.h"
#include "stress/curve.h"
#include "stress/rig.h"
#include "stress/stress.h"

#define MASS 0.3
#define PERIOD 0.001
#define SWING 1e-6 /* m */

static const struct {
  const char *name;
  ethd_velocity_method method;
  double value;
} estimators[] = {{"difference", ETHD_VELOCITY_DIFFERENCE, 0},
                  {"lowpass 130 Hz", ETHD_VELOCITY_LOWPASS, 130},
                  {"lowpass 400 Hz", ETHD_VELOCITY_LOWPASS, 400},
                  {"lsq of 4", ETHD_VELOCITY_LSQ, 4}};

typedef struct point {
  const ethd__curve *curve;
  double th, stiffness, damping; /* on the curve */
} point;

/* Growth per tick with both gains `scale` times those of the curve: as a mass 1 / scale as large. */
static double growth(const point *p, double scale) {
  ethd__stress_rig rig;
  double k = scale * p->stiffness, b = scale * p->damping, most = 10 * SWING;
  double push = 4 * most * (k + b * p->th / PERIOD);
  ethd__stress_rig_open(&rig, MASS, -push / k);
  ethd__stress_rig_velocity(&rig, p->curve->method, p->curve->value);
  ethd_setup_transition(&rig.setup, &ethd_transition_smooth);
  ethd__stress_set(&rig.setup, "contact.k_e", k);
  ethd__stress_set(&rig.setup, "contact.b_e", b);
  ethd__stress_set(&rig.setup, "transition.v_hysteresis", 1);
  rig.delay = p->curve->delay;
  rig.push.x = -push;
  ethd__stress_rig_start(&rig, SWING * p->th / PERIOD);
  ethd__swing swing = {.order = 1, .settle = 200, .span = 1800, .floor = 1e-3 * SWING * p->th, .ceiling = most * p->th};
  double rate = ethd__stress_rig_growth(&rig, &swing);
  ethd__stress_rig_close(&rig);
  return rate;
}

/* The scale at which the swing begins to grow. */
static double found(const point *p) {
  double low = 0.9, high = 1.1;
  while (high - low > 2e-4) {
    double middle = (low + high) / 2;
    if (growth(p, middle) > 0)
      high = middle;
    else
      low = middle;
  }
  return (low + high) / 2;
}

static void one_curve(ethd__stress_log *log, FILE *data, const ethd__curve *curve, const char *name) {
  int points = (int)ethd__stress_pick(log, 8, 40, 40);
  double end = ethd__curve_end(curve), inside[40], outside[40];
  for (int i = 0; i < points; i++) {
    point p = {curve, end * (0.1 + 0.89 * i / (points - 1)), 0, 0};
    ethd__curve_at(curve, p.th, &p.stiffness, &p.damping);
    double scale = found(&p);
    inside[i] = growth(&p, 0.98);
    outside[i] = growth(&p, 1.02);
    ethd__stress_near(log, "N/m", scale * p.stiffness, p.stiffness, 5e-3, "%s, n = %d: K_e (and B_e) found", name,
                      curve->delay);
    if (data)
      fprintf(data, "%s,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", name, curve->delay, curve->mass, curve->period,
              p.th, p.stiffness, p.damping, scale * p.stiffness, scale * p.damping);
  }
  for (int i = 0; i < points; i++)
    ethd__stress_bound(log, "1", inside[i], 0, "%s, n = %d: 2 %% inside, growth a tick", name, curve->delay);
  for (int i = 0; i < points; i++)
    ethd__stress_bound(log, "1", -outside[i], 0, "%s, n = %d: 2 %% outside, decay a tick", name, curve->delay);
}

/* ---- a transmission that gives way ---- */

/* What plant p's arm is like. */
#define SOFT_MASS 0.09475
#define SOFT_MOTOR 0.01322
#define SOFT_SPRING 3489.6
#define SOFT_DAMPER 5.132
#define RAYS 10 /* of gains whose ratio stays: 40 points in all */

typedef struct ray {
  ethd__sampled_loop loop; /* gains on the boundary, by its radius */
  double th;               /* rad a tick: about how fast it swings */
} ray;

/* Along the ray from small gains up to the first that aren't stable. */
static void find_end(ethd__sampled_loop *l) {
  double k = l->stiffness, b = l->damping, stable = 1e-3, unstable = stable;
  for (;; unstable *= 1.05) {
    l->stiffness = unstable * k;
    l->damping = unstable * b;
    if (!ethd__sampled_stable(l)) break;
    stable = unstable;
  }
  while (unstable / stable > 1 + 1e-6) {
    double middle = sqrt(stable * unstable);
    l->stiffness = middle * k;
    l->damping = middle * b;
    if (ethd__sampled_stable(l))
      stable = middle;
    else
      unstable = middle;
  }
}

static double soft_growth(const ray *r, double scale) {
  const ethd__sampled_loop *l = &r->loop;
  ethd__stress_rig rig;
  double k = scale * l->stiffness, b = scale * l->damping, most = 10 * SWING;
  double push = 4 * most * (k + b * r->th / PERIOD);
  ethd__stress_rig_open(&rig, SOFT_MASS, -push / k);
  ethd__stress_rig_velocity(&rig, l->method, l->p[0]);
  ethd_setup_transition(&rig.setup, &ethd_transition_smooth);
  ethd__stress_set(&rig.setup, "contact.k_e", k);
  ethd__stress_set(&rig.setup, "contact.b_e", b);
  ethd__stress_set(&rig.setup, "transition.v_hysteresis", 1);
  rig.delay = l->delay;
  rig.motor_mass = SOFT_MOTOR;
  rig.spring = SOFT_SPRING;
  rig.damper = SOFT_DAMPER;
  rig.push.x = -push;
  ethd__stress_rig_start(&rig, SWING * r->th / PERIOD);
  ethd__swing swing = {.order = 1, .settle = 200, .span = 1800, .floor = 1e-3 * SWING * r->th, .ceiling = most * r->th};
  double rate = ethd__stress_rig_growth(&rig, &swing);
  ethd__stress_rig_close(&rig);
  return rate;
}

static double soft_found(const ray *r) {
  double low = 0.9, high = 1.1;
  while (high - low > 5e-4) {
    double middle = (low + high) / 2;
    if (soft_growth(r, middle) > 0)
      high = middle;
    else
      low = middle;
  }
  return (low + high) / 2;
}

/* Dampings from half as large again as the hold takes off to many times that. */
static void soft_rays(ethd__stress_log *log, const char *name, ethd_velocity_method method, double value, int delay) {
  for (int i = 0; i < RAYS; i++) {
    ray r = {.loop = {.mass = SOFT_MASS,
                      .motor_mass = SOFT_MOTOR,
                      .spring = SOFT_SPRING,
                      .damper = SOFT_DAMPER,
                      .period = PERIOD,
                      .delay = delay,
                      .method = method,
                      .p = {value},
                      .link = 0.25},
             .th = 0.3};
    r.loop.stiffness = 1000;
    r.loop.damping = 1000 * PERIOD * (delay + 0.5) * 1.5 * pow(1.4, i);
    find_end(&r.loop);
    double scale = soft_found(&r);
    ethd__stress_near(log, "N/m", scale * r.loop.stiffness, r.loop.stiffness, 5e-3,
                      "transmission gives way, %s, n = %d: K_e (and B_e) found", name, delay);
  }
}

static void run(ethd__stress_log *log) {
  FILE *data = ethd__stress_data(log, "boundary.csv",
                                 "velocity,delay_ticks,mass_kg,period_s,th_rad,k_analytic_npm,"
                                 "b_analytic_nspm,k_found_npm,b_found_nspm");
  for (size_t i = 0; i < sizeof estimators / sizeof *estimators; i++)
    for (int n = 0; n <= 2; n++) {
      ethd__curve curve = {MASS, PERIOD, n, estimators[i].method, estimators[i].value};
      one_curve(log, data, &curve, estimators[i].name);
    }
  ethd__stress_close(data);
  for (int n = 0; n <= 1; n++) {
    soft_rays(log, "difference", ETHD_VELOCITY_DIFFERENCE, 0, n);
    soft_rays(log, "lowpass 400 Hz", ETHD_VELOCITY_LOWPASS, 400, n);
  }
}

const ethd__stress ethd__stress_boundary = {
    "boundary", "the sampled wall's boundary of stability, n = 0, 1, 2 ticks of delay", run};
