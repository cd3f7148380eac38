/* An application's floating-point mode: its rounding, its traps, whether it flushes subnormal numbers. The controller, its
   scenes and setups give the same bytes in each, no trap is taken, and the application has its mode back. All other
   functions under traps: tests/fp_traps.sh. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "denormals.h"
#include "ethd/config.h"
#include "ethd/maths.h"
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

/* ---- NaN, infinities and poles, in the functions that do without the mode ---- */

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
