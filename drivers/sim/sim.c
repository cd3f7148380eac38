#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "denormals.h"
#include "ethd/sim.h"
#include "sim/body.h"
#include "sim/plant.h"
#include "sim/sensors.h"
#include "sim/series.h"

/* NaN, infinities and quotients by 0 belong to the model, as of a sensor that sees nothing. Each public function that
   may meet them takes no trap that an application has set. */
#define APART __attribute__((noinline)) static

struct ethd_sim {
  ethd_sim_def def;
  ethd__body body;
  ethd__leg leg; /* holds the present tick, and goes on up to the next torque */
  ethd__sensors sensors;
  ethd_path path;
  ethd__piece piece;
  int64_t tick;
  double t;                                /* s, always tick * period between writes */
  double cell;                             /* s, of the grid of steps; the period is a multiple of it */
  int periods;                             /* whole periods of the delay; its rest ends within the next period */
  double queue[ETHD_SIM_DELAY_PERIODS][2]; /* Nm: torques of the last ticks that wait for their delay */
};

/* ---- create ---- */

APART ethd_status create(const ethd_sim_def *def, ethd_sim **out, ethd_error *error) {
  *out = NULL;
  ethd_status status = ethd__sim_check(def, error);
  if (status) return status;
  ethd_sim *sim = calloc(1, sizeof *sim);
  if (!sim) return ethd__sim_refuse(error, ETHD_E_MEMORY, "sim", NAN, NAN, NAN);
  sim->def = *def;
  ethd__sensors_create(&sim->sensors, def);
  *out = sim;
  return ETHD_OK;
}

ethd_status ethd_sim_create(const ethd_sim_def *def, ethd_sim **out, ethd_error *error) {
  uint64_t before = ethd__traps_hold();
  ethd_status status = create(def, out, error);
  ethd__denormals_restore(before);
  return status;
}

void ethd_sim_destroy(ethd_sim *sim) { free(sim); }

/* ---- start ---- */

static bool samples_rise(const ethd_path *path) {
  if (!path->samples) return false;
  for (size_t i = 0; i < path->sample_count; i++) {
    const ethd_path_sample *s = path->samples + i;
    if (!(isfinite(s->t) && isfinite(s->x) && isfinite(s->y))) return false;
    if (i && !(s[0].t > s[-1].t)) return false;
  }
  return true;
}

/* Returns true unless two samples need an impossibly fast hand. */
static bool samples_are_slow(const ethd_path *path) {
  for (size_t i = 1; i < path->sample_count; i++) {
    const ethd_path_sample *s = path->samples + i;
    double length = hypot(s[0].x - s[-1].x, s[0].y - s[-1].y);
    if (!(length <= ETHD_HAND_SPEED_MAX * (s[0].t - s[-1].t))) return false;
  }
  return true;
}

static bool shape_is_good(const ethd_path *p) {
  return isfinite(p->from.x) && isfinite(p->from.y) && isfinite(p->to_x) &&
         (p->profile == ETHD_PROFILE_CONSTANT || p->profile == ETHD_PROFILE_MINIMUM_JERK) && p->speed > 0 &&
         p->speed <= ETHD_HAND_SPEED_MAX && p->ramp_up >= 0 && isfinite(p->ramp_up) && p->ramp_down >= 0 &&
         isfinite(p->ramp_down);
}

static ethd_status check_tap(const ethd_sim *sim, const ethd_sim_tap *tap) {
  if (!(tap->finger_radius > 0 && tap->finger_radius < sim->def.ring_radius)) return ETHD_E_RANGE;
  if (!(tap->phase >= 0 && isfinite(tap->phase))) return ETHD_E_RANGE;
  if (tap->path.sample_count && !samples_rise(&tap->path)) return ETHD_E_ARGUMENT;
  if (tap->path.sample_count) return samples_are_slow(&tap->path) ? ETHD_OK : ETHD_E_RANGE;
  return shape_is_good(&tap->path) ? ETHD_OK : ETHD_E_RANGE;
}

static double tick_time(const ethd_sim *sim, int64_t tick) { return (double)tick * sim->def.period; }

static ethd__sim_state state_at(const ethd_sim *sim, double t) {
  ethd__sim_state state;
  ethd__leg_at(&sim->body, &sim->piece, &sim->leg, t, &state);
  return state;
}

/* Computes the proximity samples up to t, which is in the present step. */
static void take_due(ethd_sim *sim, double t) {
  while (sim->sensors.next <= t) {
    ethd__sim_state state = state_at(sim, sim->sensors.next);
    ethd__sensors_take(&sim->sensors, &sim->body, &state);
  }
}

APART ethd_status start(ethd_sim *sim, const ethd_sim_tap *tap) {
  ethd_status status = check_tap(sim, tap);
  if (status) return status;
  ethd_vec x, v;
  double q[2];
  ethd_path_at(&tap->path, 0, &x, &v);
  status = ethd_arm_angles(&sim->def.arm, x, -1, q);
  if (status) return status;
  sim->path = tap->path;
  sim->tick = 0;
  sim->t = 0;
  sim->periods = (int)fmax(0, ceil(sim->def.plant.delay / sim->def.period) - 1);
  memset(sim->queue, 0, sizeof sim->queue);
  sim->cell = sim->def.period / fmax(1, ceil(sim->def.period / sim->def.step - 1e-9));
  ethd__sim_state state;
  memset(&state, 0, sizeof state);
  ethd__body_prepare(&sim->def, tap->finger_radius, &sim->body);
  ethd__body_place(&sim->body, q, &state);
  ethd__body_refer(&sim->body, &state);
  ethd__body_ring(&sim->body, &state, &x, &v);
  state.q[ETHD__FINGER] = x.x;
  state.q[ETHD__FINGER + 1] = x.y;
  ethd__path_piece(&sim->path, 0, &sim->piece);
  ethd__leg_begin(&sim->piece, 0, &state, &sim->leg);
  ethd__sensors_start(&sim->sensors, &sim->def, tap);
  take_due(sim, 0);
  return ETHD_OK;
}

ethd_status ethd_sim_start(ethd_sim *sim, const ethd_sim_tap *tap) {
  uint64_t before = ethd__traps_hold();
  ethd_status status = start(sim, tap);
  ethd__denormals_restore(before);
  return status;
}

/* ---- read ---- */

static int64_t tick_ns(const ethd_sim *sim, int64_t tick) {
  return (int64_t)rint((double)tick * (1e9 * sim->def.period));
}

APART void measure(ethd_sim *sim, ethd_sense *out) {
  double x[ETHD__DOF_MAX];
  memset(out, 0, sizeof *out);
  out->time_ns = tick_ns(sim, sim->tick);
  ethd__leg_angles(&sim->body, &sim->leg, sim->t, x);
  ethd__sensors_joints(&sim->sensors, &sim->body, x, out);
  if (sim->tick == 0) {
    out->have |= ETHD_HAVE_START;
    out->finger[0] = x[ETHD__FINGER];
    out->finger[1] = x[ETHD__FINGER + 1];
  }
  ethd__sensors_deliver(&sim->sensors, sim->tick ? tick_ns(sim, sim->tick - 1) : -1, out);
}

void ethd_sim_read(ethd_sim *sim, ethd_sense *out) {
  uint64_t before = ethd__traps_hold();
  measure(sim, out);
  ethd__denormals_restore(before);
}

void ethd_sim_truth(const ethd_sim *sim, ethd_truth *out) {
  ethd_vec x, v, motor, motor_v, hand, hand_v;
  ethd__sim_state now = state_at(sim, sim->t);
  ethd__body_ring(&sim->body, &now, &x, &v);
  ethd__body_motor(&sim->body, &now, &motor, &motor_v);
  ethd_path_at(&sim->path, sim->t, &hand, &hand_v);
  *out = (ethd_truth){.t = sim->t,
                      .ring = {x.x, x.y},
                      .ring_v = {v.x, v.y},
                      .motor = {motor.x, motor.y},
                      .motor_v = {motor_v.x, motor_v.y},
                      .finger = {now.q[ETHD__FINGER], now.q[ETHD__FINGER + 1]},
                      .finger_v = {now.v[ETHD__FINGER], now.v[ETHD__FINGER + 1]},
                      .hand = {hand.x, hand.y}};
  ethd__body_pad(&sim->body, &now, &out->pad, &out->pad_force);
}

/* ---- write ---- */

/* Fills the motors' torque, which is 0 for a safe command or a NaN. */
static void saturate(const ethd_sim *sim, const ethd_command *command, double out[2]) {
  for (int j = 0; j < 2; j++) {
    double torque = command->torque[j], most = sim->body.torque_max[j];
    out[j] = command->safe || isnan(torque) ? 0 : fmin(fmax(torque, -most), most);
  }
}

/* Steps from one change of torque to the next, and ends a step also where the path has a kink. Steps lie on a grid, so
   that a finer grid divides each of them evenly. Ticks and samples are read off the steps. */
static void go_on(ethd_sim *sim, double until, double update) {
  ethd__leg *leg = &sim->leg;
  while (leg->end < until) {
    take_due(sim, leg->end);
    if (leg->end >= sim->piece.end) {
      ethd__path_piece(&sim->path, leg->end, &sim->piece);
      leg->hand = ethd__piece_at(&sim->piece, leg->end);
    }
    double cell = sim->cell, grid = update;
    if (leg->end + cell < update) grid -= cell * floor((update - leg->end) / cell - 1e-9);
    ethd__body_refer(&sim->body, &leg->to);
    ethd__leg_next(&sim->body, &sim->piece, fmin(grid, sim->piece.end), cell, leg);
  }
}

/* Passes a command on to the queue, and fills the torque of the one that is `periods` ticks old. */
static void pass_on(ethd_sim *sim, const ethd_command *command, double out[2]) {
  double *waiting = sim->queue[sim->periods ? sim->tick % sim->periods : 0], now[2];
  saturate(sim, command, now);
  for (int j = 0; j < 2; j++) {
    out[j] = sim->periods ? waiting[j] : now[j];
    waiting[j] = now[j];
  }
}

APART void advance(ethd_sim *sim, const ethd_command *command) {
  double delay = sim->def.plant.delay - sim->periods * sim->def.period, update = sim->t + delay,
         end = tick_time(sim, sim->tick + 1);
  go_on(sim, update, update);
  pass_on(sim, command, sim->body.torque);
  go_on(sim, end, end + delay);
  take_due(sim, end);
  sim->t = end;
  sim->tick++;
}

void ethd_sim_write(ethd_sim *sim, const ethd_command *command) {
  uint64_t before = ethd__traps_hold();
  advance(sim, command);
  ethd__denormals_restore(before);
}
