#include "encoder/unwrap.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define JUMPS_NS 10000000 /* a second jump within this is grave */
#define TURN 6.283185307179586
#define FRESH_NS 50000000 /* an edge older than this is no measure of speed */
#define SMOOTHING 0.003   /* s, of the speed from which energy is computed */
#define GAIN_LEAST 0.3    /* share of the work against the torque that appears as speed: over a half of it in a */
                          /* reversed joint, under a tenth in a joint that is pushed */

/* ---- counts ---- */

/* Returns a - b modulo M = ceiling + 1, in [-M / 2, M / 2). */
static int64_t shorter(uint64_t a, uint64_t b, uint64_t ceiling) {
  uint64_t up = a >= b ? a - b : ceiling - (b - a) + 1;
  if (up == 0) return 0;
  uint64_t down = ceiling - up + 1;
  return up < down ? (int64_t)up : (int64_t)(0 - down);
}

/* Adds modulo 2^64, because the position of a 64-bit counter may wrap too. */
static int64_t sum(int64_t a, int64_t b) { return (int64_t)((uint64_t)a + (uint64_t)b); }

static double angle_per_count(const ethd__encoder_def *def) {
  return def->sign * (TURN / ((double)def->counts_per_turn * def->ratio));
}

static int64_t away(int64_t d) { return d < 0 ? -d : d; }

/* ---- index marks ---- */

/* Returns the difference of two marks' distance from whole turns. */
static int64_t rest(int64_t distance, int64_t turn) {
  int64_t r = distance % turn;
  if (2 * r >= turn) r -= turn;
  if (2 * r < -turn) r += turn;
  return r;
}

static int64_t pass_mark(const ethd__encoder_def *def, ethd__encoder *e, uint64_t index) {
  int64_t mark = sum(e->position, shorter(index, e->raw, def->ceiling));
  int64_t turn = def->counts_per_turn;
  int known = e->marks;
  int wrong = away(rest(mark - e->mark, turn)) > 1 || away(rest(mark - e->first_mark, turn)) > 1;
  if (!known) e->first_mark = mark;
  if (!known && def->home) {
    e->home = sum(e->home, rest(mark - e->home, turn));
    e->homed = 1;
  }
  e->mark = mark;
  e->marks = 1;
  if (!known || !wrong) return 0;
  e->misindexed = 1;
  return ETHD_FAULT_BIT(ETHD_FAULT_INDEX);
}

/* ---- speed from edges ---- */

/* Returns the position of the last edge, which lies halfway between the present count and the one before. */
static double edge_place(const ethd__encoder *e) { return (double)e->position - 0.5 * e->direction; }

/* Without a new edge the speed is at most what an edge right now would show. */
static void wait_for_edge(ethd__encoder *e, int64_t now_ns, double per_count) {
  double t = 1e-9 * (double)(now_ns - e->edge_ns), most = t > 0 ? fabs(per_count) / t : (double)INFINITY;
  if (now_ns - e->edge_ns > FRESH_NS) e->dq = 0;
  if (fabs(e->dq) > most) e->dq = copysign(most, e->dq);
}

static void time_edges(const ethd__encoder_def *def, ethd__encoder *e, const ethd__count *s) {
  e->has_dq = 0;
  if (!def->stamps || s->edge_ns == 0) {
    e->edges = 0;
    return;
  }
  double per_count = angle_per_count(def), place;
  if (e->step) e->direction = e->step > 0 ? 1 : -1;
  place = edge_place(e);
  if (e->edges && s->edge_ns > e->edge_ns)
    e->dq = per_count * (place - e->edge) / (1e-9 * (double)(s->edge_ns - e->edge_ns));
  else if (e->edges)
    wait_for_edge(e, s->time_ns, per_count);
  else
    e->dq = 0;
  e->has_dq = e->edges;
  e->edge = place;
  e->edge_ns = s->edge_ns;
  e->edges = 1;
}

/* ---- against the torque ---- */

static int64_t check_still(const ethd__encoder_def *def, ethd__encoder *e, double dt, double torque) {
  if (e->step != 0) {
    e->low = e->high = torque;
    e->still = 0;
    return 0;
  }
  e->low = fmin(e->low, torque);
  e->high = fmax(e->high, torque);
  if (e->high - e->low > def->freeze_torque) e->still += dt;
  return e->still >= def->freeze_time ? ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_FROZEN) : 0;
}

static double energy(const ethd__encoder_def *def, double speed) { return 0.5 * def->inertia * speed * speed; }

/* A joint that is driven against its motion slows down, but a reversed encoder shows one that gains speed from the
   torque. A hand that pushes a joint with a sound encoder mostly works against the torque, so little of that work
   becomes speed. */
static int64_t check_direction(const ethd__encoder_def *def, ethd__encoder *e, double dt, double torque) {
  double way = angle_per_count(def) * (double)e->step;
  e->speed += (way / dt - e->speed) * (e->moves ? dt / (SMOOTHING + dt) : 1);
  e->moves = 1;
  int moves = fabs(e->speed) > fabs(angle_per_count(def)) / SMOOTHING; /* more than single counts */
  if (!(moves && fabs(torque) > def->reverse_torque && e->speed * torque < 0)) {
    e->wrong = 0;
    return 0;
  }
  if (e->wrong == 0) {
    e->wrong_speed = e->speed;
    e->work = 0;
  }
  e->wrong += dt;
  e->work -= torque * way;
  double gain = energy(def, e->speed) - energy(def, e->wrong_speed);
  int reversed = e->wrong >= def->reverse_time && gain > 0 && gain > GAIN_LEAST * e->work;
  return reversed ? ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_REVERSED) : 0;
}

/* ---- one sample ---- */

static void forget_motion(ethd__encoder *e) {
  e->low = (double)INFINITY;
  e->high = -(double)INFINITY;
  e->still = e->wrong = 0;
  e->moves = 0;
}

static void begin(const ethd__encoder_def *def, ethd__encoder *e, const ethd__count *s) {
  e->position = shorter(s->raw, 0, def->ceiling);
  e->raw = s->raw;
  e->time_ns = s->time_ns;
  e->started = 1;
  forget_motion(e);
}

/* Extrapolates with the last step's speed. */
static int64_t drop(const ethd__encoder_def *def, ethd__encoder *e, const ethd__count *s, int64_t *grave) {
  int64_t bit = ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_JUMP);
  if (e->jumped && s->time_ns - e->jump_ns <= JUMPS_NS) *grave |= bit;
  e->jumped = 1;
  e->jump_ns = s->time_ns;
  double steps = e->step_ns ? (double)(s->time_ns - e->time_ns) / (double)e->step_ns : 0;
  double place = (double)(e->position - e->home) + steps * (double)e->step;
  e->q = def->offset + angle_per_count(def) * place;
  return bit;
}

static bool is_jump(const ethd__encoder_def *def, const ethd__encoder *e, const ethd__count *s, int64_t step) {
  double dt = 1e-9 * (double)(s->time_ns - e->time_ns);
  double most = def->speed_max * dt / fabs(angle_per_count(def)) + 1;
  return s->raw > def->ceiling || (step && !(fabs((double)step) <= most));
}

int64_t ethd__encoder_step(const ethd__encoder_def *def, ethd__encoder *e, const ethd__count *s, double torque,
                           int64_t *grave) {
  int64_t faults = 0;
  if (!e->started && s->raw <= def->ceiling) begin(def, e, s);
  int64_t step = shorter(s->raw, e->raw, def->ceiling);
  if (e->paused && s->raw <= def->ceiling)
    e->time_ns = s->time_ns;
  else if (is_jump(def, e, s, step))
    return drop(def, e, s, grave);
  e->paused = 0;
  e->step = step;
  e->step_ns = s->time_ns - e->time_ns;
  e->position = sum(e->position, step);
  e->raw = s->raw;
  e->time_ns = s->time_ns;
  if (s->flags & ETHD__COUNT_INDEX) faults |= pass_mark(def, e, s->index);
  time_edges(def, e, s);
  double dt = 1e-9 * (double)e->step_ns;
  if (dt > 0) {
    faults |= check_still(def, e, dt, torque);
    faults |= check_direction(def, e, dt, torque);
  }
  e->q = def->offset + angle_per_count(def) * (double)(e->position - e->home);
  return faults;
}

void ethd__encoder_restart(ethd__encoder *e) {
  int32_t misindexed = e->misindexed;
  memset(e, 0, sizeof *e);
  e->misindexed = misindexed;
}

void ethd__encoder_pause(ethd__encoder *e) {
  e->paused = e->started;
  e->edges = e->jumped = 0;
  forget_motion(e);
}

void ethd__encoder_place(const ethd__encoder_def *def, ethd__encoder *e, double q) {
  e->home = e->position - (int64_t)rint((q - def->offset) / angle_per_count(def));
  e->homed = 1;
  e->q = q;
}
