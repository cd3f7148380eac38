#include "identify/touch_fit.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "identify/touching.h"

#define QUICK 10    /* touches on which starts compete, */
#define BRIEF 12    /* with so many evaluations each */
#define LONG 40     /* evaluations of the fit */
#define MOST 64     /* touches of the fit */
#define STRANGE 1.5 /* times the median rms: a touch with more doesn't follow the model, as when the hand turns back */
#define LOUD 1.15   /* standard deviations: a residual above it isn't explained */
#define HOPEFUL 1.3 /* the same for a few touches, strange ones among them: below it all touches are fitted */
#define SIDE 1.96   /* standard errors to each side of an interval of 95 % */
#define UNSURE 0.5  /* a number whose interval is wider to one side than this share of its range isn't seen; */
#define HOPELESS 4  /* beyond this share it isn't fitted beside the others either */
#define NOISE 1e-4  /* m: of readings whose noise isn't seen */

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

/* Fills the rms of each touch, and returns their median. */
static double find_rms(ethd__shooting *p, double *rms) {
  double x[ETHD__UNKNOWNS], *residual = numbers(p->rows), *sorted = numbers(p->window_count), median;
  ethd__chosen_get(&p->chosen, &p->plant, x);
  ethd__shooting_settle(p);
  ethd__shooting_residual(p, x, residual);
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    double sum = 0;
    for (int k = 0; k < w->rows; k++) sum += residual[w->row + (size_t)k] * residual[w->row + (size_t)k];
    sorted[i] = rms[i] = sqrt(sum / fmax(w->rows - w->rank, 1));
  }
  qsort(sorted, p->window_count, sizeof *sorted, by_size);
  median = p->window_count ? sorted[p->window_count / 2] : 0;
  free(residual);
  free(sorted);
  return median;
}

/* Drops the touches that don't follow the model; returns whether there were any. */
static bool drop_strange(ethd__shooting *p) {
  double *rms = numbers(p->window_count), median = find_rms(p, rms);
  size_t kept = 0, count = p->window_count;
  for (size_t i = 0; i < count; i++)
    if (rms[i] <= STRANGE * median) p->windows[kept++] = p->windows[i];
  p->window_count = kept;
  ethd__shooting_ready(p);
  free(rms);
  return kept < count;
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

/* Finds which of the starts explains some touches of this length best, and returns how well. */
static double best_start(const ethd__evidence *e, double after, const ethd_plant *starts, int count, ethd_plant *best,
                         double *simulated) {
  double least = (double)INFINITY;
  for (int i = 0; i < count && !ethd__stop; i++) {
    ethd__shooting quick;
    ethd__touching_open(e, after, QUICK, &quick);
    quick.plant = starts[i];
    quick.chosen = finger;
    (void)ethd__fit_squares(&quick, BRIEF, "touches");
    double *rms = numbers(quick.window_count), median = find_rms(&quick, rms);
    if (median < least) {
      least = median;
      *best = quick.plant;
    }
    free(rms);
    *simulated += ethd__shooting_simulated(&quick);
    ethd__shooting_close(&quick);
  }
  return least;
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

/* Fits touches of this length, from the best start. */
static void fit_length(const ethd__evidence *e, const ethd_plant *plant, const ethd_plant *start, ethd__fit *f,
                       ethd__touch_fit *out) {
  ethd__shooting p;
  double errors[ETHD__UNKNOWNS];
  ethd__touching_open(e, out->after, MOST, &p);
  p.plant = *start;
  p.chosen = finger;
  double sum = ethd__fit_squares(&p, LONG, "all touches");
  if (drop_strange(&p)) sum = ethd__fit_squares(&p, LONG, "touches that are alike");
  out->used = p.window_count;
  out->rms = sqrt(sum / fmax((double)(p.rows - ethd__shooting_states(&p)), 1));
  out->explained = out->rms <= LOUD && out->used >= ETHD__TOUCHES_LEAST;
  if (out->explained && !ethd__stop) {
    leave_hopeless(&p, plant, errors);
    take_over(&p, errors, f);
  }
  out->simulated += ethd__shooting_simulated(&p);
  ethd__shooting_close(&p);
}

/* The longer a touch, the more it shows; but a hand that brakes or turns back during it doesn't move on a cubic. So the
   longest touches that the model explains count. */
void ethd__touch_fit_run(const ethd__evidence *e, const ethd__sensing *sensing, ethd__fit *f, ethd__touch_fit *out) {
  static const double lengths[] = {ETHD__TOUCH_AFTER, 0.04, 0.025, 0.015};
  ethd_plant plant = f->plant, best = plant, starts[GUESSES + 1];
  *out = (ethd__touch_fit){.seen = e->onset_count};
  for (int u = ETHD__FINGER_MASS; u <= ETHD__PAD_DAMPING; u++) f->unseen[u] = true;
  if (e->onset_count < ETHD__TOUCHES_LEAST) return;
  plant.count = sensing->count;
  plant.noise = sensing->noise.value > 0 ? sensing->noise.value : NOISE;
  for (int i = 0; i <= GUESSES; i++) starts[i] = start_of(&plant, i);
  for (size_t i = 0; i < sizeof lengths / sizeof *lengths && !out->explained && !ethd__stop; i++) {
    out->after = lengths[i];
    double rms = best_start(e, out->after, starts, i ? 2 : GUESSES + 1, &best, &out->simulated);
    if (rms <= HOPEFUL) fit_length(e, &plant, &best, f, out);
    starts[1] = best; /* a start for shorter touches, beside the first guess */
  }
}
