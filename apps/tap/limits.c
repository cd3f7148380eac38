/* Finds the largest multiple of each gain as in an experiment: raises it until the ring no longer rests. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "tap/paper.h"

#define TRIES 8
#define MOST 8.0      /* the largest multiple that is tried */
#define STEP 1.25     /* between multiples, until one has no rest; it is then narrowed down to STEP^(1/8) */
#define NARROWINGS 3  /* halvings of that step */
#define RESTLESS 0.02 /* m/s: the paper's v_th */
#define WINDOW 0.2    /* s over which the speed counts */
#define AWAY 0.05     /* m before the wall: the finger's rest or starting point */
#define REST 0.6      /* s of a try in free space */
#define COME 0.5      /* s until a pressing finger is at the wall */
#define PRESS 1.2     /* s of its try */
#define FORCE 2.5     /* N: force with which it presses */
#define FIRST_TAP (UINT64_C(1) << 41) /* no other tap has these numbers */

/* The finger's path in a try: at rest, or until its hand presses with FORCE through wall, pad and itself. */
static void lead(const ethd__stage *stage, bool presses, ethd_sim_tap *tap, ethd_path_sample path[2]) {
  const ethd__study *study = stage->study;
  const ethd_plant *p = &study->plant;
  double k_e = ethd_setup_get(&study->config->setup, "contact.k_e");
  double touch = stage->setup.ring_radius - tap->finger_radius;
  double depth = presses ? touch + FORCE * (1 / p->hand_stiffness + 1 / p->pad_stiffness + 1 / k_e) : -AWAY;
  ethd_vec from = ethd_vec_add(study->meet, ethd_vec_scale(-AWAY, study->n));
  ethd_vec to = ethd_vec_add(study->meet, ethd_vec_scale(depth, study->n));
  path[0] = (ethd_path_sample){0, from.x, from.y};
  path[1] = (ethd_path_sample){COME, to.x, to.y};
  tap->path = (ethd_path){.samples = path, .sample_count = 2};
}

/* Returns the rms speed of the measured side along n at the end of a try; INFINITY after a fault. */
static double rms_of(ethd__stage *stage, double seconds) {
  double sum = 0, period = stage->setup.period;
  const int ticks = (int)(seconds / period), window = (int)(WINDOW / period);
  for (int k = 0; k < ticks; k++) {
    ethd_sense sense = {0};
    ethd_command command;
    ethd_trace trace;
    ethd_truth truth;
    ethd_sim_read(stage->sim, &sense);
    if (ethd_control_step(stage->control, &sense, &command, &trace) < 0 || trace.fault) return (double)INFINITY;
    ethd_sim_truth(stage->sim, &truth);
    const double *v = stage->study->plant.metrics_side ? truth.motor_v : truth.ring_v;
    double speed = stage->study->n.x * v[0] + stage->study->n.y * v[1];
    if (k >= ticks - window) sum += speed * speed;
    ethd_sim_write(stage->sim, &command);
  }
  return sqrt(sum / window);
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Gives the median rms over the tries with one gain `times` as large. */
static ethd_status try_gain(const ethd__study *study, const char *key, bool presses, double times, double *out,
                            char *message) {
  ethd__study s = *study;
  ethd__stage stage;
  char text[32];
  double rms[TRIES];
  ethd__gain *gains = malloc((study->gain_count + 1) * sizeof *gains);
  if (!gains) ethd__fail_memory();
  if (study->gain_count) memcpy(gains, study->gains, study->gain_count * sizeof *gains);
  snprintf(text, sizeof text, "%.9g", times * ethd_setup_get(&study->config->setup, key));
  gains[study->gain_count] = (ethd__gain){key, text};
  s.gains = gains;
  s.gain_count = study->gain_count + 1;
  ethd_status status = ethd__stage_open(&s, "offset", &stage, message);
  for (int k = 0; !status && k < TRIES; k++) {
    ethd_path_sample path[2];
    ethd_sim_tap tap;
    ethd_sim_draw(&s.plant, s.seed, FIRST_TAP + (uint64_t)k, s.plant.speed_low, s.meet, &tap);
    lead(&stage, presses, &tap, path);
    ethd_control_reset(stage.control);
    status = ethd_sim_start(stage.sim, &tap);
    if (!status) rms[k] = rms_of(&stage, presses ? PRESS : REST);
  }
  if (!status) qsort(rms, TRIES, sizeof *rms, ascending);
  *out = status ? (double)NAN : (rms[TRIES / 2 - 1] + rms[TRIES / 2]) / 2;
  ethd__stage_close(&stage);
  free(gains);
  return status;
}

/* Gives the first multiple of a gain without rest. */
static ethd_status find_limit(const ethd__study *study, const char *key, bool presses, double *limit, char *message) {
  double rms = 0, high = 1, low = 1;
  *limit = NAN;
  if (isnan(ethd_setup_get(&study->config->setup, key))) return ETHD_OK;
  ethd_status status = try_gain(study, key, presses, 1, &rms, message);
  while (!status && !(rms > RESTLESS) && high < MOST) {
    low = high;
    high = fmin(MOST, high * STEP);
    status = try_gain(study, key, presses, high, &rms, message);
  }
  for (int i = 0; !status && rms > RESTLESS && low < high && i < NARROWINGS; i++) {
    double middle = sqrt(low * high), there;
    status = try_gain(study, key, presses, middle, &there, message);
    if (there > RESTLESS)
      high = middle;
    else
      low = middle;
  }
  *limit = high;
  return status;
}

/* Gives both limits of a pair, the smaller one, the rms's growth up to it, and the rms at the present gains. */
static ethd_status take_pair(const ethd__study *study, const char *const keys[2], bool presses, double limits[2],
                             double least[2], double *hum, char *message) {
  double there, half;
  ethd_status status = find_limit(study, keys[0], presses, &limits[0], message);
  if (!status) status = find_limit(study, keys[1], presses, &limits[1], message);
  const char *key = keys[limits[1] < limits[0]];
  least[0] = fmin(limits[0], limits[1]);
  if (!status) status = try_gain(study, key, presses, least[0], &there, message);
  if (!status) status = try_gain(study, key, presses, least[0] / 2, &half, message);
  if (!status) status = try_gain(study, key, presses, 1, hum, message);
  if (status) return status;
  least[1] = there / half;
  *hum *= 1e3;
  return ETHD_OK;
}

ethd_status ethd__paper_limits(const ethd__study *study, double out[ETHD_PAPER_COUNT], char message[ETHD_MESSAGE_MAX]) {
  static const char *const tracking[] = {"tracking.k_t", "tracking.b_t"}, *const wall[] = {"contact.k_e",
                                                                                           "contact.b_e"};
  ethd_status status = take_pair(study, tracking, false, &out[ETHD_PAPER_limit_k_t], &out[ETHD_PAPER_least_tracking],
                                 &out[ETHD_PAPER_hum_tracking], message);
  if (status) return status;
  return take_pair(study, wall, true, &out[ETHD_PAPER_limit_k_e], &out[ETHD_PAPER_least_wall],
                   &out[ETHD_PAPER_hum_wall], message);
}
