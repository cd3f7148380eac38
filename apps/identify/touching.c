#include "identify/touching.h"

#include <math.h>
#include <string.h>

#include "sim/series.h"

#define TOLERANCE 1e-8   /* m/s, of the simulator */
#define FAST 1e4         /* rad/s, and */
#define STEPS_MOST 400   /* steps a tick: a trial that is faster, or needs more of them, is given up */
#define IDEAL 1e-6       /* rad: standard deviation of encoders that don't round to counts */
#define READINGS_MOST 96 /* readings of a touch */
#define LEAST 4          /* readings before the touch that a guess at the path needs */

/* ---- what is measured ---- */

/* A reading that was taken within the window, at t, s after its first tick. */
typedef struct touch_reading {
  double t;
  ethd_vec centre, finger;
} touch_reading;

static int samples_of(const ethd__evidence *e, const ethd__onset *o, int ticks, touch_reading *out) {
  int n = 0;
  double T = e->period, end = (ticks - 1) * T;
  for (size_t i = o->delivery; i < e->delivery_count && n < READINGS_MOST; i++) {
    const ethd__delivery *d = &e->deliveries[i];
    if (d->recording != o->recording || d->tick >= o->first + (size_t)o->count) break;
    double t = (double)(d->tick - o->first) * T - d->age;
    if (t > 0 && t < end && isfinite(d->centre.x + d->centre.y) && !(n && t <= out[n - 1].t))
      out[n++] = (touch_reading){t, d->centre, d->finger};
  }
  return n;
}

static const ethd__onset *onset_of(const ethd__evidence *e, const ethd__fit_window *w) {
  for (size_t i = 0; i < e->onset_count; i++)
    if (e->onsets[i].first == w->window.first) return &e->onsets[i];
  return NULL;
}

static double encoder_sd(const ethd_plant *plant) { return plant->count > 0 ? plant->count / sqrt(12) : IDEAL; }

/* ---- the simulator ---- */

typedef struct play {
  const ethd__evidence *evidence;
  const ethd__fit_window *window;
  ethd__body body;
  ethd__piece hand;
  ethd__leg leg;
} play;

static void begin(play *p, const ethd_plant *plant, const double *x) {
  ethd_sim_def def = {.plant = *plant,
                      .arm = p->evidence->arm,
                      .ring_radius = 1,
                      .period = p->evidence->period,
                      .step = p->evidence->period,
                      .tolerance = TOLERANCE};
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

static ethd_vec centre_at(play *p, double t) {
  ethd__sim_state s;
  ethd_vec ring, v;
  ethd__leg_at(&p->body, &p->hand, &p->leg, t, &s);
  ethd__body_ring(&p->body, &s, &ring, &v);
  return (ethd_vec){s.q[ETHD__FINGER] - ring.x, s.q[ETHD__FINGER + 1] - ring.y};
}

/* Steps up to `until` under one torque, and reads off tick k and the samples in between. False: the arm runs away, as
   no device does. */
static bool go_on(play *p, double until, int k, const touch_reading *samples, int *next, double *out) {
  int n = p->window->window.count, count = (p->window->rows - 2 * n) / 2;
  double tick = k * p->evidence->period, angles[ETHD__DOF_MAX];
  for (int steps = 0; p->leg.end < until; steps++) {
    if (steps == STEPS_MOST || !(fabs(p->leg.to.v[0]) + fabs(p->leg.to.v[1]) < FAST)) return false;
    ethd__body_refer(&p->body, &p->leg.to);
    ethd__leg_next(&p->body, &p->hand, until, p->evidence->period, &p->leg);
    if (k && tick > p->leg.begin && tick <= p->leg.end) {
      ethd__leg_angles(&p->body, &p->leg, tick, angles);
      ethd__body_joints(&p->body, angles, out + 2 * k);
    }
    for (; *next < count && samples[*next].t <= p->leg.end; ++*next) {
      ethd_vec c = centre_at(p, samples[*next].t);
      out[2 * (n + *next)] = c.x;
      out[2 * (n + *next) + 1] = c.y;
    }
  }
  return true;
}

static bool predict(play *p, double delay, const touch_reading *samples, double *out) {
  double T = p->evidence->period, whole = floor(delay / T), late = delay - whole * T;
  int64_t first = (int64_t)p->window->window.first - (int64_t)whole;
  int next = 0;
  drive(p, first - 1);
  bool runs = go_on(p, late, 0, samples, &next, out);
  for (int k = 1; k < p->window->window.count && runs; k++) {
    drive(p, first + k - 1);
    runs = go_on(p, k * T + late, k, samples, &next, out);
  }
  return runs;
}

static void try_one(const ethd__shooting *s, const ethd__fit_window *w, const ethd__trial *t) {
  play p = {.evidence = s->evidence, .window = w};
  touch_reading samples[READINGS_MOST];
  int n = 2 * w->window.count;
  (void)samples_of(s->evidence, onset_of(s->evidence, w), w->window.count, samples);
  memset(t->out, 0, (size_t)w->rows * sizeof *t->out); /* so that a plant that runs away is far from what is measured */
  begin(&p, t->plant, t->state);
  memcpy(t->out, t->state, 2 * sizeof *t->out);
  (void)predict(&p, t->plant->delay, samples, t->out);
  const double *q = s->evidence->q[w->window.first];
  for (int i = 0; i < n; i++) t->out[i] = (q[i] - t->out[i]) / encoder_sd(t->plant);
  for (int i = n; i < w->rows; i++) {
    const ethd_vec *c = &samples[(i - n) / 2].centre;
    t->out[i] = ((i & 1 ? c->y : c->x) - t->out[i]) / t->plant->noise;
  }
}

/* ---- the subject ---- */

static int states(const ethd_plant *plant) {
  return isfinite(plant->stiffness) ? ETHD__TOUCH_STATES : ETHD__TOUCH_LEAD;
}

static double step(int i) {
  static const double steps[ETHD__TOUCH_STATES] = {1e-7, 1e-7, 1e-5, 1e-5, 1e-7, 1e-7, 1e-5, 1e-5, 1e-3,
                                                   1e-3, 1e-1, 1e-1, 1e-7, 1e-7, 1e-7, 1e-5, 1e-5};
  return steps[i];
}

static void try_all(const ethd__shooting *s, const ethd__fit_window *w, const ethd__trial *trials, int count) {
  for (int i = 0; i < count; i++) try_one(s, w, &trials[i]);
}

static bool is_possible(const ethd__shooting *s, const ethd_plant *x) {
  (void)s;
  return x->finger_mass > 2e-3 && x->finger_mass < 5 && x->hand_stiffness > 0.1 && x->hand_stiffness < 1e5 &&
         x->hand_damping > -2 && x->hand_damping < 500 && x->pad_stiffness > 100 && x->pad_stiffness < 1e6 &&
         x->pad_damping > -0.5 && x->pad_damping < 50;
}

static const ethd__fit_subject touching = {states, step, try_all, is_possible};

/* ---- first guesses ---- */

/* Guesses the path by a line through the finger's positions before the touch. False: there are too few. */
static bool guess_path(const touch_reading *s, int count, double until, double *path) {
  double n = 0, t = 0, tt = 0, x[2] = {0, 0}, tx[2] = {0, 0};
  for (int i = 0; i < count && s[i].t <= until; i++) {
    const double f[2] = {s[i].finger.x, s[i].finger.y};
    if (!isfinite(f[0] + f[1])) continue;
    n++;
    t += s[i].t;
    tt += s[i].t * s[i].t;
    for (int j = 0; j < 2; j++) {
      x[j] += f[j];
      tx[j] += s[i].t * f[j];
    }
  }
  if (n < LEAST) return false;
  for (int j = 0; j < 2; j++) {
    path[2 + j] = (n * tx[j] - t * x[j]) / (n * tt - t * t);
    path[j] = (x[j] - path[2 + j] * t) / n;
  }
  return true;
}

static void guess_arm(const ethd__evidence *e, ethd__fit_window *w) {
  const int span = 10;
  size_t i = w->window.first;
  for (int j = 0; j < 2; j++) {
    w->state[j] = e->q[i][j];
    w->state[2 + j] = (e->q[i + span][j] - e->q[i - ETHD__BACK][j]) / ((span + ETHD__BACK) * e->period);
  }
}

void ethd__touching_open(const ethd__evidence *e, double after, size_t most, ethd__shooting *p) {
  int before = (int)rint(ETHD__TOUCH_BEFORE / e->period), ticks = before + (int)rint(after / e->period);
  touch_reading samples[READINGS_MOST];
  ethd__shooting_begin(e, &touching, TOLERANCE, p);
  for (size_t i = 0; i < e->onset_count; i++) {
    const ethd__onset *o = &e->onsets[i];
    double path[8] = {0};
    int count = samples_of(e, o, ticks, samples);
    if (p->window_count * e->onset_count > i * most || !guess_path(samples, count, before * e->period, path)) continue;
    ethd__fit_window *w = ethd__shooting_add(
        p, &(ethd__shot){o->first, o->begin, o->first + (size_t)ticks, ticks, o->recording}, 2 * (ticks + count));
    guess_arm(e, w);
    memcpy(w->state + ETHD__TOUCH_PATH, path, sizeof path);
    w->state[ETHD__TOUCH_GAP] = o->gap;
  }
  ethd__shooting_ready(p);
}
