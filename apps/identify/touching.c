#include "identify/touching.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/touch_play.h"

#define LEAST 4 /* readings before the touch that a guess at the path needs */

/* ---- the subject ---- */

static int states(const ethd_plant *plant) {
  return isfinite(plant->stiffness) ? ETHD__TOUCH_STATES : ETHD__TOUCH_LEAD;
}

static double step(int i) {
  static const double steps[ETHD__TOUCH_STATES] = {1e-7, 1e-7, 1e-5, 1e-5, 1e-7, 1e-7, 1e-5, 1e-5, 1e-3,
                                                   1e-3, 1e-1, 1e-1, 1e-7, 1e-7, 1e-7, 1e-5, 1e-5};
  return steps[i];
}

static double extent(int i) {
  static const double extents[ETHD__TOUCH_STATES] = {0.02, 0.02, 2,   2,    0.02, 0.02, 2, 2, 100,
                                                     100,  1e4,  1e4, 2e-3, 0.02, 0.02, 2, 2};
  return i < ETHD__TOUCH_STATES ? extents[i] : 0;
}

static bool is_possible(const ethd__shooting *s, const ethd_plant *x) {
  (void)s;
  return x->finger_mass > 2e-3 && x->finger_mass < 5 && x->hand_stiffness > 0.1 && x->hand_stiffness < 1e5 &&
         x->hand_damping > -2 && x->hand_damping < 500 && x->pad_stiffness > 100 && x->pad_stiffness < 1e6 &&
         x->pad_damping > -0.5 && x->pad_damping < 50;
}

static const ethd__fit_subject touching = {states, step, extent, ETHD__TOGETHER, ethd__touch_try_all, is_possible};

/* ---- first guesses ---- */

/* Guesses the path by a line through the finger's positions before the touch. False: there are too few. */
static bool guess_path(const ethd__touch_reading *s, int count, double until, double *path) {
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

void ethd__touching_open(const ethd__evidence *e, double after, size_t most, double tolerance, ethd__shooting *p) {
  int before = (int)rint(ETHD__TOUCH_BEFORE / e->period), ticks = before + (int)rint(after / e->period);
  ethd__touch_reading samples[ETHD__TOUCH_READINGS];
  ethd__shooting_begin(e, &touching, tolerance, p);
  for (size_t i = 0; i < e->onset_count; i++) {
    const ethd__onset *o = &e->onsets[i];
    double path[8] = {0};
    int count = ethd__touch_samples(e, o, ticks, samples);
    if (p->window_count * e->onset_count > i * most || !guess_path(samples, count, before * e->period, path)) continue;
    ethd__fit_window *w = ethd__shooting_add(
        p, &(ethd__shot){o->first, o->begin, o->first + (size_t)ticks, ticks, o->recording}, 2 * (ticks + count));
    guess_arm(e, w);
    memcpy(w->state + ETHD__TOUCH_PATH, path, sizeof path);
    w->state[ETHD__TOUCH_GAP] = o->gap;
  }
  ethd__shooting_ready(p);
}

void ethd__touching_end(ethd__shooting *p, size_t i, double after) {
  ethd__touch_reading samples[ETHD__TOUCH_READINGS];
  const ethd__evidence *e = p->evidence;
  ethd__fit_window *w = &p->windows[i];
  int ticks = (int)rint((ETHD__TOUCH_BEFORE + after) / e->period);
  const ethd__onset *o = ethd__touch_onset(e, w);
  w->window.count = ticks < o->count ? ticks : o->count;
  w->rows = 2 * (w->window.count + ethd__touch_samples(e, o, w->window.count, samples));
}

static void end_all(ethd__shooting *p, double after) {
  for (size_t i = 0; i < p->window_count; i++) ethd__touching_end(p, i, after);
  ethd__shooting_ready(p);
}

void ethd__touching_approach(ethd__shooting *p, double after) {
  static const double stages[] = {0, 0.008, 0.02, 0.04};
  for (size_t k = 0; k < sizeof stages / sizeof *stages && stages[k] < after && !ethd__stop; k++) {
    end_all(p, stages[k]);
    ethd__shooting_settle(p);
  }
  end_all(p, after);
}

/* What the states take of the readings' squares. */
static double taken(const ethd__shooting *p, const ethd__fit_window *w) {
  double sum = 0;
  for (int i = 0; i < w->rank; i++)
    for (int k = 2 * w->window.count; k < w->rows; k++) {
      double b = p->basis[ETHD__STATES * w->row + (size_t)(i * w->rows + k)];
      sum += b * b;
    }
  return sum;
}

ethd__bracket ethd__touching_noise(const ethd__shooting *p) {
  double squares = 0, freedom = 0, left[ETHD__RESIDUALS_MOST], scatter = 0;
  size_t room = p->window_count ? p->window_count : 1;
  double *own = calloc(2 * room, sizeof *own);
  if (!own) ethd__fail_memory();
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    ethd__touch_try_all(p, w, &(ethd__trial){&p->plant, w->state, left}, 1);
    for (int k = 2 * w->window.count; k < w->rows; k++) own[2 * i] += left[k] * left[k];
    own[2 * i + 1] = w->rows - 2 * w->window.count - taken(p, w);
    squares += own[2 * i];
    freedom += own[2 * i + 1];
  }
  double mean = squares / fmax(freedom, 1);
  for (size_t i = 0; i < p->window_count; i++) {
    double off = own[2 * i] - mean * own[2 * i + 1];
    scatter += off * off;
  }
  free(own);
  double error = fmax(sqrt(scatter) / (2 * squares), sqrt(0.5 / fmax(freedom, 1))), sd = p->plant.noise * sqrt(mean);
  if (!(freedom >= 50 && mean > 0)) return (ethd__bracket){(double)NAN, (double)NAN, (double)NAN};
  return (ethd__bracket){sd, sd * (1 - 1.96 * error), sd * (1 + 1.96 * error)};
}
