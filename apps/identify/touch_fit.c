#include "identify/touch_fit.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "cli/cli.h"
#include "identify/touching.h"

#define QUICK 10   /* touches on which starts compete, */
#define SOON 0.025 /* s after the first reading that is near: so long are these touches; */
#define BRIEF 12   /* evaluations of each start */
#define LONG 40    /* evaluations of the fit */
#define MOST 64    /* touches of the fit */
#define ROUGH 1e-5 /* m/s: the simulator's tolerance while starts compete, */
#define FINE 1e-6  /* m/s: and for the numbers that are said */
#define STRANGE 4  /* standard deviations of a sum of squares: what leaves more doesn't follow the model */
#define BLATANT 8  /* the same before the numbers are fitted to it */
#define GUARD 8e-3 /* s: braking begins so softly that it shows so much later */
#define LOUD 1.15  /* standard deviations: a residual above it isn't explained */
#define SIDE 1.96  /* standard errors to each side of an interval of 95 % */
#define UNSURE 0.5 /* a number whose interval is wider to one side than this share of its range isn't seen; */
#define HOPELESS 4 /* beyond this share it isn't fitted beside the others either */
#define NOISE 1e-4 /* m: of readings whose noise isn't seen */

/* s after the first reading that is near: touches are followed so far, farther from one fit to the next. */
static const double ends[] = {0.015, 0.025, 0.04, 0.055, ETHD__TOUCH_AFTER};
enum { ENDS = sizeof ends / sizeof *ends };

static const ethd__chosen finger = {
    {ETHD__FINGER_MASS, ETHD__HAND_STIFFNESS, ETHD__HAND_DAMPING, ETHD__PAD_STIFFNESS, ETHD__PAD_DAMPING}, 5};

/* ---- how well touches are explained ---- */

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double *numbers(size_t count) {
  double *at = calloc(count ? count : 1, sizeof *at);
  if (!at) ethd__fail_memory();
  return at;
}

/* Fills the sum of squares that is left of each touch. */
static void find_squares(ethd__shooting *p, double *squares) {
  double x[ETHD__UNKNOWNS], *residual = numbers(p->rows);
  ethd__chosen_get(&p->chosen, &p->plant, x);
  ethd__shooting_residual(p, x, residual);
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    squares[i] = 0;
    for (int k = 0; k < w->rows; k++) squares[i] += residual[w->row + (size_t)k] * residual[w->row + (size_t)k];
  }
  free(residual);
}

static double median_rms(ethd__shooting *p) {
  double *rms = numbers(p->window_count), median;
  find_squares(p, rms);
  for (size_t i = 0; i < p->window_count; i++) rms[i] = sqrt(rms[i] / fmax(p->windows[i].rows - p->windows[i].rank, 1));
  qsort(rms, p->window_count, sizeof *rms, by_size);
  median = p->window_count ? rms[p->window_count / 2] : 0;
  free(rms);
  return median;
}

/* ---- starts ---- */

typedef struct guess {
  double mass, hand_stiffness, hand_damping, pad_stiffness, pad_damping;
} guess;

static const guess guesses[] = {{0.05, 150, 3, 12e3, 0.5}, {0.03, 80, 2, 25e3, 0.2}, {0.1, 300, 5, 6e3, 1}};
enum { GUESSES = sizeof guesses / sizeof *guesses };

static ethd_plant start_of(const ethd_plant *plant, int i) {
  ethd_plant out = *plant;
  if (i == GUESSES) return out; /* the numbers of --base */
  out.finger_mass = guesses[i].mass;
  out.hand_stiffness = guesses[i].hand_stiffness;
  out.hand_damping = guesses[i].hand_damping;
  out.pad_stiffness = guesses[i].pad_stiffness;
  out.pad_damping = guesses[i].pad_damping;
  return out;
}

/* Finds which of the starts explains some touches best. */
static void best_start(const ethd__evidence *e, const ethd_plant *starts, int count, ethd_plant *best,
                       double *simulated) {
  double least = (double)INFINITY;
  for (int i = 0; i < count && !ethd__stop; i++) {
    ethd__shooting quick;
    ethd__touching_open(e, SOON, QUICK, ROUGH, &quick);
    quick.plant = starts[i];
    quick.chosen = finger;
    ethd__touching_approach(&quick, SOON);
    (void)ethd__fit_squares(&quick, BRIEF, "touches");
    ethd__shooting_settle(&quick);
    double rms = median_rms(&quick);
    if (rms < least) {
      least = rms;
      *best = quick.plant;
    }
    *simulated += ethd__shooting_simulated(&quick);
    ethd__shooting_close(&quick);
  }
}

/* The noise of readings before the finger touches: of its path and the arm's motion alone. Later the encoders of a ring that
   hardly moves, whose rounding isn't noise, draw the finger's path away from the readings. */
static ethd__bracket find_noise(const ethd__evidence *e, const ethd_plant *plant, double *simulated) {
  ethd__shooting p;
  ethd__touching_open(e, 0, MOST, FINE, &p);
  p.plant = *plant;
  ethd__shooting_settle(&p);
  ethd__bracket noise = ethd__touching_noise(&p);
  *simulated += ethd__shooting_simulated(&p);
  ethd__shooting_close(&p);
  return noise;
}

/* ---- how far touches follow the model ---- */

typedef struct growth {
  ethd__shooting *problem;
  bool grows[MOST];                   /* it is followed further */
  double squares[MOST], before[MOST]; /* left now, and at the end before */
  int freedom[MOST];                  /* of the latter */
} growth;

static int freedom_of(const ethd__fit_window *w) { return w->rows - w->rank; }

static void note(growth *g) {
  const ethd__shooting *p = g->problem;
  for (size_t i = 0; i < p->window_count; i++) {
    g->before[i] = g->squares[i];
    g->freedom[i] = freedom_of(&p->windows[i]);
  }
}

/* Whether what was added to touch i, or its beginning, leaves more than so many standard deviations too much. */
static bool is_strange(const growth *g, size_t i, double most) {
  double added = freedom_of(&g->problem->windows[i]) - g->freedom[i];
  return !(g->squares[i] - g->before[i] <= added + most * sqrt(2 * fmax(added, 1)));
}

/* Ends the touches that stopped to follow the model short of where they did; whether there were any. */
static bool end_strange(growth *g, int stage, double most) {
  ethd__shooting *p = g->problem;
  bool found = false;
  find_squares(p, g->squares);
  for (size_t i = 0; i < p->window_count; i++) {
    if (!g->grows[i] || !is_strange(g, i, most)) continue;
    found = true;
    g->grows[i] = false;
    ethd__touching_end(p, i, fmax(ends[stage - 1] - GUARD, ends[0] - GUARD / 2));
  }
  if (!found) return false;
  ethd__shooting_ready(p);
  ethd__shooting_settle(p);
  return true;
}

static bool is_growing(const growth *g) {
  for (size_t i = 0; i < g->problem->window_count; i++)
    if (g->grows[i]) return true;
  return false;
}

/* Takes out the touches that are strange from their beginning on. */
static void leave_out(growth *g) {
  ethd__shooting *p = g->problem;
  size_t kept = 0, count = p->window_count;
  find_squares(p, g->squares);
  for (size_t i = 0; i < count; i++) {
    if (is_strange(g, i, STRANGE)) continue;
    g->squares[kept] = g->squares[i];
    p->windows[kept++] = p->windows[i];
  }
  p->window_count = kept;
  if (kept == count) return;
  ethd__shooting_ready(p);
  (void)ethd__fit_squares(p, LONG, "touches that are alike");
  ethd__shooting_settle(p);
  find_squares(p, g->squares);
}

/* The longer a touch, the more it shows; but a hand that brakes or turns back doesn't move on a cubic. So each touch is
   followed as far as what is added to it is explained, less a while in which braking that began wouldn't show yet. */
static double follow(ethd__shooting *p) {
  growth g = {.problem = p};
  double sum = ethd__fit_squares(p, LONG, "touches begin");
  ethd__shooting_settle(p);
  leave_out(&g);
  for (size_t i = 0; i < p->window_count; i++) g.grows[i] = true;
  for (int stage = 1; stage < ENDS && is_growing(&g) && !ethd__stop; stage++) {
    note(&g);
    for (size_t i = 0; i < p->window_count; i++)
      if (g.grows[i]) ethd__touching_end(p, i, ends[stage]);
    ethd__shooting_ready(p);
    ethd__shooting_settle(p);
    (void)end_strange(&g, stage, BLATANT);
    sum = ethd__fit_squares(p, LONG, "touches go on");
    ethd__shooting_settle(p);
    if (end_strange(&g, stage, STRANGE)) {
      sum = ethd__fit_squares(p, LONG, "touches go on");
      ethd__shooting_settle(p);
    }
    find_squares(p, g.squares);
  }
  return sum;
}

/* ---- how sure ---- */

/* Returns the range that a number could have, of which its interval must be a small share to say something. */
static double extent(const ethd_plant *plant, ethd__unknown u) {
  switch (u) {
  case ETHD__HAND_DAMPING: return fmax(plant->hand_damping, 1);
  case ETHD__PAD_DAMPING: return fmax(plant->pad_damping, 0.5);
  default: return 1; /* logarithms */
  }
}

static double doubt(const ethd__shooting *p, int i, double error) {
  ethd__unknown u = p->chosen.at[i];
  double scale = ethd__unknown_rows[u].scale;
  return SIDE * error * (scale > 0 ? scale : 1) / extent(&p->plant, u);
}

/* Keeps the numbers that the touches can't tell at all, and fits the rest again. A number that is only uncertain is
   still fitted, so that the others' intervals allow for what it leaves open. */
static void leave_hopeless(ethd__shooting *p, const ethd_plant *plant, double *errors) {
  for (;;) {
    int worst = -1;
    double most = HOPELESS;
    ethd__fit_errors(p, errors, NULL);
    for (int i = 0; i < p->chosen.count; i++) {
      double d = doubt(p, i, errors[i]);
      if (d <= most) continue;
      most = d;
      worst = i;
    }
    if (worst < 0 || ethd__stop) return;
    ethd__unknown u = p->chosen.at[worst];
    ethd__unknown_set(&p->plant, u, ethd__unknown_value(plant, u));
    ethd__chosen_drop(&p->chosen, u);
    (void)ethd__fit_squares(p, LONG, "what touches show");
  }
}

static void take_over(const ethd__shooting *p, const double *errors, ethd__fit *f) {
  double at[ETHD__UNKNOWNS];
  ethd__chosen_get(&p->chosen, &p->plant, at);
  for (int i = 0; i < p->chosen.count; i++) {
    ethd__unknown u = p->chosen.at[i];
    if (doubt(p, i, errors[i]) > UNSURE) continue;
    f->unseen[u] = false;
    ethd__unknown_set(&f->plant, u, ethd__unknown_value(&p->plant, u));
    f->low[u] = ethd__unknown_from(u, at[i] - SIDE * errors[i]);
    f->high[u] = ethd__unknown_from(u, at[i] + SIDE * errors[i]);
  }
}

/* ---- all of it ---- */

static void find_ends(const ethd__shooting *p, ethd__touch_fit *out) {
  out->least = (double)INFINITY;
  out->most = 0;
  for (size_t i = 0; i < p->window_count; i++) {
    double after = p->windows[i].window.count * p->evidence->period - ETHD__TOUCH_BEFORE;
    out->least = fmin(out->least, after);
    out->most = fmax(out->most, after);
  }
}

static void fit_all(const ethd__evidence *e, const ethd_plant *plant, const ethd_plant *start, ethd__fit *f,
                    ethd__touch_fit *out) {
  ethd__shooting p;
  double errors[ETHD__UNKNOWNS];
  ethd__touching_open(e, ends[0], MOST, FINE, &p);
  p.plant = *start;
  p.chosen = finger;
  ethd__touching_approach(&p, ends[0]);
  double sum = follow(&p);
  out->used = p.window_count;
  out->rms = sqrt(sum / fmax((double)(p.rows - ethd__shooting_states(&p)), 1));
  out->explained = out->rms <= LOUD && out->used >= ETHD__TOUCHES_LEAST;
  find_ends(&p, out);
  if (out->explained && !ethd__stop) {
    leave_hopeless(&p, plant, errors);
    take_over(&p, errors, f);
  }
  out->simulated += ethd__shooting_simulated(&p);
  ethd__shooting_close(&p);
}

void ethd__touch_fit_run(const ethd__evidence *e, const ethd__sensing *sensing, ethd__fit *f, ethd__touch_fit *out) {
  ethd_plant plant = f->plant, best = plant, starts[GUESSES + 1];
  clock_t begin = clock();
  *out = (ethd__touch_fit){.seen = e->onset_count, .noise = {(double)NAN, (double)NAN, (double)NAN}};
  for (int u = ETHD__FINGER_MASS; u <= ETHD__PAD_DAMPING; u++) f->unseen[u] = true;
  if (e->onset_count < ETHD__TOUCHES_LEAST) return;
  plant.count = sensing->count;
  plant.noise = sensing->noise.value > 0 ? sensing->noise.value : NOISE;
  out->noise = find_noise(e, &plant, &out->simulated);
  if (out->noise.value > 0) plant.noise = out->noise.value;
  for (int i = 0; i <= GUESSES; i++) starts[i] = start_of(&plant, i);
  best_start(e, starts, GUESSES + 1, &best, &out->simulated);
  fit_all(e, &plant, &best, f, out);
  out->seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
}
