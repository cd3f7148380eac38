#include <stdlib.h>
#include <string.h>

#include "ethd/sim.h"
#include "sim/body.h"
#include "sim/plant.h"
#include "sim/sensors.h"

struct ethd_sim {
  ethd_sim_def def;
  ethd__body body;
  ethd__state state;
  ethd__sensors sensors;
  ethd_path path;
  ethd__piece piece;
  int64_t tick;
  double t; /* s, always tick * period between writes */
};

/* ---- create ---- */

ethd_status ethd_sim_create(const ethd_sim_def *def, ethd_sim **out, ethd_error *error) {
  *out = NULL;
  ethd_status status = ethd__sim_check(def, error);
  if (status) return status;
  ethd_sim *sim = calloc(1, sizeof *sim);
  if (!sim) return ethd__sim_refuse(error, ETHD_E_MEMORY, "sim", NAN, NAN, NAN);
  sim->def = *def;
  *out = sim;
  return ETHD_OK;
}

void ethd_sim_destroy(ethd_sim *sim) { free(sim); }

/* ---- start ---- */

static int samples_rise(const ethd_path *path) {
  for (size_t i = 0; i < path->sample_count; i++) {
    const ethd_path_sample *s = path->samples + i;
    if (!(isfinite(s->t) && isfinite(s->x) && isfinite(s->y))) return 0;
    if (i && !(s[0].t > s[-1].t)) return 0;
  }
  return 1;
}

static int shape_is_good(const ethd_path *p) {
  return isfinite(p->from.x) && isfinite(p->from.y) && isfinite(p->to_x) && p->speed > 0 &&
         isfinite(p->speed) && p->ramp_up >= 0 && isfinite(p->ramp_up) && p->ramp_down >= 0 &&
         isfinite(p->ramp_down);
}

static ethd_status check_tap(const ethd_sim *sim, const ethd_sim_tap *tap) {
  if (!(tap->finger_radius > 0 && tap->finger_radius < sim->def.ring_radius)) return ETHD_E_RANGE;
  if (!(tap->phase >= 0 && isfinite(tap->phase))) return ETHD_E_RANGE;
  if (tap->path.sample_count) return samples_rise(&tap->path) ? ETHD_OK : ETHD_E_ARGUMENT;
  return shape_is_good(&tap->path) ? ETHD_OK : ETHD_E_RANGE;
}

static double tick_time(const ethd_sim *sim, int64_t tick) { return (double)tick * sim->def.period; }

static void take_due(ethd_sim *sim) {
  while (ethd__sensors_next(&sim->sensors) <= sim->t)
    ethd__sensors_take(&sim->sensors, &sim->body, &sim->state);
}

ethd_status ethd_sim_start(ethd_sim *sim, const ethd_sim_tap *tap) {
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
  memset(&sim->state, 0, sizeof sim->state);
  ethd__body_prepare(&sim->def, tap->finger_radius, &sim->body);
  ethd__body_place(&sim->body, q, &sim->state);
  ethd__body_refer(&sim->body, &sim->state);
  ethd__body_ring(&sim->body, &sim->state, &x, &v);
  sim->state.q[ETHD__FINGER] = x.x;
  sim->state.q[ETHD__FINGER + 1] = x.y;
  ethd__path_piece(&sim->path, 0, &sim->piece);
  ethd__sensors_start(&sim->sensors, &sim->def, tap);
  take_due(sim);
  return ETHD_OK;
}

/* ---- read ---- */

static int64_t tick_ns(const ethd_sim *sim, int64_t tick) {
  return (int64_t)rint((double)tick * (1e9 * sim->def.period));
}

void ethd_sim_read(ethd_sim *sim, ethd_sense *out) {
  memset(out, 0, sizeof *out);
  out->time_ns = tick_ns(sim, sim->tick);
  ethd__sensors_joints(&sim->sensors, &sim->body, &sim->state, out);
  if (sim->tick == 0) {
    out->have |= ETHD_HAVE_START;
    out->finger[0] = sim->state.q[ETHD__FINGER];
    out->finger[1] = sim->state.q[ETHD__FINGER + 1];
  }
  ethd__sensors_deliver(&sim->sensors, sim->tick ? tick_ns(sim, sim->tick - 1) : -1, out);
}

void ethd_sim_truth(const ethd_sim *sim, ethd_truth *out) {
  ethd_vec x, v, motor, motor_v, hand, hand_v;
  ethd__body_ring(&sim->body, &sim->state, &x, &v);
  ethd__body_motor(&sim->body, &sim->state, &motor, &motor_v);
  ethd_path_at(&sim->path, sim->t, &hand, &hand_v);
  *out = (ethd_truth){.t = sim->t,
                      .ring = {x.x, x.y},
                      .ring_v = {v.x, v.y},
                      .motor = {motor.x, motor.y},
                      .motor_v = {motor_v.x, motor_v.y},
                      .finger = {sim->state.q[ETHD__FINGER], sim->state.q[ETHD__FINGER + 1]},
                      .finger_v = {sim->state.v[ETHD__FINGER], sim->state.v[ETHD__FINGER + 1]},
                      .hand = {hand.x, hand.y}};
  ethd__body_pad(&sim->body, &sim->state, &out->pad, &out->pad_force);
}

/* ---- write ---- */

/* What the motors give: 0 for a safe command or a number that isn't one. */
static void saturate(const ethd_sim *sim, const ethd_command *command, double out[2]) {
  for (int j = 0; j < 2; j++) {
    double torque = command->torque[j], most = sim->body.torque_max[j];
    out[j] = command->safe || isnan(torque) ? 0 : fmin(fmax(torque, -most), most);
  }
}

/* Next instant at which something happens, after or at t. */
static double next_instant(const ethd_sim *sim, double end, double update, double grid) {
  double next = fmin(fmin(end, update), fmin(grid, sim->piece.end));
  return fmin(next, ethd__sensors_next(&sim->sensors));
}

/* Steps end on a grid of the tick, so that a finer grid cuts each of them alike, and where the torque
   changes, a sensor samples, or the path has a kink. */
void ethd_sim_write(ethd_sim *sim, const ethd_command *command) {
  double torque[2], begin = sim->t, end = tick_time(sim, sim->tick + 1);
  double update = fmin(begin + sim->def.plant.delay, end);
  double cells = fmax(1, ceil(sim->def.period / sim->def.step - 1e-9));
  double cell = 1;
  saturate(sim, command, torque);
  ethd__body_refer(&sim->body, &sim->state);
  while (sim->t < end) {
    double grid = cell < cells ? begin + (end - begin) * (cell / cells) : end;
    double next = next_instant(sim, end, update, grid);
    if (next > sim->t) ethd__body_advance(&sim->body, &sim->piece, sim->t, next - sim->t, &sim->state);
    sim->t = next;
    if (next >= update) {
      memcpy(sim->body.torque, torque, sizeof torque);
      update = INFINITY;
    }
    if (next >= grid) cell++;
    if (next >= sim->piece.end) ethd__path_piece(&sim->path, next, &sim->piece);
    take_due(sim);
  }
  sim->tick++;
}
