#include "identify/shooting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/share.h"

#define SETTLINGS 8 /* of a window's state at most, until the squares fall by less than this share: */
#define SETTLED 1e-9
#define MOVED 1e-5      /* a state whose squares fall by a smaller share has hardly moved: its slopes stay */
#define CHORDS 2        /* corrections of a state with the slopes that are there */
#define STEP_ANGLE 1e-6 /* rad, */
#define STEP_SPEED 1e-4 /* rad/s: for slopes by differences */
#define STEP 3e-4       /* of a coordinate */
#define DEPENDENT 1e-5  /* a vector of which others explain all but this says nothing */

static void *room(size_t count, size_t size) {
  void *at = calloc(count ? count : 1, size);
  if (!at) ethd__fail_memory();
  return at;
}

/* ---- windows ---- */

static void add_window(ethd__shooting *p, const ethd__passage *s, size_t first, size_t count) {
  if (!(p->window_count & (p->window_count + 1))) {
    p->windows = realloc(p->windows, (2 * p->window_count + 2) * sizeof *p->windows);
    if (!p->windows) ethd__fail_memory();
  }
  ethd__fit_window *w = &p->windows[p->window_count++];
  *w = (ethd__fit_window){.window = {first, s->first, s->first + s->count, (int)count, s->recording}};
}

static void thin(ethd__shooting *p, size_t most) {
  size_t kept = 0, count = p->window_count;
  for (size_t i = 0; i < count; i++)
    if (kept * count <= i * most && kept < most) p->windows[kept++] = p->windows[i];
  p->passed_over = count - kept;
  p->window_count = kept;
}

/* At first: the angles as measured, the speeds over some ticks. */
static void guess(const ethd__evidence *e, ethd__fit_window *w) {
  const int span = 5;
  size_t i = w->window.first;
  for (int j = 0; j < 2; j++) {
    w->state[j] = e->q[i][j];
    w->state[2 + j] = (e->q[i + span][j] - e->q[i][j]) / (span * e->period);
  }
}

void ethd__shooting_open(const ethd__evidence *e, size_t most, double tolerance, ethd__shooting *p) {
  size_t whole = (size_t)fmin(fmax(rint(ETHD__WINDOW / e->period), 16), ETHD__WINDOW_MOST);
  size_t least = (size_t)fmax(rint(ETHD__WINDOW_LEAST / e->period), 16);
  *p = (ethd__shooting){.evidence = e, .tolerance = tolerance};
  for (size_t i = 0; i < e->stretch_count; i++) {
    const ethd__passage *s = &e->stretches[i];
    for (size_t at = ETHD__BACK; at + least <= s->count; at += whole)
      add_window(p, s, s->first + at, s->count - at < whole ? s->count - at : whole);
  }
  if (p->window_count > most) thin(p, most);
  for (size_t i = 0; i < p->window_count; i++) {
    p->windows[i].row = p->rows;
    p->rows += 2 * (size_t)p->windows[i].window.count;
    guess(e, &p->windows[i]);
  }
  p->basis = room(ETHD__STATE_MOST * p->rows, sizeof *p->basis);
}

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

/* ---- one window ---- */

static double *basis_of(const ethd__shooting *p, const ethd__fit_window *w) {
  return p->basis + ETHD__STATE_MOST * w->row;
}

static void residual(ethd__predictor *predictor, ethd__fit_window *w, const double *state, double *out) {
  ethd__predict(predictor, &w->window, state, out);
  const double *measured = predictor->evidence->q[w->window.first];
  for (int i = 0; i < 2 * w->window.count; i++) out[i] = measured[i] - out[i];
  w->predicted += w->window.count;
}

static double dot(const double *a, const double *b, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static void add(double *a, double factor, const double *b, int n) {
  for (int i = 0; i < n; i++) a[i] += factor * b[i];
}

/* Takes out of `out` what the window's states explain. */
static void project(const ethd__shooting *p, const ethd__fit_window *w, double *out) {
  int n = 2 * w->window.count;
  const double *basis = basis_of(p, w);
  for (int i = 0; i < w->rank; i++) add(out, -dot(basis + i * n, out, n), basis + i * n, n);
}

/* A state's best correction by a residual. */
static void correct(const ethd__shooting *p, const ethd__fit_window *w, const double *left, double *state) {
  int n = 2 * w->window.count;
  for (int i = 0; i < w->rank; i++) add(state, dot(basis_of(p, w) + i * n, left, n), w->turn[i], ETHD__STATE_MOST);
}

static double step_of(int i) { return i == 2 || i == 3 || i >= 6 ? STEP_SPEED : STEP_ANGLE; }

/* What each state changes, one after another: differences between predictions that take the same steps. */
static void state_slopes(const ethd__predictor *predictor, ethd__fit_window *w, double *out) {
  int n = 2 * w->window.count, states = ethd__predictor_states(predictor);
  double state[ETHD__ARMS][ETHD__STATE_MOST], own[2 * ETHD__WINDOW_MOST];
  for (int i = 0; i < states; i += ETHD__ARMS - 1) {
    ethd__forecast f[ETHD__ARMS] = {{predictor, w->state, own}};
    int count = 1;
    for (; count < ETHD__ARMS && i + count - 1 < states; count++) {
      int at = i + count - 1;
      memcpy(state[count], w->state, sizeof w->state);
      state[count][at] += step_of(at);
      f[count] = (ethd__forecast){predictor, state[count], out + at * n};
    }
    ethd__predict_many(f, count, &w->window);
    w->predicted += (count - 1) * w->window.count;
    for (int c = 1; c < count; c++)
      for (int k = 0; k < n; k++) f[c].out[k] = (f[c].out[k] - own[k]) / step_of(i + c - 1);
  }
}

/* The basis of what states change (Gram and Schmidt, twice), and which state each vector of it stands for. */
static void span(ethd__shooting *p, const ethd__predictor *predictor, ethd__fit_window *w) {
  int n = 2 * w->window.count, states = ethd__predictor_states(predictor);
  double *slopes = basis_of(p, w);
  state_slopes(predictor, w, slopes);
  w->rank = 0;
  for (int i = 0; i < states; i++) {
    double turn[ETHD__STATE_MOST] = {0}, *v = slopes + w->rank * n;
    memmove(v, slopes + i * n, (size_t)n * sizeof *v);
    turn[i] = 1;
    double whole = sqrt(dot(v, v, n));
    for (int twice = 0; twice < 2; twice++)
      for (int k = 0; k < w->rank; k++) {
        const double *other = basis_of(p, w) + k * n;
        double share = dot(other, v, n);
        add(v, -share, other, n);
        add(turn, -share, w->turn[k], ETHD__STATE_MOST);
      }
    double rest = sqrt(dot(v, v, n));
    if (!(rest > DEPENDENT * whole)) continue;
    for (int k = 0; k < n; k++) v[k] /= rest;
    for (int k = 0; k < ETHD__STATE_MOST; k++) w->turn[w->rank][k] = turn[k] / rest;
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

/* Moves the state by what its basis sees in the residual, by less where the whole doesn't bring it down; the sum of
   squares that is left. */
static double improve(const ethd__shooting *p, ethd__predictor *predictor, ethd__fit_window *w, double *state,
                      double *left) {
  int n = 2 * w->window.count;
  double moved[ETHD__STATE_MOST] = {0}, next[ETHD__STATE_MOST], now[2 * ETHD__WINDOW_MOST], sum = dot(left, left, n);
  correct(p, w, left, moved);
  for (double share = 1; share > 0.05; share /= 2) {
    for (int i = 0; i < ETHD__STATE_MOST; i++) next[i] = state[i] + share * moved[i];
    residual(predictor, w, next, now);
    double less = dot(now, now, n);
    if (!(less < sum)) continue;
    memcpy(state, next, sizeof next);
    memcpy(left, now, (size_t)n * sizeof *now);
    return less;
  }
  return sum;
}

static void settle_one(const job *part, ethd__fit_window *w) {
  ethd__predictor predictor;
  ethd__shooting *p = part->problem;
  double left[2 * ETHD__WINDOW_MOST];
  ethd__predictor_prepare(p->evidence, part->plants, p->tolerance, &predictor);
  residual(&predictor, w, w->state, left);
  span(p, &predictor, w);
  double sum = dot(left, left, 2 * w->window.count);
  for (int i = 0; i < SETTLINGS; i++) {
    double less = improve(p, &predictor, w, w->state, left);
    if (less < sum * (1 - MOVED)) span(p, &predictor, w);
    if (!(less < sum * (1 - SETTLED))) break;
    sum = less;
  }
}

static void residual_one(const job *part, ethd__fit_window *w, const ethd_plant *plant, double *out) {
  ethd__predictor predictor;
  const ethd__shooting *p = part->problem;
  double state[ETHD__STATE_MOST];
  ethd__predictor_prepare(p->evidence, plant, p->tolerance, &predictor);
  memcpy(state, w->state, sizeof state);
  residual(&predictor, w, state, out);
  for (int i = 0; i < CHORDS; i++) (void)improve(p, &predictor, w, state, out);
  project(p, w, out);
}

static void residual_windows(void *data, size_t begin, size_t end) {
  const job *part = data;
  for (size_t i = begin; i < end; i++) {
    ethd__fit_window *w = &part->problem->windows[i];
    residual_one(part, w, part->plants, part->out + w->row);
  }
}

/* What each plant changes: differences between predictions that take the same steps. */
static void plant_slopes(const job *part, ethd__fit_window *w) {
  ethd__shooting *p = part->problem;
  int n = 2 * w->window.count;
  double own[2 * ETHD__WINDOW_MOST];
  ethd__predictor predictors[ETHD__ARMS];
  ethd__predictor_prepare(p->evidence, part->plants, p->tolerance, predictors);
  for (int k = 1; k < part->plant_count; k += ETHD__ARMS - 1) {
    ethd__forecast f[ETHD__ARMS] = {{predictors, w->state, own}};
    int count = 1;
    for (; count < ETHD__ARMS && k + count - 1 < part->plant_count; count++) {
      ethd__predictor_prepare(p->evidence, &part->plants[k + count - 1], p->tolerance, &predictors[count]);
      f[count] = (ethd__forecast){&predictors[count], w->state, part->out + (size_t)(k + count - 2) * p->rows + w->row};
    }
    ethd__predict_many(f, count, &w->window);
    w->predicted += (count - 1) * w->window.count;
    for (int c = 1; c < count; c++) {
      for (int r = 0; r < n; r++) f[c].out[r] = (own[r] - f[c].out[r]) / STEP;
      project(p, w, f[c].out);
    }
  }
}

static void slope_windows(void *data, size_t begin, size_t end) {
  const job *part = data;
  for (size_t i = begin; i < end; i++) {
    settle_one(part, &part->problem->windows[i]);
    plant_slopes(part, &part->problem->windows[i]);
  }
}

double ethd__shooting_simulated(const ethd__shooting *p) {
  double ticks = 0;
  for (size_t i = 0; i < p->window_count; i++) ticks += (double)p->windows[i].predicted;
  return ticks * p->evidence->period;
}

void ethd__shooting_residual(ethd__shooting *p, const double *coordinates, double *out) {
  ethd_plant plant = p->plant;
  ethd__chosen_set(&p->chosen, coordinates, &plant);
  job whole = {p, &plant, 1, out};
  ethd__share(residual_windows, &whole, p->window_count);
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
  ethd__share(slope_windows, &whole, p->window_count);
}

void ethd__shooting_settle(ethd__shooting *p) {
  job whole = {p, &p->plant, 1, NULL};
  ethd__share(slope_windows, &whole, p->window_count);
}
