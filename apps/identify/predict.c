#include "identify/predict.h"

#include <math.h>
#include <string.h>

#include "sim/series.h"

#define FAR 1e9        /* m: pad and ring never meet */
#define FAST 1e4       /* rad/s, and */
#define STEPS_MOST 300 /* steps a tick: a trial of the fit that is faster, or needs more steps, is abandoned */

void ethd__predictor_prepare(const ethd__evidence *evidence, const ethd_plant *plant, double tolerance,
                             ethd__predictor *out) {
  ethd_sim_def def = {.plant = *plant,
                      .arm = evidence->arm,
                      .ring_radius = 1,
                      .period = evidence->period,
                      .step = evidence->period,
                      .tolerance = tolerance};
  def.plant.finger_mass = 1;
  def.plant.hand_stiffness = def.plant.hand_damping = def.plant.pad_stiffness = 0;
  out->evidence = evidence;
  out->delay = plant->delay;
  ethd__body_prepare(&def, 0, &out->body);
}

static void place(const ethd__body *b, const double *x, ethd__sim_state *out) {
  memset(out, 0, sizeof *out);
  out->clearance = FAR;
  for (int j = 0; j < 2; j++) {
    double lead = b->compliant ? x[4 + j] : 0, lead_v = b->compliant ? x[6 + j] : 0;
    int relative = j && b->serial;
    out->q[ETHD__MOTOR + j] = x[j];
    out->v[ETHD__MOTOR + j] = x[2 + j];
    out->q[ETHD__LINK + j] = x[j] + lead + (relative ? out->q[ETHD__LINK] : 0);
    out->v[ETHD__LINK + j] = x[2 + j] + lead_v + (relative ? out->v[ETHD__LINK] : 0);
  }
}

/* Returns the torque commanded at a tick, or at the nearest tick whose command is known. */
static const double *commanded(const ethd__predictor *p, const ethd__shot *w, int64_t tick) {
  int64_t begin = (int64_t)w->begin, end = (int64_t)w->end - 1;
  return p->evidence->torque[tick < begin ? begin : tick > end ? end : tick];
}

/* Applies the torque of a tick, limited as the motors limit it. */
static void drive(ethd__predictor *p, const ethd__shot *w, int64_t tick) {
  const double *torque = commanded(p, w, tick);
  for (int j = 0; j < 2; j++) {
    double most = p->body.torque_max[j];
    p->body.torque[j] = fmin(fmax(torque[j], -most), most);
  }
}

/* Splits the delay: torques change `ticks` ticks after the one that commanded them, and the returned time, s, later. */
static double lateness(const ethd__predictor *p, int64_t *ticks) {
  double T = p->evidence->period, whole = floor(p->delay / T);
  *ticks = (int64_t)whole;
  return p->delay - whole * T;
}

/* ---- one ---- */

/* Steps from one change of torque to the next, and interpolates the tick in between. `at` is the tick's time; INFINITY:
   there is none. False: the arm diverges. */
static bool go_on(ethd__predictor *p, const ethd__piece *still, double until, double at, ethd__leg *leg, double *out) {
  double angles[ETHD__DOF_MAX];
  for (int steps = 0; leg->end < until; steps++) {
    if (steps == STEPS_MOST || !(fabs(leg->to.v[0]) + fabs(leg->to.v[1]) < FAST)) return false;
    ethd__body_refer(&p->body, &leg->to);
    ethd__leg_next(&p->body, still, until, p->evidence->period, leg);
    if (!(at > leg->begin && at <= leg->end)) continue;
    ethd__leg_angles(&p->body, leg, at, angles);
    ethd__body_joints(&p->body, angles, out);
  }
  return true;
}

static void stand_still(double *out, int from, int count) {
  for (int k = from; k < count; k++) memcpy(out + 2 * k, out + 2 * (from - 1), 2 * sizeof *out);
}

void ethd__predict(ethd__predictor *p, const ethd__shot *w, const double *x, double *out) {
  const ethd__piece still = {.begin = -(double)INFINITY, .end = (double)INFINITY};
  int64_t ticks;
  double T = p->evidence->period, late = lateness(p, &ticks);
  int64_t first = (int64_t)w->first - ticks;
  ethd__sim_state state;
  ethd__leg leg;
  place(&p->body, x, &state);
  ethd__leg_begin(&still, 0, &state, &leg);
  out[0] = x[0];
  out[1] = x[1];
  drive(p, w, first - 1);
  bool runs = go_on(p, &still, late, (double)INFINITY, &leg, NULL);
  for (int k = 1; k < w->count; k++) {
    drive(p, w, first + k - 1);
    runs = runs && go_on(p, &still, k * T + late, k * T, &leg, out + 2 * k);
    if (!runs) {
      stand_still(out, k, w->count);
      return;
    }
  }
}

/* ---- several ---- */

/* Several arms in one window. Each counts time from its own changes of torque, so that their steps have similar lengths
   for different delays. */
typedef struct flock {
  const ethd__forecast *forecasts;
  const ethd__shot *window;
  int count;
  int64_t ticks[ETHD__ARMS];
  ethd__arms arms;
  ethd__arms_step step;
} flock;

static const ethd__forecast *member(const flock *f, int i) { return &f->forecasts[i < f->count ? i : 0]; }

static void drive_all(flock *f, int tick) {
  for (int i = 0; i < ETHD__ARMS; i++) {
    const double *torque =
        commanded(member(f, i)->predictor, f->window, (int64_t)f->window->first + tick - f->ticks[i]);
    ethd__arms_body *b = &f->arms.body[i];
    for (int j = 0; j < 2; j++) {
      double most = b->torque_max[j];
      b->torque[j] = torque[j] > most ? most : torque[j] < -most ? -most : torque[j];
    }
  }
}

static bool runs_away(const flock *f) {
  double most = 0;
  for (int i = 0; i < ETHD__ARMS; i++) {
    double speed = ethd__size(f->step.to[i].link_v);
    most = speed <= most ? most : speed;
  }
  return !(most < FAST);
}

/* Interpolates the arms that are due at tick k within the current step, which began `begun` before it. */
static void read_off(const flock *f, const double *begun, int k, bool due[ETHD__ARMS]) {
  for (int i = 0; i < f->count; i++) {
    if (!due[i] || begun[i] > f->step.length[i]) continue;
    due[i] = false;
    ethd__arms_joints(&f->arms, &f->step, i, begun[i], f->forecasts[i].out + 2 * k);
  }
}

/* Steps all arms through the time `whole` under one torque, with tick k at `at`; k 0: no tick. False: an arm
   diverges. */
static bool go_on_all(flock *f, const double *whole, const double *at, int k) {
  double left[ETHD__ARMS], begun[ETHD__ARMS];
  bool due[ETHD__ARMS] = {k, k, k, k};
  memcpy(left, whole, sizeof left);
  memcpy(begun, k ? at : whole, sizeof begun);
  for (int steps = 0; steps < STEPS_MOST && !runs_away(f); steps++) {
    bool over = ethd__arms_advance(&f->arms, left, &f->step);
    if (over)
      memcpy(f->step.length, whole, sizeof left); /* so that a due tick lies in the last step even with rounding */
    read_off(f, begun, k, due);
    if (over) return true;
    for (int i = 0; i < ETHD__ARMS; i++) {
      begun[i] -= f->step.length[i];
      left[i] -= f->step.length[i];
    }
  }
  return false;
}

static void begin(flock *f, double *late) {
  ethd__body bodies[ETHD__ARMS];
  for (int i = 0; i < ETHD__ARMS; i++) {
    const ethd__forecast *c = member(f, i);
    ethd__sim_state state;
    bodies[i] = c->predictor->body;
    place(&bodies[i], c->state, &state);
    ethd__arms_put(&f->step.to[i], &state);
    late[i] = lateness(c->predictor, &f->ticks[i]);
    memcpy(c->out, c->state, 2 * sizeof *c->out);
  }
  ethd__arms_prepare(bodies, &f->arms);
}

void ethd__predict_many(const ethd__forecast *forecasts, int count, const ethd__shot *w) {
  flock f;
  double late[ETHD__ARMS], period[ETHD__ARMS], at[ETHD__ARMS];
  f.forecasts = forecasts;
  f.window = w;
  f.count = count;
  begin(&f, late);
  for (int i = 0; i < ETHD__ARMS; i++) {
    period[i] = forecasts->predictor->evidence->period;
    at[i] = period[i] - late[i];
  }
  drive_all(&f, -1);
  bool runs = go_on_all(&f, late, NULL, 0);
  for (int k = 1; k < w->count; k++) {
    drive_all(&f, k - 1);
    runs = runs && go_on_all(&f, period, at, k);
    if (runs) continue;
    for (int i = 0; i < count; i++) stand_still(forecasts[i].out, k, w->count);
    return;
  }
}
