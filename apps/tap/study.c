#include "tap/study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

bool ethd__speed_parse(const char *word, const ethd_plant *plant, ethd__speed *out) {
  double v;
  *out = (ethd__speed){0};
  if (strlen(word) >= sizeof out->word) return false;
  strcpy(out->word, word);
  if (!strcmp(word, "low") || !strcmp(word, "high")) {
    bool low = word[0] == 'l';
    out->commanded = low ? plant->speed_low : plant->speed_high;
    out->centre = low ? 0.2 : 0.4;
    out->band = low ? plant->band_low : plant->band_high;
    return true;
  }
  if (!ethd__number(word, strlen(word), &v) || !(v >= 0.01 && v <= 2)) return false;
  out->commanded = out->centre = v;
  out->band = 0.04 + 0.1 * v;
  return true;
}

/* ---- where the wall is ---- */

#define AWAY 1e-6 /* m: the least step away from a wall */

/* Sphere tracing: a step as long as the clearance never passes through an object. First it moves away from a wall
   behind x, such as a room's right wall at the beginning of the reach. */
int ethd__way_to_wall(const ethd_scene *scene, double radius, ethd_vec direction, double outer, ethd_vec *x,
                      ethd_nearest *near) {
  for (int step = 0; step < 10000 && ethd_vec_norm(*x) <= outer; step++) {
    ethd_scene_query(scene, *x, near);
    double clearance = near->distance - radius;
    bool behind = ethd_vec_dot(near->n, direction) < 0;
    if (clearance < 1e-12 && !behind) return step;
    *x = ethd_vec_add(*x, ethd_vec_scale(behind ? fmax(fabs(clearance), AWAY) : clearance, direction));
  }
  return -1;
}

static ethd_status find_wall(ethd__study *study, char *message) {
  const ethd_setup *setup = &study->config->setup;
  double inner, outer;
  ethd_arm_reach(&setup->arm, &inner, &outer);
  ethd_vec x = {sqrt(fmax(0, outer * outer - ETHD_TAP_HEIGHT * ETHD_TAP_HEIGHT)), ETHD_TAP_HEIGHT};
  ethd_nearest near;
  int steps = ethd__way_to_wall(study->config->scene, setup->ring_radius, (ethd_vec){-1, 0}, outer, &x, &near);
  study->meet = x;
  study->n = near.n;
  if (steps > 0) return ETHD_OK;
  return ethd__say(message, ETHD_E_GEOMETRY, "the scene %s to the left at y = %g m",
                   steps ? "has no wall on the ring's path" : "leaves no room for a movement", ETHD_TAP_HEIGHT);
}

/* The point at which a finger of this radius touches the ring's wall. */
static ethd_vec finger_at_wall(const ethd__study *study, double radius) {
  double back = study->config->setup.ring_radius - radius;
  return ethd_vec_add(study->meet, ethd_vec_scale(back, study->n));
}

ethd_status ethd__study_prepare(ethd__study *study, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = find_wall(study, message);
  if (status || !study->movement.count) return status;
  for (size_t i = 0; i < study->speed_count; i++)
    ethd__movement_touchdown(&study->movement, study->speeds[i].centre, &study->speeds[i].touchdown);
  return ETHD_OK;
}

/* ---- the stage ---- */

static ethd_limits device_limits(const ethd__study *study) {
  const ethd_arm *arm = &study->config->setup.arm;
  ethd_limits limits = ethd_limits_none();
  limits.torque = study->plant.force_limit * fmax(arm->link1, arm->link2);
  return limits;
}

static ethd_status set_gains(const ethd__study *study, ethd_setup *setup, char *message) {
  for (size_t i = 0; i < study->gain_count; i++) {
    const ethd__gain *gain = &study->gains[i];
    ethd_status status = ethd_config_set(study->config, gain->key, gain->value, setup, message);
    if (status && status != ETHD_E_UNKNOWN) return status;
  }
  return ETHD_OK;
}

bool ethd__gain_applies(const ethd__study *study, const char *law, const ethd__gain *gain) {
  char unsaid[ETHD_MESSAGE_MAX];
  ethd_setup setup = study->config->setup;
  return !ethd_config_transition(study->config, law, &setup, unsaid) &&
         !ethd_config_set(study->config, gain->key, gain->value, &setup, unsaid);
}

static ethd_status create(ethd__stage *stage, ethd_error *error) {
  const ethd__study *study = stage->study;
  const ethd_sim_def def = {.plant = study->plant,
                            .arm = stage->setup.arm,
                            .ring_radius = stage->setup.ring_radius,
                            .period = stage->setup.period,
                            .step = stage->setup.period,
                            .tolerance = ETHD_SIM_GOLDEN};
  stage->samples = malloc((study->movement.count + 1) * sizeof *stage->samples);
  if (!stage->samples) return ETHD_E_MEMORY;
  ethd_status status = ethd_sim_create(&def, &stage->sim, error);
  return status ? status : ethd_control_create(&stage->setup, &stage->control, error);
}

ethd_status ethd__stage_open(const ethd__study *study, const char *law, ethd__stage *out,
                             char message[ETHD_MESSAGE_MAX]) {
  const ethd_config *config = study->config;
  ethd_error error = {.status = ETHD_E_MEMORY, .found = NAN, .min = NAN, .max = NAN};
  const ethd_limits device = device_limits(study);
  *out = (ethd__stage){.study = study, .law = law, .setup = config->setup};
  const ethd_dynamics dynamics = ethd_plant_dynamics(&study->plant);
  out->setup.dynamics = ethd_dynamics_known(&dynamics, &out->setup.dynamics);
  ethd_status status = ethd_config_transition(config, law, &out->setup, message);
  if (!status) status = set_gains(study, &out->setup, message);
  if (status) return status;
  out->setup.limits = ethd_limits_narrower(&device, &out->setup.limits);
  status = create(out, &error);
  if (!status) return ETHD_OK;
  ethd_error_text(config->path ? config->path : "defaults", &error, message);
  ethd__stage_close(out);
  return status;
}

void ethd__stage_close(ethd__stage *stage) {
  ethd_control_destroy(stage->control);
  ethd_sim_destroy(stage->sim);
  ethd__tap_rows_free(&stage->rows);
  free(stage->samples);
  *stage = (ethd__stage){0};
}

/* ---- a tap ---- */

ethd_status ethd__stage_draw(ethd__stage *stage, const ethd__speed *speed, uint64_t tap, ethd_sim_tap *out) {
  const ethd__study *study = stage->study;
  ethd_sim_draw(&study->plant, study->seed, tap, speed->commanded, study->meet, out);
  if (!study->movement.count) return ETHD_OK;
  /* The rule judges the speed there: of the ring as it meets the wall, or of the finger as it touches it. */
  ethd_vec centre = study->validity == ETHD_TAP_BY_PAPER ? study->meet : finger_at_wall(study, out->finger_radius);
  size_t count = ethd__movement_place(&study->movement, &speed->touchdown, centre, &stage->setup.arm, stage->samples);
  out->path = (ethd_path){.samples = stage->samples, .sample_count = count};
  out->commanded = speed->centre;
  return count ? ETHD_OK : ETHD_E_UNREACHABLE;
}

ethd__rule ethd__stage_rule(const ethd__stage *stage, const ethd__speed *speed, double finger_radius) {
  const ethd__study *study = stage->study;
  double meet = ethd_vec_dot(study->n, study->meet);
  return (ethd__rule){.n = study->n,
                      .period = stage->setup.period,
                      .side = study->plant.metrics_side,
                      .speed = speed->centre,
                      .band = speed->band,
                      .meet = meet,
                      .seen = meet + stage->setup.ring_radius - finger_radius,
                      .d_beta = stage->setup.ring_radius - stage->setup.finger_radius_max,
                      .never_fast = speed->touchdown.never_fast,
                      .validity = study->validity,
                      .graze = study->graze,
                      .single = study->single,
                      .lift = study->lift};
}

ethd__view ethd__stage_view(const ethd__stage *stage, const ethd__speed *speed, double finger_radius) {
  ethd__view view = {.rule = ethd__stage_rule(stage, speed, finger_radius),
                     .ring_radius = stage->setup.ring_radius,
                     .finger_radius = finger_radius};
  view.wall = view.rule.meet + view.ring_radius;
  return view;
}

static void count_ticks(const ethd__tap_rows *rows, ethd__result *out) {
  out->ticks = (uint32_t)rows->count;
  out->queried = 0;
  for (size_t i = 0; i < rows->count; i++) out->queried += rows->trace[i].queried != 0;
}

void ethd__stage_judge(const ethd__stage *stage, const ethd__rule *rule, const ethd_sim_tap *tap, ethd__result *out) {
  ethd__rule by_finger = *rule;
  by_finger.validity = ETHD_TAP_BY_FINGER;
  ethd__metrics_of(&stage->rows, rule, &out->metrics);
  ethd__metrics_of(&stage->rows, &by_finger, &out->finger);
  out->commanded = tap->commanded;
  out->finger_radius = tap->finger_radius;
  count_ticks(&stage->rows, out);
}

/* Their numbers differ from those of counted taps. */
#define LEARNING (UINT64_C(1) << 40)

static ethd_status run_tap(ethd__stage *stage, const ethd_sim_tap *tap, const ethd__rule *rule) {
  const ethd_config *config = stage->study->config;
  (void)ethd__law_fault_take(stage->control, &stage->setup); /* of earlier taps */
  ethd__config_foreign(config, "a plugin's law");
  ethd_status status = ethd__tap_run(stage->sim, stage->control, tap, stage->learned, rule, &stage->rows);
  ethd__config_foreign(config, NULL);
  return status;
}

/* Resets the law's memory, then runs `study->learn` taps of the same kind, from which it learns. */
static ethd_status learn(ethd__stage *stage, const ethd__speed *speed, uint64_t tap) {
  ethd_sim_tap circumstances;
  ethd_status status = ETHD_OK;
  memset(stage->learned, 0, sizeof stage->learned);
  for (uint64_t k = 0; !status && k < stage->study->learn; k++) {
    status = ethd__stage_draw(stage, speed, LEARNING + tap * stage->study->learn + k, &circumstances);
    const ethd__rule rule = ethd__stage_rule(stage, speed, circumstances.finger_radius);
    if (!status) status = run_tap(stage, &circumstances, &rule);
    ethd_control_memory(stage->control, stage->learned);
  }
  return status;
}

ethd_status ethd__stage_run(ethd__stage *stage, const ethd__speed *speed, uint64_t tap, ethd__result *out,
                            char message[ETHD_MESSAGE_MAX]) {
  ethd_sim_tap circumstances = {0};
  ethd_status status = learn(stage, speed, tap);
  if (!status) status = ethd__stage_draw(stage, speed, tap, &circumstances);
  const ethd__rule rule = ethd__stage_rule(stage, speed, circumstances.finger_radius);
  if (!status) status = run_tap(stage, &circumstances, &rule);
  if (status)
    return ethd__say(message, status, "tap %llu at %s: %s", (unsigned long long)tap, speed->word,
                     ethd_status_sentence(status));
  ethd__stage_judge(stage, &rule, &circumstances, out);
  out->law_fault = ethd__law_fault_take(stage->control, &stage->setup);
  return ETHD_OK;
}
