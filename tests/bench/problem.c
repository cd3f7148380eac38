#include "bench/problem.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "tap/study.h"

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

static void *room(size_t count, size_t each) {
  void *p = calloc(count, each);
  if (!p) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  return p;
}

/* ---- recording ---- */

static void begin(const ethd__stage *stage, const ethd_sim_tap *tap, ethd__played *out) {
  const ethd_plant *plant = &stage->study->plant;
  const ethd_sim_def def = {.plant = *plant, .arm = stage->setup.arm, .ring_radius = stage->setup.ring_radius};
  ethd_vec x, v;
  double q[2];
  ethd_path_at(&tap->path, 0, &x, &v);
  if (ethd_arm_angles(&def.arm, x, -1, q) < 0) ethd__fail(ETHD_EXIT_FAILED, "a tap begins out of reach");
  ethd__body_prepare(&def, tap->finger_radius, &out->body);
  ethd__body_place(&out->body, q, &out->start);
  ethd__body_refer(&out->body, &out->start);
  ethd__body_ring(&out->body, &out->start, &x, &v);
  out->start.q[ETHD__FINGER] = x.x;
  out->start.q[ETHD__FINGER + 1] = x.y;
}

/* Adds stretches up to `end`, cut at kinks. */
static void add(ethd__played *p, const ethd_path *path, double *t, double end, int tick, const double torque[2]) {
  while (*t < end) {
    ethd__stretch *s = &p->stretches[p->count++];
    *s = (ethd__stretch){.begin = *t, .torque = {torque[0], torque[1]}, .tick = tick};
    ethd__path_piece(path, *t, &s->piece);
    *t = s->end = fmin(end, s->piece.end);
    tick = 0;
  }
}

static void record(ethd__stage *stage, const ethd__speed *speed, uint64_t number, ethd__played *out) {
  char message[ETHD_MESSAGE_MAX];
  ethd__result result;
  ethd_sim_tap tap;
  double period = stage->setup.period, t = 0, held[2] = {0, 0};
  check(ethd__stage_run(stage, speed, number, &result, message), message);
  check(ethd__stage_draw(stage, speed, number, &tap), "a tap can't be drawn");
  begin(stage, &tap, out);
  out->stretches = room(2 * stage->rows.count + 8, sizeof *out->stretches);
  for (size_t k = 0; k < stage->rows.count; k++) {
    double tick = (double)k * period;
    add(out, &tap.path, &t, tick + stage->study->plant.delay, 1, held);
    for (int j = 0; j < 2; j++) {
      double most = out->body.torque_max[j];
      held[j] = fmin(fmax(stage->rows.trace[k].tau[j], -most), most);
    }
    add(out, &tap.path, &t, (double)(k + 1) * period, 0, held);
  }
}

ethd__problem ethd__problem_record(int taps) {
  char message[ETHD_MESSAGE_MAX], *plant = ethd__data_path("n.plant"), *controller = ethd__data_path("n.ini");
  ethd_config *config;
  ethd__study study = {.seed = 1, .speed_count = 2};
  ethd__speed speeds[2];
  ethd__stage stage;
  check(ethd_config_load(controller, &config, message), message);
  check(ethd_plant_load(plant, &study.plant, message), message);
  ethd__speed_parse("low", &study.plant, &speeds[0]);
  ethd__speed_parse("high", &study.plant, &speeds[1]);
  study.config = config;
  study.speeds = speeds;
  check(ethd__study_prepare(&study, message), message);
  check(ethd__stage_open(&study, "offset", &stage, message), message);
  ethd__problem p = {.taps = room((size_t)taps, sizeof *p.taps), .tap_count = taps};
  for (int i = 0; i < taps; i++) {
    ethd__played *tap = &p.taps[i];
    record(&stage, &speeds[i & 1], (uint64_t)(i / 2), tap);
    p.mark_count += tap->count;
    p.duration += tap->stretches[tap->count - 1].end;
  }
  ethd__stage_close(&stage);
  ethd_config_free(config);
  free(plant);
  free(controller);
  return p;
}

void ethd__problem_free(ethd__problem *p) {
  for (int i = 0; i < p->tap_count; i++) free(p->taps[i].stretches);
  free(p->taps);
}

/* ---- playing ---- */

void ethd__problem_play(const ethd__problem *p, ethd__play *stretch, void *user, ethd__mark *out) {
  for (int i = 0; i < p->tap_count; i++) {
    const ethd__played *tap = &p->taps[i];
    ethd__body body = tap->body;
    ethd__sim_state state = tap->start;
    for (int k = 0; k < tap->count; k++) {
      const ethd__stretch *s = &tap->stretches[k];
      memcpy(body.torque, s->torque, sizeof body.torque);
      if (s->tick) ethd__body_refer(&body, &state);
      stretch(user, &body, s, &state);
      memcpy(*out++, state.q, sizeof *out);
    }
  }
}

static double distance(const double *x, const double *y) { return hypot(x[0] - y[0], x[1] - y[1]); }

static void ring(const ethd__body *b, const double *q, double out[2]) {
  out[0] = b->link[0] * cos(q[0]) + b->link[1] * cos(q[1]);
  out[1] = b->link[0] * sin(q[0]) + b->link[1] * sin(q[1]);
}

double ethd__problem_error(const ethd__problem *p, ethd__mark *marks, ethd__mark *reference) {
  double worst = 0;
  for (int i = 0; i < p->tap_count; i++)
    for (int k = 0; k < p->taps[i].count; k++, marks++, reference++) {
      double a[2], b[2];
      ring(&p->taps[i].body, *marks, a);
      ring(&p->taps[i].body, *reference, b);
      double e = fmax(distance(a, b), distance(*marks + 2, *reference + 2));
      worst = e <= worst ? worst : e; /* takes NaN too */
    }
  return worst;
}
