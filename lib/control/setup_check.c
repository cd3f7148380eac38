#include <math.h>
#include <stddef.h>
#include <string.h>

#include "control/plan.h"
#include "control/setup.h"
#include "core/laws_check.h"
#include "error.h"
#include "fp_mode.h"
#include "scene/scene.h"

#define TRY(expression)                 \
  do {                                  \
    ethd_status status_ = (expression); \
    if (status_ < 0) return status_;    \
  } while (0)

/* Returns the most that a number may be: the finger must fit into the ring. */
static double most_of(const ethd_setup *s, const ethd__setup_field *field) {
  if (field->offset == offsetof(ethd_setup, finger_radius)) return s->ring_radius;
  if (field->offset == offsetof(ethd_setup, finger_radius_max)) return s->ring_radius - ETHD__D_BETA_MIN;
  return field->key.param.max;
}

static ethd_status check_field(const ethd_setup *s, const ethd__setup_field *field, ethd_error *error) {
  const ethd_setup_key *key = &field->key;
  for (uint32_t i = 0; i < key->count; i++) {
    double value = ethd__setup_field_get(s, field, i);
    if (isnan(key->param.def) && isnan(value)) continue; /* not known */
    TRY(ethd__check_number(error, key->param.name, value, key->param.min, most_of(s, field)));
  }
  return ETHD_OK;
}

static ethd_status check_fields(const ethd_setup *s, ethd_error *error) {
  TRY(ethd__within("arm", ethd_arm_check(&s->arm, error), error));
  for (const ethd__setup_field *f = ethd__setup_fields; f < ethd__setup_fields + ETHD__SETUP_FIELDS; f++)
    TRY(ethd__within(f->key.section, check_field(s, f, error), error));
  return ETHD_OK;
}

/* Makes the contact law's parameters for one material: the setup's, replaced by those that the material gives. */
static ethd_status prepare_material(const ethd_setup *s, const ethd_material *m, double *p, ethd_error *error) {
  const ethd_law *law = &s->contact->law;
  memcpy(p, s->contact_p, sizeof s->contact_p);
  for (uint32_t i = 0; i < m->count; i++) {
    int k = ethd_params_find(law->params, law->param_count, m->values[i].name);
    if (k < 0) return ethd__error(error, ETHD_E_UNKNOWN, m->values[i].name);
    p[k] = m->values[i].value;
  }
  return ethd__law_values_check(law, p, error);
}

static ethd_status prepare_materials(const ethd_setup *s, int place, ethd__plan *out, ethd_error *error) {
  const ethd_scene *scene = ethd__place_scene(s, place);
  const ethd_material *m;
  for (size_t i = 0; scene && (m = ethd_scene_material(scene, i)) != NULL; i++) {
    ethd_status status = prepare_material(s, m, out->material_p[place][i], error);
    if (status >= 0) continue;
    ethd__error_prefix(error, m->name);
    ethd__error_prefix(error, "material");
    if (error) error->line = m->line;
    return status;
  }
  return ETHD_OK;
}

static void prepare_lags(const ethd_setup *s, ethd__plan *out) {
  out->lag_least = out->lag_most = 0;
  for (int k = 0; k < ETHD_RAYS; k++) {
    out->lag_least = fmin(out->lag_least, s->ray_lag[k]);
    out->lag_most = fmax(out->lag_most, s->ray_lag[k]);
  }
}

/* Refuses a pruned scene that may lack objects within this arm's reach, and any pruned body, since bodies move. */
static ethd_status check_scene(const ethd_setup *s, int place, ethd_error *error) {
  const ethd_scene *scene = ethd__place_scene(s, place);
  double inner = 0, outer = (double)INFINITY;
  if (!scene) return ETHD_OK;
  if (place == 0) ethd__scene_annulus(&s->arm, ethd_setup_range(s), &inner, &outer);
  if (scene->inner <= fmax(inner, 0) && scene->outer >= outer) return ETHD_OK;
  return ethd__refuse(error, ETHD_E_RANGE, "scene was pruned for another arm or ring; reach",
                      (ethd__found){outer, scene->inner, scene->outer});
}

static void prepare_ahead(const ethd_setup *s, ethd__plan *out) {
  const double links[2] = {s->arm.link1, s->arm.link2};
  for (int i = 0; i < 2; i++) out->mobility[i] = 1 / (s->dynamics.mass[i] * links[i] * links[i]);
}

#define DAMPING_MAX 20.0 /* Ns/m: about half of the paper's wall damping */

/* Prepares the guard's model of the device. */
static void prepare_guard(const ethd_setup *s, ethd__plan *out) {
  out->lag = ethd_velocity_lag(&out->velocity);
  out->device = ethd_guard_device_of(&s->arm, &s->dynamics, s->limits.gap, s->period, out->lag);
  const bool known = !isnan(s->dynamics.mass[0]) && !isnan(s->dynamics.mass[1]);
  out->brake_time = known ? ethd_guard_brake_time(&out->device, &s->limits) : 0;
  out->core.brake = ethd_guard_damping(&out->device, out->device.mass, true);
  out->core.damping_max = fmin(DAMPING_MAX, out->core.brake);
}

/* Returns true for a limit that the guard checks in every tick, or that has its own flag `watches_...`. */
static bool is_common(const ethd_limit *row) {
  static const size_t common[] = {
      offsetof(ethd_limits, torque),     offsetof(ethd_limits, torque_rate), offsetof(ethd_limits, speed),
      offsetof(ethd_limits, workspace),  offsetof(ethd_limits, margin),      offsetof(ethd_limits, step_time),
      offsetof(ethd_limits, clean_time), offsetof(ethd_limits, heat_time),   offsetof(ethd_limits, energy),
      offsetof(ethd_limits, finger_age), offsetof(ethd_limits, finger_lost), offsetof(ethd_limits, stop_time)};
  for (size_t i = 0; i < sizeof common / sizeof *common; i++)
    if (common[i] == row->offset) return true;
  return false;
}

/* Returns true if any other limit is set. The tick then runs note_rare_limits and its check of the reach. A new limit
   counts as rare, so that it can't be forgotten here. */
static bool has_rare_limits(const ethd_limits *limits) {
  ethd_limits own = *limits, none = ethd_limits_none();
  for (const ethd_limit *row = ethd_limit_rows; row < ethd_limit_rows + ETHD_LIMITS; row++)
    for (uint32_t i = 0; i < row->count && !is_common(row); i++)
      if (ethd_limit_of(&own, row)[i] != ethd_limit_of(&none, row)[i]) return true;
  return false;
}

/* A law that has only velocities can't move an arm commanded by torques. */
static ethd_status check_tracking(const ethd_setup *s, ethd_error *error) {
  if (s->tracking->step || ETHD_TRACKING_HAS(s->tracking, force)) return ETHD_OK;
  return ethd__error(error, ETHD_E_ARGUMENT, "tracking.law (it has velocities only)");
}

static void prepare_core(const ethd_setup *s, ethd__core_plan *out) {
  out->period = s->period;
  out->radius = s->ring_radius;
  out->finger_radius = s->finger_radius;
  out->d_beta = s->ring_radius - s->finger_radius_max;
  out->v_hysteresis = s->v_hysteresis;
  out->swap_time = s->swap_time;
  out->energy = s->limits.energy;
  out->watches_energy = s->limits.energy < (double)INFINITY;
  out->latches = s->limits.latch;
  out->by_velocity = false;
  ethd__laws_plan(ETHD__LAWS(s), out);
}

ETHD__FP_APART static ethd_status prepare(const ethd_setup *s, ethd__plan *out, ethd_error *error) {
  TRY(ethd__setup_made(s, error));
  TRY(check_fields(s, error));
  TRY(ethd__laws_check(ETHD__LAWS(s), error));
  TRY(check_tracking(s, error));
  TRY(ethd__within("limits", ethd_limits_check(&s->limits, error), error));
  out->setup = *s;
  prepare_core(s, &out->core);
  out->has_rare_limits = has_rare_limits(&s->limits);
  out->watches_finger = fmin(s->limits.finger_age, s->limits.finger_lost) < (double)INFINITY;
  out->period_ns = (int64_t)(1e9 * s->period + 0.5);
  TRY(ethd__within("velocity", ethd_velocity_prepare(s->velocity, s->velocity_p, s->period, &out->velocity, error),
                   error));
  TRY(ethd__within("finger_fit", ethd_fit_prepare(s->fit, s->fit_p, s->ring_radius, s->finger_radius, &out->fit, error),
                   error));
  TRY(ethd__within("finger_filter", ethd_filter_prepare(s->filter, s->filter_p, s->period, &out->filter, error),
                   error));
  prepare_ahead(s, out);
  prepare_guard(s, out);
  prepare_lags(s, out);
  out->places = 0;
  for (int place = 0; place < ETHD__PLACES; place++) {
    if (ethd__place_scene(s, place)) out->places = place + 1;
    TRY(check_scene(s, place, error));
    TRY(prepare_materials(s, place, out, error));
  }
  return ETHD_OK;
}

ethd_status ethd__plan_prepare(const ethd_setup *s, ethd__plan *out, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, prepare(s, out, error));
}

ethd_status ethd_setup_check(const ethd_setup *setup, ethd_error *error) {
  ethd__plan plan;
  return ethd__plan_prepare(setup, &plan, error);
}
