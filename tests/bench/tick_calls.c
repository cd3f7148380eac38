/* Parts of the tick, each called alone. */
#include <math.h>
#include <string.h>

#include "bench/tick.h"

void ethd__tick_part(FILE *csv, const char *law, const char *name, double ns) {
  ethd__tick_put(csv, (ethd__tick_row){"part", law, "1000", "rays"}, name, NAN, ns);
  printf("    %-52s %6.1f\n", name, ns);
}

typedef struct calls {
  ethd_setup setup;
  ethd_pose poses[ETHD__TAP_TICKS];
  ethd_sense senses[ETHD__TAP_TICKS];
} calls;

static void call_pose(void *data) {
  calls *c = data;
  for (int k = 0; k < ETHD__TAP_TICKS; k++) ethd_arm_pose(&c->setup.arm, c->senses[k].q, &c->poses[k]);
}

static void call_tracking(void *data) {
  const calls *c = data;
  double tau[2] = {0, 0}, sum = 0, state[ETHD_STATE_MAX / 8] = {0};
  for (int k = 0; k < ETHD__TAP_TICKS; k++) {
    const double *j = c->poses[k].j_inv;
    ethd_tracking_in in = {{j[0] * 1e-3, j[2] * 1e-3}, {j[1] * 1e-2, j[3] * 1e-2}, {1e-3, 0}, {0, 1e-2}, 1e-3, {0, 0}};
    (void)!c->setup.tracking->step(c->setup.tracking_p, state, &in, tau);
    sum += tau[0];
  }
  ethd__bench_sink = sum;
}

static void call_guard(void *data) {
  const calls *c = data;
  ethd_guard_state state;
  double sum = 0;
  const ethd_guard_device device =
      ethd_guard_device_of(&c->setup.arm, &c->setup.dynamics, c->setup.limits.gap, 1e-3, 0);
  memset(&state, 0, sizeof state);
  for (int k = 0; k < ETHD__TAP_TICKS; k++) {
    double tau[2] = {c->poses[k].j[0], c->poses[k].j[1]};
    const ethd_guard_motion motion = {.pose = &c->poses[k], .v = {0.1, 0.2}, .dt = 1e-3};
    sum += ethd_guard_step(&c->setup.limits, &device, &state, &motion, tau);
    sum += tau[0];
  }
  ethd__bench_sink = sum;
}

/* A ring that goes into a wall and out again, braked on its way. */
static void call_transition(void *data) {
  const calls *c = data;
  const ethd_transition_law *law = c->setup.transition;
  double state[ETHD_STATE_MAX / 8] = {0}, sum = 0;
  for (int k = 0; k < ETHD__TAP_TICKS; k++) {
    double w = 2 * M_PI * k / ETHD__TAP_TICKS, d = 3e-3 * cos(w), v = 0.02 * sin(w);
    ethd_contact contact = {{0.238, 0.25}, {-1, 0}, d, d, d - 2.5e-3, v, v, 2.5e-3, 1e-3, 0, 0, 0, NULL};
    ethd_ruling r = {1, 0, 0, 0, 0, {0, 0}, d, 0, 0};
    (void)!law->step(c->setup.transition_p, state, &contact, &r);
    double force = 0, block[1] = {0};
    (void)!c->setup.contact->step(c->setup.contact_p, block, d + r.offset, v, v > 0, &force);
    sum += force + r.beta;
  }
  ethd__bench_sink = sum;
}

void ethd__tick_calls(FILE *csv, int quick) {
  static calls c;
  c.setup = ethd_setup_default();
  ethd__tap_senses(&c.setup, ETHD__TAP_KNOWN, c.senses);
  ethd__bench_entry entries[] = {
      {"called alone: kinematics", call_pose, &c, ETHD__TAP_TICKS, 0},
      {"called alone: tracking", call_tracking, &c, ETHD__TAP_TICKS, 0},
      {"called alone: guard", call_guard, &c, ETHD__TAP_TICKS, 0},
      {"called alone: transition and contact law; sin; cos", call_transition, &c, ETHD__TAP_TICKS, 0}};
  ethd__bench_race(entries, 4, quick ? 0.05 : 0.5);
  for (int i = 0; i < 4; i++) ethd__tick_part(csv, "offset", entries[i].name, entries[i].ns);
}
