#include "identify/touch_fit.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "cli/cli.h"
#include "identify/touch_follow.h"
#include "identify/touching.h"

#define QUICK 10   /* touches on which starts compete, */
#define SOON 0.025 /* s after the first reading that is near: so long are these touches; */
#define BRIEF 12   /* evaluations of each start */
#define ROUGH 1e-5 /* m/s: the simulator's tolerance while starts compete, */
#define FINE 1e-6  /* m/s: and for the numbers that are said */
#define LOUD 1.15  /* standard deviations: a residual above it isn't explained */
#define SIDE 1.96  /* standard errors to each side of an interval of 95 % */
#define UNSURE 0.5 /* a number whose interval is wider to one side than this share of its range isn't seen; */
#define HOPELESS 4 /* beyond this share it isn't fitted beside the others either */
#define NOISE 1e-4 /* m: of readings whose noise isn't seen */

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

static double median_rms(ethd__shooting *p) {
  double *rms = numbers(p->window_count), median;
  ethd__touch_squares(p, rms);
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

/* The noise of readings before the finger touches: of its path and the arm's motion alone. Later the encoders of a ring
   that hardly moves, whose rounding isn't noise, draw the finger's path away from the readings. */
static ethd__bracket find_noise(const ethd__evidence *e, const ethd_plant *plant, double *simulated) {
  ethd__shooting p;
  ethd__touching_open(e, 0, ETHD__TOUCHES_MOST, FINE, &p);
  p.plant = *plant;
  ethd__shooting_settle(&p);
  ethd__bracket noise = ethd__touching_noise(&p);
  *simulated += ethd__shooting_simulated(&p);
  ethd__shooting_close(&p);
  return noise;
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
    (void)ethd__fit_squares(p, ETHD__TOUCH_EVALUATIONS, "what touches show");
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
  ethd__touching_open(e, ETHD__TOUCH_SHORTEST, ETHD__TOUCHES_MOST, FINE, &p);
  p.plant = *start;
  p.chosen = finger;
  ethd__touching_approach(&p, ETHD__TOUCH_SHORTEST);
  double sum = ethd__touch_follow(&p);
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
