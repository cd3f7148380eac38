#include <math.h>
#include <string.h>

#include "core/laws_check.h"
#include "core/named.h"
#include "error.h"
#include "fp_mode.h"
#include "space/plan.h"

#define TRY(expression)                 \
  do {                                  \
    ethd_status status_ = (expression); \
    if (status_ < 0) return status_;    \
  } while (0)

#define INFINITE ((double)INFINITY)
#undef INFINITY
#define INFINITY __builtin_inf()

#define ROW(name, unit, min, max, def, brief) {#name, unit, min, max, def, brief},
const ethd_param ethd_space_numbers[ETHD_SPACE_NUMBER_COUNT] = {ETHD_SPACE_NUMBERS(ROW)};

#define COOKIE 0x45545350u

/* ---- defaults ---- */

ethd_ability ethd_ability_unknown(void) {
  const double nan = (double)NAN;
  return (ethd_ability){nan, nan, nan, nan, nan, nan};
}

void ethd_space_tracking(ethd_space_setup *setup, const ethd_tracking_law *law) {
  setup->tracking = law;
  ethd__law_defaults(law ? &law->law : NULL, setup->tracking_p);
}

void ethd_space_contact(ethd_space_setup *setup, const ethd_contact_law *law) {
  setup->contact = law;
  ethd__law_defaults(law ? &law->law : NULL, setup->contact_p);
}

void ethd_space_transition(ethd_space_setup *setup, const ethd_transition_law *law) {
  setup->transition = law;
  ethd__law_defaults(law ? &law->law : NULL, setup->transition_p);
}

void ethd_space_setup_fill(ethd_space_setup *setup, uint32_t bytes) {
  memset(setup, 0, bytes);
  setup->cookie = COOKIE;
  setup->bytes = bytes;
  if (bytes != sizeof *setup) return;
  setup->kind = ETHD_SPACE_VELOCITY;
  setup->effector = ETHD_EFFECTOR_RING;
  setup->latch = 1;
  ethd_params_default(ethd_space_numbers, ETHD_SPACE_NUMBER_COUNT, &setup->period);
  setup->filter = ETHD_FILTER_CA;
  ethd_params_default(ethd_filter_methods[ETHD_FILTER_CA].params, ethd_filter_methods[ETHD_FILTER_CA].param_count,
                      setup->filter_p);
  ethd_space_tracking(setup, &ethd_tracking_follow);
  ethd_space_contact(setup, &ethd_contact_kelvin_voigt);
  ethd_space_transition(setup, &ethd_transition_approach);
  setup->ability = ethd_ability_unknown();
}

void ethd_space_narrow(ethd_space_setup *s, const ethd_limits *limits) {
  if (limits->size != sizeof *limits) return;
  s->speed = fmin(s->speed, limits->speed);
  s->x_min = fmax(s->x_min, limits->workspace[0]);
  s->x_max = fmin(s->x_max, limits->workspace[1]);
  s->y_min = fmax(s->y_min, limits->workspace[2]);
  s->y_max = fmin(s->y_max, limits->workspace[3]);
  s->energy = fmin(s->energy, limits->energy);
  s->step_time = fmin(s->step_time, limits->step_time);
  s->gap = fmin(s->gap, limits->gap);
  s->finger_age = fmin(s->finger_age, limits->finger_age);
  s->finger_lost = fmin(s->finger_lost, limits->finger_lost);
  s->clean_time = fmax(s->clean_time, limits->clean_time);
  s->stop_time = fmin(s->stop_time, limits->stop_time);
}

/* ---- checks ---- */

static ethd_status check_numbers(const ethd_space_setup *s, ethd_error *error) {
  TRY(ethd_params_check(ethd_space_numbers, ETHD_SPACE_NUMBER_COUNT, &s->period, error));
  TRY(ethd__check_number(error, "finger_radius", s->finger_radius, 1e-4, s->radius));
  TRY(ethd__check_number(error, "finger_radius_max", s->finger_radius_max, 1e-4, s->radius - 1e-5));
  TRY(ethd__check_number(error, "x_max", s->x_max, s->x_min, INFINITE));
  TRY(ethd__check_number(error, "y_max", s->y_max, s->y_min, INFINITE));
  TRY(ethd__check_number(error, "z_max", s->z_max, s->z_min, INFINITE));
  const double able[ETHD_ABILITY] = {s->ability.speed, s->ability.acceleration, s->ability.delay,
                                     s->ability.mass,  s->ability.force,        s->ability.friction};
  static const char *const names[ETHD_ABILITY] = {"ability.speed", "ability.acceleration", "ability.delay",
                                                  "ability.mass",  "ability.force",        "ability.friction"};
  for (int i = 0; i < ETHD_ABILITY; i++)
    if (!isnan(able[i])) TRY(ethd__check_number(error, names[i], able[i], 0, INFINITE));
  return ETHD_OK;
}

static ethd_status check_laws(const ethd_space_setup *s, ethd_error *error) {
  const bool by_velocity = s->kind == ETHD_SPACE_VELOCITY;
  TRY(ethd__laws_check(ETHD__LAWS(s), error));
  if (by_velocity ? !ETHD_TRACKING_HAS(s->tracking, velocity) : !ETHD_TRACKING_HAS(s->tracking, force))
    return ethd__error(error, ETHD_E_ARGUMENT,
                       by_velocity ? "tracking.law (it has no velocity)" : "tracking.law (it has no force)");
  if (s->materials > ETHD_MATERIALS_MAX)
    return ethd__refuse(error, ETHD_E_RANGE, "materials", (ethd__found){s->materials, 0, ETHD_MATERIALS_MAX});
  for (uint32_t i = 0; i < s->materials; i++)
    TRY(ethd__within("material", ethd__law_values_check(&s->contact->law, s->material_p[i], error), error));
  return ETHD_OK;
}

#define DAMPING_MAX 20.0 /* Ns/m, as in the plane */
#define E 2.718281828459045

static double known_or(double value, double assumed) { return value >= 0 ? value : assumed; }

static void prepare_core(const ethd_space_setup *s, ethd__core_plan *out) {
  const double late = known_or(s->ability.delay, ETHD_DELAY_ASSUMED) + s->period;
  const double damping = known_or(s->ability.mass, ETHD_MASS_ASSUMED) / (E * late);
  out->period = s->period;
  out->radius = s->radius;
  out->finger_radius = s->finger_radius;
  out->d_beta = s->radius - s->finger_radius_max;
  out->v_hysteresis = s->v_hysteresis;
  out->swap_time = s->swap_time;
  out->energy = s->energy;
  out->watches_energy = s->energy < INFINITE;
  out->latches = s->latch;
  out->by_velocity = s->kind == ETHD_SPACE_VELOCITY;
  out->brake = out->by_velocity ? 0 : damping;
  out->damping_max = fmin(DAMPING_MAX, damping);
  ethd__laws_plan(ETHD__LAWS(s), out);
}

ethd_status ethd__space_setup_made(const void *setup, ethd_error *error) {
  const ethd_space_setup *s = setup;
  if (!s || s->cookie != COOKIE)
    return ethd__error(error, ETHD_E_ARGUMENT, "setup (made by ethd_space_setup_default?)");
  if (s->bytes == sizeof *s) return ETHD_OK;
  return ethd__refuse(error, ETHD_E_SIZE, "ethd_space_setup", (ethd__found){s->bytes, sizeof *s, sizeof *s});
}

ETHD__FP_APART static ethd_status prepare(const ethd_space_setup *s, ethd__space_plan *out, ethd_error *error) {
  TRY(ethd__space_setup_made(s, error));
  if ((unsigned)s->kind > ETHD_SPACE_VELOCITY) return ethd__error(error, ETHD_E_ARGUMENT, "kind");
  if ((unsigned)s->effector > ETHD_EFFECTOR_PLATE) return ethd__error(error, ETHD_E_ARGUMENT, "effector");
  TRY(check_numbers(s, error));
  TRY(check_laws(s, error));
  TRY(ethd__within("finger_filter", ethd_filter_prepare(s->filter, s->filter_p, s->period, &out->filter, error),
                   error));
  out->setup = *s;
  prepare_core(s, &out->core);
  out->has_box =
      fmax(fmax(s->x_min, s->y_min), s->z_min) > -INFINITE || fmin(fmin(s->x_max, s->y_max), s->z_max) < INFINITE;
  out->has_ball = s->reach < INFINITE;
  out->watches_rim = s->effector == ETHD_EFFECTOR_CAP && s->rim < INFINITE;
  out->watches_finger = fmin(s->finger_age, s->finger_lost) < INFINITE;
  return ETHD_OK;
}

ethd_status ethd__space_prepare(const ethd_space_setup *s, ethd__space_plan *out, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, prepare(s, out, error));
}

ethd_status ethd_space_check(const ethd_space_setup *setup, ethd_error *error) {
  ethd__space_plan plan;
  return ethd__space_prepare(setup, &plan, error);
}
