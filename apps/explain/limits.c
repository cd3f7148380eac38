/* How much larger each of the paper's gains could be while the others stay. Wall and brake are judged by their closed
   forms, tracking by the whole controller on the simulated device, since readings of the finger come at another rate
   than ticks. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bounds/loops.h"
#include "explain/judge.h"

#define AWAY 0.05     /* m from the wall at which the ring tracks a finger at rest */
#define STEP 0.2e-3   /* m by which the finger then moves, */
#define STEP_END 0.02 /* s in which it does */
#define WINDOW 200    /* ticks of a window; the ring's speed in the fourth window is compared with that in the second */
#define QUIET 1e-12   /* m/s: below this nothing moves any more */
#define MOST 8.0      /* the largest multiple of a gain that is tried */

/* Returns the plant as a linear device: without friction, counts, noise, saturation or touch. */
static ethd_plant linear(const ethd_plant *plant) {
  ethd_plant p = *plant;
  p.friction = p.viscous = p.count = p.noise = 0;
  p.force_limit = 1e6;
  return p;
}

/* Returns the logarithm of the ring's speed in the later window over that in the earlier one; INFINITY after a
   fault. */
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

/* Finds whether tracking settles with one of its gains `times` as large. */
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

/* Searches up from the paper's gain for the first unstable one, or down for the first stable one. */
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
