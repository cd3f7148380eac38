/* The sampled loop's boundary of stability: contact law kelvin-voigt with each linear velocity
   estimator, through the whole step, against the closed form.

   A constant push holds the ring in the wall and the hysteresis of the law's two branches holds it on
   the entering one, so that a small swing sees F = -K x - B v and nothing else. */
#include <math.h>

#include "bounds/stability.h"
#include "stress/curve.h"
#include "stress/mass.h"

#define MASS 0.3
#define PERIOD 0.001
#define SWING 1e-6 /* m */

/* A loop whose gains are on the boundary. */
typedef struct boundary_loop {
  ethd__sampled_loop loop;
  double th; /* rad a tick: how fast it swings there, at least about */
} boundary_loop;

/* The loop in its wall, deep enough for swings of `most` m, with both gains `scale` times as large: where the device is
   rigid, as a mass 1 / scale as large. */
static void open_rig(const boundary_loop *e, double scale, double most, mass_rig *r) {
  const ethd__sampled_loop *l = &e->loop;
  double k = scale * l->stiffness, b = scale * l->damping;
  double push = 4 * most * (k + b * e->th / PERIOD);
  mass_open(r, l->mass, -push / k);
  mass_velocity(r, l->method, l->p[0]);
  ethd_setup_transition(&r->on.setup, &ethd_transition_smooth);
  rig_set(&r->on.setup, "contact.k_e", k);
  rig_set(&r->on.setup, "contact.b_e", b);
  rig_set(&r->on.setup, "transition.v_hysteresis", 1);
  r->delay = l->delay;
  r->motor_mass = l->motor_mass;
  r->spring = l->spring;
  r->damper = l->damper;
  r->push.x = -push;
}

/* Growth per tick. */
static double growth(const boundary_loop *e, double scale) {
  mass_rig r;
  open_rig(e, scale, 10 * SWING, &r);
  mass_start(&r, SWING * e->th / PERIOD);
  swing_span swing = {
      .order = 1, .settle = 200, .span = 1800, .floor = 1e-3 * SWING * e->th, .ceiling = 10 * SWING * e->th};
  double rate = mass_growth(&r, &swing);
  mass_close(&r);
  return rate;
}

/* The scale at which the swing begins to grow. */
static double found(const boundary_loop *e) {
  double low = 0.9, high = 1.1;
  while (high - low > 2e-4) {
    double middle = (low + high) / 2;
    if (growth(e, middle) > 0)
      high = middle;
    else
      low = middle;
  }
  return (low + high) / 2;
}

/* ---- rigid: along the closed form's curve ---- */

static boundary_loop on_curve(const ethd__curve *curve, double th) {
  boundary_loop e = {.loop = {.mass = curve->mass,
                              .period = curve->period,
                              .delay = curve->delay,
                              .method = curve->method,
                              .p = {curve->value}},
                     .th = th};
  ethd__curve_at(curve, th, &e.loop.stiffness, &e.loop.damping);
  return e;
}

static void one_curve(const ethd__curve *curve, const char *name) {
  int points = (int)pick(8, 40);
  double end = ethd__curve_end(curve), inside[40], outside[40];
  for (int i = 0; i < points; i++) {
    boundary_loop e = on_curve(curve, end * (0.1 + 0.89 * i / (points - 1)));
    double k = e.loop.stiffness;
    inside[i] = growth(&e, 0.98);
    outside[i] = growth(&e, 1.02);
    near(found(&e) * k, k, 5e-3, "%s, n = %d: K_e (and B_e) found", name, curve->delay);
  }
  for (int i = 0; i < points; i++) bound(inside[i], 0, "%s, n = %d: 2 %% inside, growth a tick", name, curve->delay);
  for (int i = 0; i < points; i++) bound(-outside[i], 0, "%s, n = %d: 2 %% outside, decay a tick", name, curve->delay);
}

/* ---- a transmission that gives way: along rays of gains whose ratio stays ---- */

/* What plant p's arm is like. */
#define SOFT_MASS 0.09475
#define SOFT_MOTOR 0.01322
#define SOFT_SPRING 3489.6
#define SOFT_DAMPER 5.132
#define SOFT_FRICTION 0.18266
#define RAYS 10 /* 40 points in all */

static boundary_loop soft(ethd_velocity_method method, double value, int delay, double stiffness, double damping) {
  return (boundary_loop){.loop = {.mass = SOFT_MASS,
                                  .motor_mass = SOFT_MOTOR,
                                  .spring = SOFT_SPRING,
                                  .damper = SOFT_DAMPER,
                                  .period = PERIOD,
                                  .stiffness = stiffness,
                                  .damping = damping,
                                  .delay = delay,
                                  .method = method,
                                  .p = {value},
                                  .link = 0.25},
                         .th = 0.3};
}

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

/* Dampings from half as large again as the hold takes off to many times that. */
static void soft_rays(const char *name, ethd_velocity_method method, double value, int delay) {
  for (int i = 0; i < RAYS; i++) {
    boundary_loop e = soft(method, value, delay, 1000, 1000 * PERIOD * (delay + 0.5) * 1.5 * pow(1.4, i));
    find_end(&e.loop);
    near(found(&e) * e.loop.stiffness, e.loop.stiffness, 5e-3,
         "transmission gives way, %s, n = %d: K_e (and B_e) found", name, delay);
  }
}

/* ---- friction: how fast a swing of an unstable loop it still stops ---- */

#define LAST 400 /* ticks: by then a swing has died out or grown */

/* The swing's speed at the end, m/s, after a push of the motor's side to `speed`. */
static double swing_after(const boundary_loop *e, double speed) {
  mass_rig r;
  double most = 0;
  open_rig(e, 1, speed * PERIOD / e->th, &r);
  r.friction = SOFT_FRICTION;
  mass_start(&r, 0);
  r.state.v[ETHD__MOTOR] = speed / r.on.setup.arm.link1;
  for (int k = 0; k < LAST; k++) {
    mass_tick(&r);
    if (k >= LAST - 50) most = fmax(most, fabs(mass_speed(&r)));
  }
  mass_close(&r);
  return most;
}

/* Without delay it is the speed of the push; with a tick of it, friction takes some before the loop answers. */
static void held(double stiffness, double damping, int delay) {
  const boundary_loop e = soft(ETHD_VELOCITY_LOWPASS, 389.1, delay, stiffness, damping);
  double predicted = ethd__sampled_held(ethd__sampled_viscous_needed(&e.loop), SOFT_FRICTION, 0);
  double speed = 0.2 * predicted;
  while (swing_after(&e, speed) < speed) speed *= 1.05;
  bound(predicted, speed, "transmission gives way, n = %d: friction stops swings up to", delay);
  bound(speed, (delay ? 2.5 : 1.2) * predicted, "transmission gives way, n = %d: and none much faster", delay);
}

TEST(test_boundary) {
  for (int i = 0; i < CURVE_ESTIMATORS; i++)
    for (int n = 0; n <= 2; n++) {
      ethd__curve curve = {MASS, PERIOD, n, curve_estimators[i].method, curve_estimators[i].value};
      one_curve(&curve, curve_estimators[i].name);
    }
  for (int n = 0; n <= 1; n++) {
    soft_rays("difference", ETHD_VELOCITY_DIFFERENCE, 0, n);
    soft_rays("lowpass 400 Hz", ETHD_VELOCITY_LOWPASS, 400, n);
    for (double damping = 40; damping < 70; damping += 5)
      for (double stiffness = 500; stiffness < 4000; stiffness += 1000) held(stiffness, damping, n);
  }
}
