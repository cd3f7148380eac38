/* An application's floating-point mode: its rounding, its traps, whether it flushes subnormal numbers. The controller, its
   scenes and setups give the same bytes in each, no trap is taken, and the application has its mode back. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "denormals.h"
#include "ethd/cap.h"
#include "ethd/config.h"
#include "ethd/estimate.h"
#include "ethd/maths.h"
#include "ethd/sim.h"
#include "ethd/solids.h"
#include "unit/rig.h"

#define TICKS 250
#define USUAL_TRAPS (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW)

typedef struct mode {
  int rounding, traps, flushes;
} mode;

static const mode modes[] = {{FE_TONEAREST, 0, 0},
                             {FE_UPWARD, 0, 0},
                             {FE_DOWNWARD, USUAL_TRAPS, 0},
                             {FE_TOWARDZERO, FE_ALL_EXCEPT, 0},
                             {FE_TONEAREST, FE_ALL_EXCEPT, 1},
                             {FE_UPWARD, FE_ALL_EXCEPT, 1},
                             {FE_DOWNWARD, 0, 1},
                             {FE_TOWARDZERO, USUAL_TRAPS, 1}};
#define MODES (sizeof modes / sizeof *modes)

static uint64_t control_word(void) {
#if defined(__SSE__)
  return _mm_getcsr() & 0xffc0u;
#else
  return (uint64_t)fegetround();
#endif
}

static void take(const mode *m) {
  (void)(m->flushes ? ethd__denormals_flush() : ethd__denormals_keep());
  fesetround(m->rounding);
  feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(m->traps);
}

static void leave(void) {
  fedisableexcept(FE_ALL_EXCEPT);
  fesetround(FE_TONEAREST);
  (void)ethd__denormals_keep();
}

/* Does this in a mode, and asserts that it leaves the mode alone. */
#define IN(m, ...)                                           \
  do {                                                       \
    take(m);                                                 \
    const uint64_t before_ = control_word();                 \
    const int traps_ = fegetexcept(), round_ = fegetround(); \
    __VA_ARGS__;                                             \
    const uint64_t after_ = control_word();                  \
    const int kept_ = fegetexcept(), rounds_ = fegetround(); \
    leave();                                                 \
    ck_assert_uint_eq(after_, before_);                      \
    ck_assert_int_eq(kept_, traps_);                         \
    ck_assert_int_eq(rounds_, round_);                       \
  } while (0)

/* ---- the controller ---- */

typedef struct chosen {
  const ethd_transition_law *transition;
  const ethd_contact_law *contact;
  ethd_velocity_method velocity;
  ethd_filter_method filter;
  ethd_fit_method fit;
  int source; /* of the finger: 0 as known, 1 readings of its centre, 2 frames of rays */
  int limits;
} chosen;

static const char room[] = "material soft k_e=300\n"
                           "halfplane -1 0 -0.238\n"
                           "circle 0.3 0.31 0.03 material=soft\n"
                           "polyline 0.22 0.33 0.26 0.34 0.3 0.37 0.33 0.31\n"
                           "polygon 0.2 0.1 0.3 0.12 0.27 0.17 0.24 0.15\n"
                           "segment 0.31 0.2 0.33 0.28\n";

static ethd_setup setup_of(const chosen *c, const ethd_scene *scene) {
  ethd_setup s = ethd_setup_default();
  s.scene = scene;
  ethd_setup_transition(&s, c->transition);
  ethd_setup_contact(&s, c->contact);
  ethd_setup_velocity(&s, c->velocity);
  ethd_setup_filter(&s, c->filter);
  ethd_setup_fit(&s, c->fit);
  if (!c->limits) return s;
  s.limits = ethd_limits_device();
  s.limits.torque = 1;
  s.limits.torque_rate = 100;
  s.limits.speed = 2;
  s.limits.stop_time = 1;
  s.limits.energy = 0.01;
  s.limits.nominal_torque = 0.5;
  s.limits.heat_time = 10;
  s.limits.latch = 0;
  s.dynamics = (ethd_dynamics){{0.12, 0.12}, 0.4, 1, 1e-3};
  return s;
}

static ethd_sense sense_at(const ethd_setup *s, const chosen *c, int tick) {
  ethd_sense x;
  memset(&x, 0, sizeof x);
  const ethd_vec ring = {0.262 - 0.02 * sin(0.03 * tick), 0.25 + 0.06 * sin(0.011 * tick)};
  ck_assert_int_eq(ethd_arm_angles(&s->arm, ring, -1, x.q), ETHD_OK);
  x.time_ns = x.sample_ns = tick * (int64_t)1000000;
  if (c->source == 0) {
    x.have = ETHD_HAVE_FINGER;
    ethd_vec_put((ethd_vec){ring.x - 0.001, ring.y}, x.finger);
  } else if (tick % 3 == 0) {
    x.have = c->source == 1 ? ETHD_HAVE_CENTRE : ETHD_HAVE_RAYS;
    x.centre[0] = -0.001;
    ethd_fit_rays(s->ring_radius, s->finger_radius, (ethd_vec){-0.001, 0}, x.rays);
  }
  if (tick == 70) x.q[0] = NAN; /* row INPUT */
  return x;
}

/* Runs a controller in a mode; all of it but the senses. */
static void run(const chosen *c, const mode *m, ethd_trace traces[TICKS]) {
  ethd_scene *scene;
  ethd_control *control;
  ethd_error error;
  ethd_status status;
  IN(m, status = ethd_scene_parse(room, sizeof room - 1, &scene, &error));
  ck_assert_msg(status == ETHD_OK, "line %d: %s", error.line, error.name);
  ethd_setup setup;
  IN(m, setup = setup_of(c, scene));
  IN(m, status = ethd_control_create(&setup, &control, &error));
  ck_assert_msg(status == ETHD_OK, "%s", error.name);
  for (int tick = 0; tick < TICKS; tick++) {
    const ethd_sense sense = sense_at(&setup, c, tick);
    ethd_command command, rehearsed;
    if (tick == 150) {
      ethd_setup_transition(&setup, &ethd_transition_smooth);
      IN(m, status = ethd_control_post(control, &setup, &error));
      ck_assert_int_eq(status, ETHD_OK);
    }
    if (tick == 200) IN(m, ethd_control_restart(control));
    if (tick % 50 == 0) IN(m, (void)ethd_control_rehearse(control, &sense, &rehearsed));
    IN(m, (void)ethd_control_step(control, &sense, &command, &traces[tick]));
    ck_assert(memcmp(command.torque, traces[tick].tau, sizeof command.torque) == 0);
  }
  ethd_control_destroy(control);
  ethd_scene_destroy(scene);
}

static void compare(const chosen *c) {
  static ethd_trace expected[TICKS], found[TICKS];
  const mode usual = {FE_TONEAREST, 0, 1};
  run(c, &usual, expected);
  for (size_t i = 0; i < MODES; i++) {
    run(c, &modes[i], found);
    for (int tick = 0; tick < TICKS; tick++)
      ck_assert_msg(memcmp(&found[tick], &expected[tick], sizeof found[tick]) == 0,
                    "%s, %s, velocity %d, filter %d, fit %d, source %d, limits %d: tick %d differs in mode %zu",
                    c->transition->law.id, c->contact->law.id, (int)c->velocity, (int)c->filter, (int)c->fit, c->source,
                    c->limits, tick, i);
  }
}

TEST(test_laws) {
  static const ethd_transition_law *const transitions[] = {&ethd_transition_abrupt, &ethd_transition_smooth,
                                                           &ethd_transition_offset, &ethd_transition_predictive};
  static const ethd_contact_law *const contacts[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                                     &ethd_contact_hunt_crossley};
  for (int limits = 0; limits < 2; limits++)
    for (int source = 0; source < 3; source++)
      for (int t = 0; t < 4; t++)
        for (int k = 0; k < (t == 2 ? 3 : 1); k++)
          compare(&(chosen){transitions[t], contacts[k], ETHD_VELOCITY_LOWPASS, ETHD_FILTER_CA, ETHD_FIT_KASA, source,
                            limits});
}

TEST(test_estimators) {
  for (int v = 0; v < ETHD_VELOCITY_COUNT; v++)
    compare(&(chosen){&ethd_transition_offset, &ethd_contact_kelvin_voigt, (ethd_velocity_method)v, ETHD_FILTER_CA,
                      ETHD_FIT_KASA, 0, 1});
  for (int f = 0; f < ETHD_FILTER_COUNT; f++)
    compare(&(chosen){&ethd_transition_predictive, &ethd_contact_kelvin_voigt, ETHD_VELOCITY_LOWPASS,
                      (ethd_filter_method)f, ETHD_FIT_KASA, 1, 0});
  for (int f = 0; f < ETHD_FIT_COUNT; f++)
    compare(&(chosen){&ethd_transition_offset, &ethd_contact_kelvin_voigt, ETHD_VELOCITY_LOWPASS, ETHD_FILTER_CA,
                      (ethd_fit_method)f, 2, 0});
}

/* ---- a law of somebody else's ---- */

static int law_saw_traps;

/* Divides by zero, and turns traps on where its parameter says so. */
static ethd_status divides(const double *p, void *state, double gap, double speed, int entering, double *force) {
  volatile double zero = 0, infinite = 1 / zero;
  (void)state, (void)entering, (void)speed, (void)infinite;
  law_saw_traps += fegetexcept() != 0;
  if (p[0] != 0) feenableexcept(FE_INVALID);
  *force = gap < 0 ? -100 * gap : 0;
  return ETHD_OK;
}

TEST(test_foreign_law) {
  static const ethd_param params[] = {{"traps", "1", 0, 1, 0, "turns traps on"}};
  static const ethd_contact_law law = {
      .law = {sizeof law, ETHD_ABI, ETHD_CONTACT, 0, "divides", "divides by zero", params, 1, NULL, NULL},
      .step = divides};
  static const mode traps = {FE_UPWARD, USUAL_TRAPS, 0};
  for (int bad = 0; bad < 2; bad++) {
    rig r;
    rig_open(&r, RIG_WALL);
    ethd_setup_contact(&r.setup, &law);
    ethd_setup_transition(&r.setup, &ethd_transition_abrupt);
    r.setup.contact_p[0] = bad;
    rig_start(&r);
    motion m = rig_at(-0.002, 0.01, 0.001);
    const ethd_sense sense = rig_sense(&r.setup.arm, &m);
    IN(&traps, r.status = ethd_control_step(r.control, &sense, &r.command, &r.trace));
    ck_assert_int_eq(r.status, bad ? ETHD_E_LAW : ETHD_OK);
    if (bad) ck_assert_double_eq(rig_poll(&r).value, 100 * ETHD_CONTACT - ETHD_E_FENV);
    rig_close(&r);
  }
  ck_assert_int_eq(law_saw_traps, 0);
}

/* ---- what an application calls beside the controller, with the traps that numerical programs have ---- */

TEST(test_configurations) {
  static const char text[] = "[transition]\nlaw = predictive\n[contact]\nk_e = 300.1\n[limits]\ntorque = 1\n";
  char message[ETHD_MESSAGE_MAX];
  double expected = 0;
  for (size_t i = 0; i < MODES; i++) {
    ethd_config *config;
    ethd_setup setup;
    ethd_status status;
    double stiffness;
    IN(&modes[i], status = ethd_config_parse(text, sizeof text - 1, NULL, NULL, &config, message));
    ck_assert_msg(status == ETHD_OK, "%s", message);
    setup = config->setup;
    IN(&modes[i], status = ethd_config_transition(config, "offset", &setup, message));
    ck_assert_int_eq(status, ETHD_OK);
    IN(&modes[i], status = ethd_config_set(config, "contact.b_e", "0.1", &setup, message));
    ck_assert_int_eq(status, ETHD_OK);
    IN(&modes[i], status = ethd_config_set(config, "contact.b_e", "nan", &setup, message));
    ck_assert_int_ne(status, ETHD_OK);
    stiffness = ethd_setup_get(&setup, "contact.k_e");
    if (i == 0) expected = stiffness;
    ck_assert(stiffness == expected && ethd_setup_get(&setup, "contact.b_e") == 0.1);
    ethd_config_free(config);
  }
}

/* NaN where it is allowed, or refused. */
TEST(test_numbers_that_are_none) {
  static const mode traps = {FE_TONEAREST, USUAL_TRAPS, 0};
  ethd_error error;
  ethd_setup setup = ethd_setup_default();
  ethd_status status[4];
  double range;
  ethd_setup_transition(&setup, &ethd_transition_predictive);
  IN(&traps, status[0] = ethd_setup_set(&setup, "contact.k_e", NAN, &error));
  IN(&traps, status[1] = ethd_setup_set(&setup, "contact.k_e", 0.1, &error); range = ethd_setup_range(&setup));
  setup.limits.speed = NAN;
  IN(&traps, status[2] = ethd_limits_check(&setup.limits, &error); status[3] = ethd_setup_check(&setup, &error));
  ck_assert_int_eq(status[0], ETHD_E_NOT_FINITE);
  ck_assert_int_eq(status[1], ETHD_OK);
  ck_assert_int_eq(status[2], ETHD_E_NOT_FINITE);
  ck_assert_int_eq(status[3], ETHD_E_NOT_FINITE);
  ck_assert(range > 0);
}

TEST(test_scenes_alone) {
  static const mode traps = {FE_TONEAREST, USUAL_TRAPS, 0};
  ethd_scene *scene = rig_scene(room);
  const ethd_arm arm = {ETHD_ARM_PARALLEL, 0.25, 0.25};
  for (int i = 0; i < 200; i++) {
    const ethd_vec x = {i == 7 ? NAN : 0.2 + 0.001 * i, i == 8 ? INFINITY : 0.2 + 0.0007 * i};
    ethd_touch touches[8];
    ethd_scene_hint hint = {0};
    ethd_nearest nearest;
    double q[2];
    IN(&traps, (void)ethd_scene_touches(scene, x, i == 9 ? NAN : 0.1, touches, 8); ethd_scene_query(scene, x, &nearest);
       ethd_scene_query_near(scene, x, &hint, &nearest));
    if (isfinite(x.x) && isfinite(x.y))
      IN(&traps, ethd_scene_follow(scene, 0, x, (ethd_vec){0.238, 0.25}, touches);
         (void)!ethd_arm_angles(&arm, x, 1, q));
  }
  ethd_scene *pruned = NULL;
  ethd_scene_info info;
  ethd_error error;
  ethd_status status;
  IN(&traps, status = ethd_scene_prune(scene, &arm, 0.02, &pruned, &error); ethd_scene_describe(scene, &info);
     (void)ethd_scene_out_of_reach(scene, &arm, NAN));
  ck_assert_int_eq(status, ETHD_OK);
  ethd_scene_destroy(pruned);
  ethd_scene_destroy(scene);
}

/* ---- NaN, infinities and poles, each in each place ---- */

static const double odd[] = {NAN,   INFINITY, -INFINITY, 0,      -0.0,  1,      -1,     0.3,
                             709.9, -746,     750,       1e-310, 1e200, -1e308, DBL_MAX};
#define ODD (int)(sizeof odd / sizeof *odd)
static const mode usual_traps = {FE_TONEAREST, USUAL_TRAPS, 0};

/* Equal, or both NaN. */
static bool alike(double a, double b) { return a == b || (isnan(a) && isnan(b)); }

TEST(test_odd_maths) {
  volatile double y[7];
  double sine, cosine;
  for (int i = 0; i < ODD; i++) {
    const double x = odd[i];
    IN(&usual_traps, y[0] = ethd_exp(x); y[1] = ethd_log(x); y[2] = ethd_tanh(x); y[3] = ethd_sin(x);
       y[4] = ethd_cos(x); ethd_sincos(x, &sine, &cosine));
    ck_assert(alike(y[3], sine) && alike(y[4], cosine));
    ck_assert(isnan(y[3]) == !isfinite(x) && isnan(y[4]) == !isfinite(x));
    ck_assert(alike(y[0], isnan(x) ? x : x > 709.8 ? INFINITY : x <= -746 ? 0 : y[0]));
    ck_assert(alike(y[1], isnan(x) || x < 0 ? (double)NAN : x == 0 ? -INFINITY : isinf(x) ? x : y[1]));
    ck_assert(alike(y[2], isnan(x) ? x : fabs(x) > 20 ? copysign(1, x) : y[2]));
    for (int k = 0; k < ODD; k++) {
      IN(&usual_traps, y[5] = ethd_atan2(x, odd[k]));
      ck_assert_int_eq(isnan(y[5]), isnan(x) || isnan(odd[k]));
    }
  }
  IN(&usual_traps, y[0] = ethd_exp(0x1.62e42fefa39efp+9); y[1] = ethd_exp(0x1.62e42fefa39fp+9));
  ck_assert(y[0] > 1.797e308 && isfinite(y[0]) && isinf(y[1])); /* the last that is finite, and the next */
}

TEST(test_odd_arms_and_limits) {
  const ethd_arm arms[] = {{ETHD_ARM_PARALLEL, 0.25, 0.25}, {ETHD_ARM_SERIAL, 0.25, 0.2}};
  ethd_error error;
  for (int n = 0; n < 2 * ODD * ODD; n++) {
    const ethd_arm *arm = &arms[n % 2];
    const double a = odd[n / 2 % ODD], b = odd[n / 2 / ODD], q[2] = {a, b};
    ethd_status status;
    double angles[2] = {7, 7}, value = b;
    ethd_pose pose;
    IN(&usual_traps, status = ethd_arm_angles(arm, (ethd_vec){a, b}, 1, angles); ethd_arm_pose(arm, q, &pose));
    const bool reaches =
        fabs(a) <= 0.5 && fabs(b) <= 0.5 && hypot(a, b) >= arm->link1 - arm->link2 && hypot(a, b) <= 0.45;
    if (reaches) ck_assert_int_eq(status, ETHD_OK);
    if (!(fabs(a) <= 0.5 && fabs(b) <= 0.5)) ck_assert_int_eq(status, ETHD_E_UNREACHABLE);
    ck_assert(status == ETHD_OK || angles[0] == 7);
    ck_assert_int_eq(isfinite(pose.x.x) != 0, isfinite(a) && isfinite(b) && (n % 2 == 0 || isfinite(a + b)));
    const ethd_param row = {"x", "1", 0, 1, 0.5, "one"}, bad = {"x", "1", 0, a, b, "bad"};
    IN(&usual_traps, status = ethd_params_check(&row, 1, &value, &error);
       (void)!ethd_params_check_table(&bad, 1, &error));
    ck_assert_int_eq(status, b >= 0 && b <= 1 ? ETHD_OK : isfinite(b) ? ETHD_E_RANGE : ETHD_E_NOT_FINITE);
  }
}

/* A torque that isn't finite, and a speed or a place that isn't a number, end in zero torque; never in more than the limit. */
TEST(test_odd_guards) {
  const ethd_arm arm = {ETHD_ARM_PARALLEL, 0.25, 0.25};
  const double q[2] = {0.3, 0.9};
  for (int n = 0; n < 4 * ODD * ODD; n++) {
    const double a = odd[n / 4 % ODD], b = odd[n / 4 / ODD];
    const ethd_dynamics dynamics = {{a, 0.12}, 0.4, b, n % 2 ? a : 1e-3}, known = {{0.12, 0.12}, 0.4, 1, 1e-3};
    ethd_limits limits = ethd_limits_device();
    ethd_guard_state state;
    ethd_guard_device device;
    ethd_pose pose;
    double torque[2] = {0.1, 0.1}, heat, t[3];
    ethd_arm_pose(&arm, q, &pose);
    memset(&state, 0, sizeof state);
    limits.speed = limits.torque = a;
    IN(&usual_traps, device = ethd_guard_device_of(&arm, &dynamics, b, 1e-3, 1e-3);
       t[0] = ethd_guard_damping(&device, a, true); t[1] = ethd_guard_brake_time(&device, &limits);
       t[2] = ethd_guard_stop_time(&device, &limits));
    if (isnan(a)) ck_assert(t[1] == 0 && t[2] == 0); /* nothing is braked */
    device = ethd_guard_device_of(&arm, &known, 0.005, 1e-3, 1e-3);
    ck_assert(t[0] == t[0] || !(a > 0 && isfinite(a)) || !isfinite(b));
    limits.torque = 1;
    limits.torque_rate = 100;
    limits.speed = 1;
    limits.nominal_torque = 0.5;
    limits.heat_time = 1;
    limits.margin = 0.02;
    limits.reach[1] = 0.45;
    ethd_guard_motion m = {.pose = &pose, .v = {0.1, 0}, .qd = {0.1, 0}, .estimated = true, .dt = 1e-3};
    ethd_vec_put((ethd_vec){a, b}, n % 4 == 0 ? torque : n % 4 == 1 ? m.qd : (double[2]){0, 0});
    if (n % 4 == 2) m.v = (ethd_vec){a, b};
    if (n % 4 == 3) pose.x = (ethd_vec){a, b};
    IN(&usual_traps, (void)ethd_guard_step(&limits, &device, &state, &m, torque);
       heat = ethd_guard_heat(&limits, &state, b));
    ck_assert(fabs(torque[0]) <= 1 && fabs(torque[1]) <= 1);
    if (n % 4 == 0 && !(isfinite(a) && isfinite(b))) ck_assert(torque[0] == 0 && torque[1] == 0);
    (void)heat;
  }
}

TEST(test_odd_readings) {
  double rays[ETHD_RAYS], p[ETHD_PARAMS_MAX];
  ethd_error error;
  ethd_status status;
  ethd_scene *scene = rig_scene(room);
  for (int n = 0; n < ODD * ODD; n++) {
    const double a = odd[n % ODD], b = odd[n / ODD];
    ethd_touch touch;
    IN(&usual_traps, ethd_fit_rays(0.012, 0.0075, (ethd_vec){a, b}, rays);
       ethd_scene_follow(scene, 0, (ethd_vec){a, b}, (ethd_vec){0.2, 0.2}, &touch);
       ethd_scene_follow(scene, 2, (ethd_vec){0.2, 0.2}, (ethd_vec){a, b}, &touch));
    if (isnan(a)) ck_assert(isnan(rays[0]));
    for (int f = 0; f < ETHD_FIT_COUNT; f++) {
      ethd_fit fit;
      ethd_finger finger;
      ethd_params_default(ethd_fit_methods[f].params, ethd_fit_methods[f].param_count, p);
      IN(&usual_traps, status = ethd_fit_prepare((ethd_fit_method)f, p, 0.012, 0.0075, &fit, &error));
      ck_assert_int_eq(status, ETHD_OK);
      IN(&usual_traps, status = ethd_fit_step(&fit, rays, &finger));
      if (isnan(a) || isnan(b)) ck_assert_int_eq(status, ETHD_STATUS_STALE);
      if (a == 0 && b == 0) ck_assert_int_eq(status, ETHD_OK);
    }
    for (int f = 0; f < ETHD_FILTER_COUNT; f++) {
      ethd_filter filter;
      ethd_filter_state state = {.started = 0};
      ethd_vec x, v;
      ethd_params_default(ethd_filter_methods[f].params, ethd_filter_methods[f].param_count, p);
      IN(&usual_traps, status = ethd_filter_prepare((ethd_filter_method)f, p, 0.001, &filter, &error));
      ck_assert_int_eq(status, ETHD_OK);
      IN(&usual_traps, ethd_filter_start(&filter, &state, (ethd_vec){a, b}, (ethd_vec){b, a});
         ethd_filter_predict(&filter, &state, 0.001); (void)ethd_filter_update(&filter, &state, (ethd_vec){0, 0}, b);
         ethd_filter_output(&filter, &state, &x, &v); ethd_filter_predict(&filter, &state, a));
      ethd_vec3 x3, v3;
      const ethd_filter_reading reading = {.x = {0, a, b}, .v = {b, a, 0}, .age = b, .noise = 0.01, .v_noise = 1};
      IN(&usual_traps, ethd_filter_start3(&filter, &state, (ethd_vec3){a, b, a}, (ethd_vec3){b, a, b});
         ethd_filter_predict(&filter, &state, 0.001); (void)ethd_filter_update3(&filter, &state, &reading);
         ethd_filter_output3(&filter, &state, &x3, &v3));
    }
    ethd_cap cap = {.count = 4, .finger_radius = 8e-3, .reach = 14e-3, .gate = 1e-3, .out = {0, 0, -1}};
    const ethd_vec3 from[4] = {{0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}, {-0.01, 0, 0}};
    for (int k = 0; k < 4; k++) cap.rays[k] = (ethd_cap_ray){from[k], ethd_vec3_scale(-100, from[k])};
    for (int sought = 0; sought < 2; sought++) {
      double distances[4];
      ethd_cap_finger finger;
      ethd_vec3 sd;
      cap.seeks_radius = sought;
      IN(&usual_traps, status = ethd_cap_check(&cap, &error));
      ck_assert_int_eq(status, ETHD_OK);
      IN(&usual_traps, ethd_cap_rays(&cap, (ethd_vec3){a, b, a}, a, distances);
         status = ethd_cap_bound(&cap, (ethd_vec3){b, a, 0}, a, &sd));
      for (int k = 0; k < 4; k++) distances[k] = k % 2 ? a : b;
      IN(&usual_traps, status = ethd_cap_step(&cap, distances, &finger));
      if (isnan(a) || isnan(b)) ck_assert_int_eq(status, ETHD_STATUS_STALE);
    }
    for (int i = 0; i < ETHD_VELOCITY_COUNT; i++) {
      ethd_velocity velocity;
      ethd_velocity_state state = {.count = 0};
      ethd_params_default(ethd_velocity_methods[i].params, ethd_velocity_methods[i].param_count, p);
      IN(&usual_traps, status = ethd_velocity_prepare((ethd_velocity_method)i, p, 0.001, &velocity, &error));
      ck_assert_int_eq(status, ETHD_OK);
      for (int tick = 0; tick < 20; tick++)
        IN(&usual_traps,
           ethd_velocity_step(&velocity, &state, tick == 9 ? a : 0, tick == 10 ? b : 0, tick == 11 ? b : 0.001));
    }
  }
  ethd_scene_destroy(scene);
}

static const char plants[] = "apps/config";

TEST(test_simulated_devices) {
  static const char *const names[] = {"n", "b", "p"};
  char message[ETHD_MESSAGE_MAX], path[64];
  for (int n = 0; n < 3 * ETHD_READING_COUNT; n++) {
    ethd_plant plant;
    ethd_status status;
    ethd_sim *sim;
    ethd_error error;
    ethd_sim_tap tap;
    ethd_sense sense;
    ethd_truth truth;
    snprintf(path, sizeof path, "%s/%s.plant", plants, names[n % 3]);
    IN(&usual_traps, status = ethd_plant_load(path, &plant, message); ethd_plant_finger(&plant, n / 3));
    ck_assert_msg(status == ETHD_OK, "%s", message);
    const ethd_sim_def def = {plant, {ETHD_ARM_PARALLEL, 0.25, 0.25}, 0.012, 0.001, 0.001, ETHD_SIM_FAST};
    IN(&usual_traps, status = ethd_sim_create(&def, &sim, &error));
    ck_assert_int_eq(status, ETHD_OK);
    IN(&usual_traps, ethd_sim_draw(&plant, 1, 2, 0.3, (ethd_vec){0.238, 0.25}, &tap);
       status = ethd_sim_start(sim, &tap));
    ck_assert_int_eq(status, ETHD_OK);
    for (int tick = 0; tick < 300; tick++) {
      const ethd_command command = {.torque = {tick < 20 ? 0 : odd[tick % ODD], tick < 20 ? 0 : odd[tick / ODD % ODD]}};
      IN(&usual_traps, ethd_sim_read(sim, &sense); ethd_sim_truth(sim, &truth); ethd_sim_write(sim, &command));
      ck_assert(isfinite(truth.ring[0]) && isfinite(truth.finger[1]));
    }
    ethd_sim_destroy(sim);
  }
}

TEST(test_odd_simulations) {
  char message[ETHD_MESSAGE_MAX], path[64], file[] = "/tmp/ethd-plant-XXXXXX";
  ethd_plant plant, other;
  ethd_status status;
  ethd_error error;
  snprintf(path, sizeof path, "%s/n.plant", plants);
  ck_assert_int_eq(ethd_plant_load(path, &plant, message), ETHD_OK);
  ethd_sim_def def = {plant, {ETHD_ARM_PARALLEL, 0.25, 0.25}, 0.012, 0.001, 0.001, ETHD_SIM_FAST};
  ethd_sim *sim, *none;
  ck_assert_int_eq(ethd_sim_create(&def, &sim, &error), ETHD_OK);
  for (int n = 0; n < ODD * ODD; n++) {
    const double a = odd[n % ODD], b = odd[n / ODD];
    ethd_sim_tap tap;
    ethd_vec x, v;
    double end;
    ethd_sim_draw(&plant, 1, 2, 0.3, (ethd_vec){0.238, 0.25}, &tap);
    tap.path.from.x = a;
    tap.path.speed = b;
    IN(&usual_traps, status = ethd_sim_start(sim, &tap); ethd_path_at(&tap.path, a, &x, &v);
       end = ethd_path_end(&tap.path));
    ck_assert(status == ETHD_OK ? fabs(a) < 0.5 && b > 0 && end > 0 : status < 0);
    const ethd_path_sample samples[] = {{0, 0.3, 0.25}, {a, b, 0.25}, {1, 0.3, 0.25}};
    ethd_sim_draw(&plant, 1, 2, 0.3, (ethd_vec){0.238, 0.25}, &tap);
    tap.path = (ethd_path){.samples = samples, .sample_count = 3};
    IN(&usual_traps, status = ethd_sim_start(sim, &tap); ethd_path_at(&tap.path, b, &x, &v));
    if (!isfinite(a) || !isfinite(b)) ck_assert_int_eq(status, ETHD_E_ARGUMENT);
    ethd_sim_draw(&plant, 1, 2, 0.3, (ethd_vec){0.238, 0.25}, &tap);
    tap.finger_radius = a;
    IN(&usual_traps, status = ethd_sim_start(sim, &tap));
    ck_assert_int_eq(status, a > 0 && a < 0.012 ? ETHD_OK : ETHD_E_RANGE);
    def.period = a;
    def.plant.mass[0] = b;
    IN(&usual_traps, status = ethd_sim_create(&def, &none, &error));
    ck_assert_int_eq(status == ETHD_OK, a > 0 && a <= 1 && b >= 1e-3 && b <= 1000 && a >= 1e-6);
    if (!status) ethd_sim_destroy(none);
  }
  ethd_sim_destroy(sim);
  int fd = mkstemp(file);
  static const char text[] = "[device]\nmass_x = nan\n";
  ck_assert_int_eq(write(fd, text, sizeof text - 1), sizeof text - 1);
  close(fd);
  IN(&usual_traps, status = ethd_plant_load(file, &other, message));
  unlink(file);
  ck_assert_int_eq(status, ETHD_E_RANGE);
  ck_assert_msg(strstr(message, "device.mass_x: found \"nan\", 0.001 to 1000 kg is allowed") != NULL, "%s", message);
}

/* Solids read in any mode give the same surfaces to the bit, and no place or pose is trapped. */
TEST(test_odd_solids) {
  static const char text[] =
      "sphere 0.1 0.2 0.3 0.1\nhalfspace 0.6 0 0.8000001 0.1\nbox 1 0 0 0.1 0.2 0.3 0.3 0.2 0.1\n"
      "capsule 0 0 0 0.1 0.7 0.3 0.1\n";
  ethd_surface first[4], again[4];
  for (size_t m = 0; m < MODES; m++) {
    ethd_solids *solids;
    ethd_status status;
    IN(&modes[m], status = ethd_solids_parse(text, sizeof text - 1, &solids, NULL));
    ck_assert_int_eq(status, ETHD_OK);
    memset(again, 0, sizeof again);
    ck_assert_uint_eq(ethd_solids_surfaces(solids, NULL, (ethd_vec3){0.3, 0.4, 0.5}, INFINITY, again, 4), 4);
    if (m == 0) memcpy(first, again, sizeof first);
    ck_assert(memcmp(first, again, sizeof first) == 0);
    for (int i = 0; i < ODD * 13; i++) {
      ethd_body_pose3 pose = {{0.1, 0.2, 0.3}, {1, 0, 0, 0}, {1, 2, 3}, {4, 5, 6}};
      const double v = odd[i / 13];
      double *const at[] = {&pose.x.x, &pose.x.y, &pose.x.z, &pose.v.x, &pose.v.z, &pose.rate.x, &pose.rate.z};
      double x[3] = {0.3, 0.4, 0.5}, range = 1;
      *(i % 13 < 7    ? at[i % 13]
        : i % 13 < 9  ? &pose.orientation[i % 13 - 7]
        : i % 13 < 12 ? &x[i % 13 - 9]
                      : &range) = v;
      IN(&usual_traps, (void)ethd_solids_surfaces(solids, &pose, ethd_vec3_of(x), range, again, 4);
         (void)ethd_solids_surfaces(solids, NULL, ethd_vec3_of(x), range, again, 4));
    }
    ethd_solids_destroy(solids);
  }
}
