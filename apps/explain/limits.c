/* By how much each of the paper's gains could be larger, the others held. Wall and brake by their closed forms; tracking by
   the whole controller on the simulated device, since readings of the finger come at another rate than ticks. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bounds/loops.h"
#include "explain/judge.h"

#define AWAY 0.05     /* m from the wall at which the ring tracks a finger at rest */
#define STEP 0.2e-3   /* m: the finger moves by so much, */
#define STEP_END 0.02 /* s: within that time, */
#define WINDOW 200    /* ticks over each of which the ring's speed is compared: the second and the fourth */
#define QUIET 1e-12   /* m/s: nothing moves any more */
#define MOST 8.0      /* times: no gain is looked for further up */

/* The plant as a linear device: no friction, no counts, no noise, no saturation, no touch. */
static ethd_plant linear(const ethd_plant *plant) {
  ethd_plant p = *plant;
  p.friction = p.viscous = p.count = p.noise = 0;
  p.force_limit = 1e6;
  return p;
}

/* How much the ring's speed grows between two windows, as a logarithm; a fault is without end. */
static double growth_of(ethd__stage *stage) {
  double sum[4] = {0};
  ethd_sense sense;
  ethd_command command;
  ethd_trace trace;
  ethd_truth truth;
  for (int k = 0; k < 4 * WINDOW; k++) {
    sense = (ethd_sense){0};
    ethd_sim_read(stage->sim, &sense);
    if (ethd_control_step(stage->control, &sense, &command, &trace) < 0 || trace.fault) return (double)INFINITY;
    ethd_sim_truth(stage->sim, &truth);
    sum[k / WINDOW] += truth.motor_v[0] * truth.motor_v[0];
    ethd_sim_write(stage->sim, &command);
  }
  if (!(sum[3] > QUIET * QUIET * WINDOW)) return -1;
  return log(sum[3] / sum[1]);
}

/* Whether tracking settles with one of its gains `times` as large. */
static ethd_status settles(const ethd__study *study, const char *key, double times, bool *out, char *message) {
  ethd__study s = *study;
  ethd__stage stage;
  ethd__gain gains[ETHD_EXPLAIN_SETTINGS + 1];
  char text[32];
  double at = study->meet.x + AWAY;
  const ethd_path_sample path[] = {{0, at, study->meet.y}, {STEP_END, at - STEP, study->meet.y}};
  const ethd_sim_tap tap = {.finger_radius = 1e-3, .path = {.samples = path, .sample_count = 2}};
  snprintf(text, sizeof text, "%.9g", times * ethd_setup_get(&study->config->setup, key));
  memcpy(gains, study->gains, study->gain_count * sizeof *gains);
  gains[study->gain_count] = (ethd__gain){key, text};
  s.plant = linear(&study->plant);
  s.gains = gains;
  s.gain_count = study->gain_count + 1;
  ethd_status status = ethd__stage_open(&s, "offset", &stage, message);
  if (status) return status;
  ethd_control_reset(stage.control);
  status = ethd_sim_start(stage.sim, &tap);
  if (!status) *out = growth_of(&stage) < 0;
  ethd__stage_close(&stage);
  return status;
}

/* Up from the paper's gain to the first unstable one, or down to the first stable one. */
static ethd_status find_limit(const ethd__study *study, const char *key, double *limit, char *message) {
  bool own, good;
  double step = 1.25, low = 1, high = 1;
  ethd_status status = settles(study, key, 1, &own, message);
  for (good = own; !status && good == own && high < MOST && low > 1 / MOST;) {
    low = own ? high : low / step;
    high = own ? high * step : low * step;
    status = settles(study, key, own ? high : low, &good, message);
  }
  for (int i = 0; !status && good != own && i < 4; i++) {
    double middle = sqrt(low * high);
    status = settles(study, key, middle, &good, message);
    if (good)
      low = middle;
    else
      high = middle;
    good = !own;
  }
  *limit = own ? high : low;
  return status;
}

static double most_of(const ethd_setup *setup, const ethd_plant *plant, ethd__bounds_kind kind, bool stiffness) {
  const ethd__bounds_device device = ethd__bounds_device_of(plant, 0);
  ethd__sampled_loop loop;
  if (!ethd__bounds_of(setup, &device, kind, 0, &loop)) return NAN;
  return stiffness ? ethd__sampled_stiffness_max(&loop) / loop.stiffness
                   : ethd__sampled_damping_max(&loop) / loop.damping;
}

ethd_status ethd__explain_limits(const ethd__study *study, ethd__explain_figures *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__stage stage;
  ethd_status status = ethd__stage_open(study, "offset", &stage, message);
  if (status) return status;
  ethd__explain_set(out, ETHD_EXPLAIN_limit_k_e, most_of(&stage.setup, &study->plant, ETHD_LOOP_WALL, true));
  ethd__explain_set(out, ETHD_EXPLAIN_limit_b_e, most_of(&stage.setup, &study->plant, ETHD_LOOP_WALL, false));
  ethd__explain_set(out, ETHD_EXPLAIN_limit_b_d, most_of(&stage.setup, &study->plant, ETHD_LOOP_BRAKING, false));
  ethd__stage_close(&stage);
  double k_t, b_t;
  status = find_limit(study, "tracking.k_t", &k_t, message);
  if (!status) status = find_limit(study, "tracking.b_t", &b_t, message);
  if (status) return status;
  ethd__explain_set(out, ETHD_EXPLAIN_limit_k_t, k_t);
  ethd__explain_set(out, ETHD_EXPLAIN_limit_b_t, b_t);
  return ETHD_OK;
}
