#include "identify/shooting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/share.h"

#define SETTLINGS 40 /* improvements of a window's state at most, until its squares fall by less than this share: */
#define SETTLED 1e-9
#define MOVED 1e-5     /* a state whose squares fall by a smaller share has hardly moved, and its slopes stay */
#define STEP 3e-4      /* step of a coordinate for a slope by finite differences */
#define DEPENDENT 1e-5 /* slope vectors whose independent part is below this share are dropped as dependent */

/* ---- windows ---- */

void ethd__shooting_close(ethd__shooting *p) {
  free(p->windows);
  free(p->basis);
  *p = (ethd__shooting){0};
}

size_t ethd__shooting_states(const ethd__shooting *p) {
  size_t sum = 0;
  for (size_t i = 0; i < p->window_count; i++) sum += (size_t)p->windows[i].rank;
  return sum;
}

double ethd__shooting_simulated(const ethd__shooting *p) {
  double ticks = 0;
  for (size_t i = 0; i < p->window_count; i++) ticks += (double)p->windows[i].predicted;
  return ticks * p->evidence->period;
}

/* ---- one window ---- */

static double *basis_of(const ethd__shooting *p, const ethd__fit_window *w) { return p->basis + ETHD__STATES * w->row; }

/* Tries all trials on the window. `useful` of them count as simulated time. */
static void try_all(const ethd__shooting *p, ethd__fit_window *w, const ethd__trial *trials, int count, int useful) {
  ethd__arm_try_all(p, w, trials, count);
  w->predicted += useful * w->window.count;
}

static void residual(const ethd__shooting *p, ethd__fit_window *w, const ethd_plant *plant, const double *state,
                     double *out) {
  try_all(p, w, &(ethd__trial){plant, state, out}, 1, 1);
}

static double dot(const double *a, const double *b, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static void add(double *a, double factor, const double *b, int n) {
  for (int i = 0; i < n; i++) a[i] += factor * b[i];
}

/* Removes from `out` its projection on the window's states. */
static void project(const ethd__shooting *p, const ethd__fit_window *w, double *out) {
  const double *basis = basis_of(p, w);
  for (int i = 0; i < w->rank; i++) add(out, -dot(basis + i * w->rows, out, w->rows), basis + i * w->rows, w->rows);
}

/* Corrects a state by its residual; returns the predicted reduction of the squares. */
static double correct(const ethd__shooting *p, const ethd__fit_window *w, const double *left, double *state) {
  const double *basis = basis_of(p, w);
  double promised = 0;
  for (int i = 0; i < w->rank; i++) {
    double along = dot(basis + i * w->rows, left, w->rows);
    add(state, along, w->turn[i], ETHD__STATES);
    promised += along * along;
  }
  return promised;
}

/* Fills the prediction's slopes by each number of the state, one after another: differences between predictions that
   take the same steps. */
static void state_slopes(const ethd__shooting *p, ethd__fit_window *w, const ethd_plant *plant, double *out) {
  int states = ethd__arm_states(plant);
  double state[ETHD__ARMS][ETHD__STATES], own[ETHD__RESIDUALS_MOST];
  for (int i = 0; i < states; i += ETHD__ARMS - 1) {
    ethd__trial t[ETHD__ARMS] = {{plant, w->state, own}};
    int count = 1;
    for (; count < ETHD__ARMS && i + count - 1 < states; count++) {
      int at = i + count - 1;
      memcpy(state[count], w->state, sizeof w->state);
      state[count][at] += ethd__arm_step(at);
      t[count] = (ethd__trial){plant, state[count], out + at * w->rows};
    }
    try_all(p, w, t, count, count - 1);
    for (int c = 1; c < count; c++)
      for (int k = 0; k < w->rows; k++) t[c].out[k] = (own[k] - t[c].out[k]) / ethd__arm_step(i + c - 1);
  }
}

/* Fills the basis of the prediction's slopes by the state (Gram and Schmidt, twice), and the matrix that turns
   coordinates in that basis into a state. */
static void span(const ethd__shooting *p, ethd__fit_window *w, const ethd_plant *plant) {
  int n = w->rows, states = ethd__arm_states(plant);
  double *slopes = basis_of(p, w);
  state_slopes(p, w, plant, slopes);
  w->rank = 0;
  for (int i = 0; i < states; i++) {
    double turn[ETHD__STATES] = {0}, *v = slopes + w->rank * n;
    memmove(v, slopes + i * n, (size_t)n * sizeof *v);
    turn[i] = 1;
    double whole = sqrt(dot(v, v, n));
    for (int twice = 0; twice < 2; twice++)
      for (int k = 0; k < w->rank; k++) {
        const double *other = slopes + k * n;
        double share = dot(other, v, n);
        add(v, -share, other, n);
        add(turn, -share, w->turn[k], ETHD__STATES);
      }
    double rest = sqrt(dot(v, v, n));
    if (!(rest > DEPENDENT * whole)) continue;
    for (int k = 0; k < n; k++) v[k] /= rest;
    for (int k = 0; k < ETHD__STATES; k++) w->turn[w->rank][k] = turn[k] / rest;
    w->rank++;
  }
}

/* ---- all windows ---- */

typedef struct job {
  ethd__shooting *problem;
  const ethd_plant *plants; /* the first, and one for each slope */
  int plant_count;
  double *out;
} job;

/* Moves the state by the projection of the residual on its basis, or by a part of it if the whole doesn't reduce the
   squares. Returns the remaining sum of squares. */
static double improve(const ethd__shooting *p, ethd__fit_window *w, const ethd_plant *plant, double *state,
                      double *left) {
  double moved[ETHD__STATES] = {0}, next[ETHD__STATES], now[ETHD__RESIDUALS_MOST], sum = dot(left, left, w->rows);
  if (correct(p, w, left, moved) < SETTLED * sum) return sum;
  for (double share = 1; share > 0.05; share /= 2) {
    for (int i = 0; i < ETHD__STATES; i++) next[i] = state[i] + share * moved[i];
    residual(p, w, plant, next, now);
    double less = dot(now, now, w->rows);
    if (!(less < sum)) continue;
    memcpy(state, next, sizeof next);
    memcpy(left, now, (size_t)w->rows * sizeof *now);
    return less;
  }
  return sum;
}

static void settle_one(const job *whole, ethd__fit_window *w) {
  const ethd__shooting *p = whole->problem;
  double left[ETHD__RESIDUALS_MOST];
  residual(p, w, whole->plants, w->state, left);
  if (w->rank) (void)improve(p, w, whole->plants, w->state, left); /* with the earlier slopes */
  span(p, w, whole->plants);
  double sum = dot(left, left, w->rows);
  for (int i = 0; i < SETTLINGS; i++) {
    double less = improve(p, w, whole->plants, w->state, left);
    if (less < sum * (1 - MOVED)) span(p, w, whole->plants);
    if (!(less < sum * (1 - SETTLED))) break;
    sum = less;
  }
}

static void residual_window(void *data, size_t i) {
  const job *whole = data;
  const ethd__shooting *p = whole->problem;
  ethd__fit_window *w = &p->windows[i];
  double state[ETHD__STATES], *out = whole->out + w->row;
  memcpy(state, w->state, sizeof state);
  residual(p, w, whole->plants, state, out);
  (void)improve(p, w, whole->plants, state, out);
  project(p, w, out);
}

/* Fills the slopes by the plant's coordinates: differences between predictions that take the same steps. */
static void plant_slopes(const job *whole, ethd__fit_window *w) {
  const ethd__shooting *p = whole->problem;
  double own[ETHD__RESIDUALS_MOST];
  for (int k = 1; k < whole->plant_count; k += ETHD__ARMS - 1) {
    ethd__trial t[ETHD__ARMS] = {{whole->plants, w->state, own}};
    int count = 1;
    for (; count < ETHD__ARMS && k + count - 1 < whole->plant_count; count++)
      t[count] = (ethd__trial){&whole->plants[k + count - 1], w->state,
                               whole->out + (size_t)(k + count - 2) * p->rows + w->row};
    try_all(p, w, t, count, count - 1);
    for (int c = 1; c < count; c++) {
      for (int r = 0; r < w->rows; r++) t[c].out[r] = (t[c].out[r] - own[r]) / STEP;
      project(p, w, t[c].out);
    }
  }
}

static void slope_window(void *data, size_t i) {
  const job *whole = data;
  settle_one(whole, &whole->problem->windows[i]);
  plant_slopes(whole, &whole->problem->windows[i]);
}

void ethd__shooting_residual(ethd__shooting *p, const double *coordinates, double *out) {
  ethd_plant plant = p->plant;
  ethd__chosen_set(&p->chosen, coordinates, &plant);
  job whole = {p, &plant, 1, out};
  ethd__share(residual_window, &whole, p->window_count);
}

void ethd__shooting_slopes(ethd__shooting *p, const double *coordinates, double *out) {
  ethd_plant plants[ETHD__UNKNOWNS + 1];
  for (int k = 0; k <= p->chosen.count; k++) {
    double moved[ETHD__UNKNOWNS];
    memcpy(moved, coordinates, (size_t)p->chosen.count * sizeof *moved);
    if (k) moved[k - 1] += STEP;
    plants[k] = p->plant;
    ethd__chosen_set(&p->chosen, moved, &plants[k]);
  }
  job whole = {p, plants, p->chosen.count + 1, out};
  ethd__share(slope_window, &whole, p->window_count);
}

void ethd__shooting_settle(ethd__shooting *p) {
  job whole = {p, &p->plant, 1, NULL};
  ethd__share(slope_window, &whole, p->window_count);
}
