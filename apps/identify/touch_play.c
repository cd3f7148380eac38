#include "identify/touch_play.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/series.h"

#define FAST 1e4          /* rad/s, and */
#define STEPS_MOST 400    /* steps a tick: a trial that is faster, or needs more of them, is given up */
#define IDEAL 1e-6        /* rad: standard deviation of encoders that don't round to counts */
#define STRIDES_MOST 4096 /* steps of a trial that others repeat */
#define CLEAR 1e-4        /* m from pad to ring: beyond it, all trials that differ little are apart alike */

/* ---- what is measured ---- */

int ethd__touch_samples(const ethd__evidence *e, const ethd__onset *o, int ticks,
                        ethd__touch_reading out[ETHD__TOUCH_READINGS]) {
  int n = 0;
  double T = e->period, end = (ticks - 1) * T;
  for (size_t i = o->delivery; i < e->delivery_count && n < ETHD__TOUCH_READINGS; i++) {
    const ethd__delivery *d = &e->deliveries[i];
    if (d->recording != o->recording || d->tick >= o->first + (size_t)o->count) break;
    double t = (double)(d->tick - o->first) * T - d->age;
    if (t > 0 && t < end && isfinite(d->centre.x + d->centre.y) && !(n && t <= out[n - 1].t))
      out[n++] = (ethd__touch_reading){t, d->centre, d->finger};
  }
  return n;
}

const ethd__onset *ethd__touch_onset(const ethd__evidence *e, const ethd__fit_window *w) {
  for (size_t i = 0; i < e->onset_count; i++)
    if (e->onsets[i].first == w->window.first) return &e->onsets[i];
  return NULL;
}

static double encoder_sd(const ethd_plant *plant) { return plant->count > 0 ? plant->count / sqrt(12) : IDEAL; }

/* ---- the simulator ---- */

/* The steps of a trial, which others beside it repeat. */
typedef struct gait {
  ethd__stride strides[STRIDES_MOST];
  int count;
} gait;

typedef struct play {
  const ethd__evidence *evidence;
  const ethd__fit_window *window;
  const ethd__touch_reading *samples;
  int sample_count, next; /* the first that is still to come */
  double tolerance;       /* m/s, of the simulator */
  ethd__body body;
  ethd__piece hand;
  ethd__leg leg;
  bool touched;
  gait *made;         /* NULL: nobody repeats its steps */
  const gait *follow; /* NULL: it finds its own */
  int at;             /* the next of these */
} play;

/* How far a trial goes before the finger comes near the ring. So far the arm knows nothing of the finger, which is on
   its path: others whose arm is the same begin here. */
typedef struct approach {
  int tick, next, stride; /* the first tick, sample and step that are still to come; tick 0: nothing is shared */
  ethd__sim_state state;
  ethd__body body;
  ethd_vec ring[ETHD__TOUCH_READINGS]; /* at the samples before */
} approach;

static void begin(play *p, const ethd_plant *plant, const double *x, double tolerance) {
  ethd_sim_def def = {.plant = *plant,
                      .arm = p->evidence->arm,
                      .ring_radius = 1,
                      .period = p->evidence->period,
                      .step = p->evidence->period,
                      .tolerance = tolerance};
  const double *path = x + ETHD__TOUCH_PATH;
  ethd__sim_state s;
  memset(&s, 0, sizeof s);
  ethd__body_prepare(&def, 1 - x[ETHD__TOUCH_GAP], &p->body);
  p->hand = (ethd__piece){.begin = -(double)INFINITY,
                          .end = (double)INFINITY,
                          .a = {path[0], path[1]},
                          .b = {path[2], path[3]},
                          .c = {path[4] / 2, path[5] / 2},
                          .d = {path[6] / 6, path[7] / 6}};
  for (int j = 0; j < 2; j++) {
    double lead = p->body.compliant ? x[ETHD__TOUCH_LEAD + j] : 0,
           lead_v = p->body.compliant ? x[ETHD__TOUCH_LEAD + 2 + j] : 0;
    int relative = j && p->body.serial;
    s.q[ETHD__MOTOR + j] = x[j];
    s.v[ETHD__MOTOR + j] = x[2 + j];
    s.q[ETHD__LINK + j] = x[j] + lead + (relative ? s.q[ETHD__LINK] : 0);
    s.v[ETHD__LINK + j] = x[2 + j] + lead_v + (relative ? s.v[ETHD__LINK] : 0);
    s.q[ETHD__FINGER + j] = path[j];
    s.v[ETHD__FINGER + j] = path[2 + j];
  }
  ethd__body_refer(&p->body, &s);
  ethd__leg_begin(&p->hand, 0, &s, &p->leg);
}

static void drive(play *p, int64_t tick) {
  int64_t first = (int64_t)p->window->window.begin;
  const double *torque = p->evidence->torque[tick < first ? first : tick];
  for (int j = 0; j < 2; j++) {
    double most = p->body.torque_max[j];
    p->body.torque[j] = fmin(fmax(torque[j], -most), most);
  }
}

/* Reads a sample off the leg; where the ring is. */
static ethd_vec look(const play *p, int sample, double *out) {
  ethd__sim_state s;
  ethd_vec ring, v;
  ethd__leg_at(&p->body, &p->hand, &p->leg, p->samples[sample].t, &s);
  ethd__body_ring(&p->body, &s, &ring, &v);
  out[0] = s.q[ETHD__FINGER] - ring.x;
  out[1] = s.q[ETHD__FINGER + 1] - ring.y;
  return ring;
}

static double *row_of(const play *p, int sample, double *out) { return out + 2 * (p->window->window.count + sample); }

/* As the other trial did as long as touch changes alike; from then on as it asks for itself. */
static void step_on(play *p, double until) {
  ethd__body_refer(&p->body, &p->leg.to);
  if (p->follow && p->at < p->follow->count) {
    if (ethd__leg_repeat(&p->body, &p->hand, &p->follow->strides[p->at++], until, &p->leg)) return;
    p->follow = NULL;
  }
  ethd__leg_next(&p->body, &p->hand, until, p->evidence->period, &p->leg);
  if (p->made && p->made->count < STRIDES_MOST) p->made->strides[p->made->count++] = ethd__leg_stride(&p->leg);
}

/* Steps up to `until` under one torque, and reads off tick k and the samples in between. False: the arm runs away, as
   no device does. */
static bool go_on(play *p, double until, int k, approach *shared, double *out) {
  double tick = k * p->evidence->period, angles[ETHD__DOF_MAX];
  for (int steps = 0; p->leg.end < until; steps++) {
    if (steps == STEPS_MOST || !(fabs(p->leg.to.v[0]) + fabs(p->leg.to.v[1]) < FAST)) return false;
    step_on(p, until);
    p->touched |= p->leg.to.touch != ETHD__APART;
    if (k && tick > p->leg.begin && tick <= p->leg.end) {
      ethd__leg_angles(&p->body, &p->leg, tick, angles);
      ethd__body_joints(&p->body, angles, out + 2 * k);
    }
    for (; p->next < p->sample_count && p->samples[p->next].t <= p->leg.end; p->next++) {
      ethd_vec ring = look(p, p->next, row_of(p, p->next, out));
      if (shared) shared->ring[p->next] = ring;
    }
  }
  return true;
}

static void remember(const play *p, int k, approach *out) {
  if (p->touched || !(p->leg.to.clearance > CLEAR)) return;
  out->tick = k + 1;
  out->next = p->next;
  out->stride = p->made ? p->made->count : 0;
  out->state = p->leg.to;
  out->body = p->body;
}

/* Returns when the torque of the tick before `tick` ends; first: the tick whose torque acts at the window's
   beginning. */
static double change_after(const play *p, const ethd__trial *t, int tick, int64_t *first) {
  double T = p->evidence->period, whole = floor(t->plant->delay / T);
  *first = (int64_t)p->window->window.first - (int64_t)whole;
  return tick * T + (t->plant->delay - whole * T);
}

/* Predicts the ticks from k on; notes in shared, where it is given, what comes before the touch. */
static void predict(play *p, const ethd__trial *t, int k, approach *shared) {
  int64_t first;
  bool runs = true;
  for (; k < p->window->window.count && runs; k++) {
    double until = change_after(p, t, k, &first);
    drive(p, first + k - 1);
    runs = go_on(p, until, k, shared, t->out);
    if (shared && runs) remember(p, k, shared);
  }
}

static void play_whole(play *p, const ethd__trial *t, approach *shared) {
  begin(p, t->plant, t->state, p->tolerance);
  memcpy(t->out, t->state, 2 * sizeof *t->out);
  predict(p, t, 0, shared);
}

/* From where another trial, whose arm is the same, comes near the ring. */
static void play_rest(play *p, const ethd__trial *t, const ethd__trial *other, const approach *shared) {
  int64_t first;
  begin(p, t->plant, t->state, p->tolerance);
  ethd__sim_state state = shared->state;
  double at = change_after(p, t, shared->tick - 1, &first);
  ethd__sim_motion hand = ethd__piece_at(&p->hand, at);
  ethd_vec_put(hand.x, state.q + ETHD__FINGER);
  ethd_vec_put(hand.v, state.v + ETHD__FINGER);
  state.clearance = 0;
  memcpy(p->body.at, shared->body.at, sizeof p->body.at);
  memcpy(p->body.sine, shared->body.sine, sizeof p->body.sine);
  memcpy(p->body.cosine, shared->body.cosine, sizeof p->body.cosine);
  ethd__leg_begin(&p->hand, at, &state, &p->leg);
  memcpy(t->out, other->out, 2 * (size_t)shared->tick * sizeof *t->out);
  for (; p->next < shared->next; p->next++) {
    ethd_vec finger = ethd__piece_at(&p->hand, p->samples[p->next].t).x, ring = shared->ring[p->next];
    ethd_vec_put(ethd_vec_sub(finger, ring), row_of(p, p->next, t->out));
  }
  p->at = shared->stride;
  predict(p, t, shared->tick, NULL);
}

/* Whether only the finger, its path and its gap differ. */
static bool is_same_arm(const ethd__trial *a, const ethd__trial *b) {
  if (memcmp(a->state, b->state, ETHD__TOUCH_PATH * sizeof *a->state) ||
      memcmp(a->state + ETHD__TOUCH_LEAD, b->state + ETHD__TOUCH_LEAD,
             (ETHD__TOUCH_STATES - ETHD__TOUCH_LEAD) * sizeof *a->state))
    return false;
  for (ethd__unknown u = 0; u < ETHD__FINGER_MASS; u++) {
    double x = ethd__unknown_value(a->plant, u), y = ethd__unknown_value(b->plant, u);
    if (memcmp(&x, &y, sizeof x)) return false;
  }
  return true;
}

/* From predictions to residuals. */
static void compare(const play *p, const ethd__trial *t) {
  int n = 2 * p->window->window.count;
  const double *q = p->evidence->q[p->window->window.first];
  for (int i = 0; i < n; i++) t->out[i] = (q[i] - t->out[i]) / encoder_sd(t->plant);
  for (int i = n; i < p->window->rows; i++) {
    const ethd_vec *c = &p->samples[(i - n) / 2].centre;
    t->out[i] = ((i & 1 ? c->y : c->x) - t->out[i]) / t->plant->noise;
  }
}

void ethd__touch_try_all(const ethd__shooting *s, const ethd__fit_window *w, const ethd__trial *trials, int count) {
  ethd__touch_reading samples[ETHD__TOUCH_READINGS];
  approach shared;
  gait steps;
  const play fresh = {
      .evidence = s->evidence,
      .window = w,
      .samples = samples,
      .tolerance = s->tolerance,
      .sample_count = ethd__touch_samples(s->evidence, ethd__touch_onset(s->evidence, w), w->window.count, samples)};
  shared.tick = steps.count = 0;
  for (int i = 0; i < count; i++) {
    play p = fresh;
    p.made = i ? NULL : &steps;
    p.follow = i ? &steps : NULL;
    memset(trials[i].out, 0,
           (size_t)w->rows * sizeof(double)); /* a plant that runs away is far from what is measured */
    if (i && shared.tick && is_same_arm(trials, &trials[i]))
      play_rest(&p, &trials[i], trials, &shared);
    else
      play_whole(&p, &trials[i], i || count == 1 ? NULL : &shared);
  }
  for (int i = 0; i < count; i++) compare(&fresh, &trials[i]);
}
