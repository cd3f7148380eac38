#include "identify/fit.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "cli/cli.h"

#define QUICK 30    /* windows for the comparison of starts, */
#define BRIEF 20    /* evaluations of each */
#define LONG 60     /* evaluations of the fit */
#define WINDOWS 480 /* windows of the fit: two minutes */
#define REACHED 30  /* ticks whose command is beyond a torque limit that show the limit */
#define ROUGH 1e-6  /* m/s: the simulator's tolerance for comparisons of starts and models, */
#define FINE 1e-9   /* and for the reported numbers */
#define ENOUGH 1.02 /* times the residual of rounding: a smaller residual needs no better model */
#define SIDE 1.96   /* standard errors to each side of an interval of 95 % */
#define UNSURE 0.5  /* a number with a half interval over this share of its range isn't determined */

static const ethd__chosen rigid = {
    {ETHD__MASS_X, ETHD__MASS_Y, ETHD__FORCE_LIMIT, ETHD__FRICTION, ETHD__VISCOUS, ETHD__DELAY}, 6};
static const ethd__chosen compliant = {{ETHD__MASS_X, ETHD__MASS_Y, ETHD__FORCE_LIMIT, ETHD__FRICTION, ETHD__VISCOUS,
                                        ETHD__DELAY, ETHD__MOTOR_MASS, ETHD__STIFFNESS, ETHD__DAMPING},
                                       9};

/* ---- model ---- */

/* Returns the variance inflation from correlated residuals; 1 for white residuals. */
static double dependence(const ethd__shooting *p, const double *residual) {
  enum { LAGS = 20 };
  double sums[LAGS + 1] = {0}, factor = 1;
  for (size_t i = 0; i < p->window_count; i++) {
    const double *r = residual + p->windows[i].row;
    int n = p->windows[i].window.count;
    for (int lag = 0; lag <= LAGS; lag++)
      for (int k = 0; k + lag < n; k++)
        for (int j = 0; j < 2; j++) sums[lag] += r[2 * k + j] * r[2 * (k + lag) + j];
  }
  for (int lag = 1; lag <= LAGS && sums[lag] > 0; lag++) factor += 2 * sums[lag] / sums[0];
  return sums[0] > 0 ? factor : 1;
}

static double dependence_of(ethd__shooting *p) {
  double x[ETHD__UNKNOWNS];
  ETHD__FREED double *residual = malloc(p->rows * sizeof *residual);
  if (!residual) return 1;
  ethd__chosen_get(&p->chosen, &p->plant, x);
  ethd__shooting_residual(p, x, residual);
  return dependence(p, residual);
}

/* Bayes' criterion (Schwarz 1978), for the number of independent residuals, less the states. */
static double criterion(const ethd__shooting *p, double sum, double factor) {
  double freedom = (double)(p->rows - ethd__shooting_states(p)), count = freedom / factor;
  return count * log(fmax(sum / freedom, 1e-30)) + p->chosen.count * log(fmax(count, 2));
}

/* ---- starts ---- */

typedef struct contest {
  ethd__shooting *problem;
  ethd_plant best;
  double least;  /* its criterion */
  double sum;    /* its sum of squares */
  double factor; /* variance factor of its residuals; 0: not known yet */
} contest;

static void compete(contest *c, const ethd_plant *start, const char *what) {
  c->problem->plant = *start;
  double sum = ethd__fit_squares(c->problem, BRIEF, what);
  if (!(c->factor > 0)) c->factor = dependence_of(c->problem);
  double value = criterion(c->problem, sum, c->factor);
  if (!(value < c->least)) return;
  c->least = value;
  c->sum = sum;
  c->best = c->problem->plant;
}

/* Chooses the unknowns. A torque limit that no command reached has no slope, so it isn't fitted. */
static void choose(ethd__shooting *p, const ethd__chosen *chosen, const ethd_plant *start, double force) {
  p->chosen = *chosen;
  if (start->force_limit >= force) ethd__chosen_drop(&p->chosen, ETHD__FORCE_LIMIT);
}

static void rigid_starts(contest *c, double force) {
  ethd_plant starts[ETHD__STARTS];
  int count = ethd__fit_starts(c->problem->evidence, &c->best, starts);
  for (int i = 0; i < count; i++) {
    choose(c->problem, &rigid, &starts[i], force);
    compete(c, &starts[i], "rigid");
  }
}

/* Tries starts with several frequencies of the transmission. */
static void compliant_starts(contest *c, const ethd_plant *stiff, double force) {
  static const double frequencies[] = {25, 80, 200};
  choose(c->problem, &compliant, stiff, force);
  for (size_t i = 0; i < sizeof frequencies / sizeof *frequencies; i++) {
    ethd_plant start = *stiff;
    double least = fmin(stiff->mass[0], stiff->mass[1]), w = 2 * M_PI * frequencies[i];
    start.motor_mass = 0.2 * least;
    double reduced = start.motor_mass * (1 - start.motor_mass / least);
    start.stiffness = reduced * w * w;
    start.damping = 0.4 * reduced * w;
    compete(c, &start, "transmission");
  }
}

/* ---- undetermined numbers ---- */

/* Returns the value of an undetermined number. A torque limit is at least the largest command. */
static double kept(const ethd__fit *f, const ethd_plant *plant, ethd__unknown u) {
  double value = ethd__unknown_value(plant, u);
  return u == ETHD__FORCE_LIMIT ? fmax(value, 1.001 * f->force) : value;
}

/* Returns the plausible range of a number; its interval must be a small share of it. */
static double extent(const ethd__fit *f, const ethd__evidence *e, ethd__unknown u) {
  switch (u) {
  case ETHD__FRICTION: return fmax(f->plant.friction, 0.1 * f->force);
  case ETHD__VISCOUS: return fmax(f->plant.viscous, f->force);
  case ETHD__DELAY: return e->period;
  case ETHD__DAMPING: return fmax(f->plant.damping, 1);
  default: return 1; /* logarithms */
  }
}

static double doubt(const ethd__fit *f, const ethd__evidence *e, ethd__unknown u, double error) {
  double scale = ethd__unknown_rows[u].scale;
  return SIDE * error * (scale > 0 ? scale : 1) / extent(f, e, u);
}

/* Returns the number of ticks with a command over the limit. */
static size_t reached(const ethd__evidence *e, double limit) {
  size_t ticks = 0;
  double link[2] = {e->arm.link1, e->arm.link2};
  for (size_t i = 0; i < e->stretch_count; i++)
    for (size_t k = e->stretches[i].first; k < e->stretches[i].first + e->stretches[i].count; k++)
      for (int j = 0; j < 2; j++) ticks += fabs(e->torque[k][j]) > limit * link[j];
  return ticks;
}

/* Leaves a number out of the fit. A transmission's three numbers stay or go together, since one of another device
   beside two of this one makes no sense. */
static void leave(ethd__shooting *p, const ethd_plant *plant, ethd__fit *f, ethd__unknown which) {
  bool together = which >= ETHD__MOTOR_MASS && which <= ETHD__DAMPING;
  ethd__unknown first = together ? ETHD__MOTOR_MASS : which, last = together ? ETHD__DAMPING : which;
  for (ethd__unknown u = first; u <= last; u++) {
    f->unseen[u] = true;
    ethd__unknown_set(&p->plant, u, kept(f, plant, u));
    ethd__chosen_drop(&p->chosen, u);
  }
}

/* Leaves out the numbers that the recordings don't determine, the least certain first, and fits the rest again. */
static void leave_unseen(ethd__shooting *p, const ethd_plant *plant, ethd__fit *f, double *errors) {
  for (;;) {
    ethd__unknown worst = ETHD__UNKNOWNS;
    double most = UNSURE;
    f->plant = p->plant;
    ethd__fit_errors(p, errors, NULL);
    for (int i = 0; i < p->chosen.count; i++) {
      double d = doubt(f, p->evidence, p->chosen.at[i], errors[i]);
      if (p->chosen.at[i] == ETHD__FORCE_LIMIT && reached(p->evidence, p->plant.force_limit) < REACHED)
        d = (double)INFINITY;
      if (d <= most) continue;
      most = d;
      worst = p->chosen.at[i];
    }
    if (worst == ETHD__UNKNOWNS || ethd__stop) return;
    leave(p, plant, f, worst);
    f->sum = ethd__fit_squares(p, LONG, "what is seen");
  }
}

static void set_interval(ethd__fit *f, ethd__unknown u, double coordinate, double error) {
  f->low[u] = ethd__unknown_from(u, coordinate - SIDE * error);
  f->high[u] = ethd__unknown_from(u, coordinate + SIDE * error);
}

/* Few arms have a coupling, and it makes the simulator slow; so it is tested last, by one step of Gauss and Newton.
   It is fitted if 0 lies outside of its interval. */
static void look_for_coupling(ethd__shooting *p, const ethd_plant *plant, ethd__fit *f, double *errors) {
  double step[ETHD__UNKNOWNS];
  int last = p->chosen.count;
  ethd__chosen without = p->chosen;
  p->chosen.at[p->chosen.count++] = ETHD__COUPLING;
  ethd__fit_errors(p, errors, step);
  double most = UNSURE * p->evidence->arm.link1 * p->evidence->arm.link2 * sqrt(p->plant.mass[0] * p->plant.mass[1]);
  f->unseen[ETHD__COUPLING] = !(SIDE * ethd__unknown_from(ETHD__COUPLING, errors[last]) <= most);
  if (!f->unseen[ETHD__COUPLING] && fabs(step[last]) > SIDE * errors[last]) {
    ethd__fit before = *f;
    ethd_plant uncoupled = p->plant;
    f->sum = ethd__fit_squares(p, LONG, "coupling");
    leave_unseen(p, plant, f, errors);
    if (!f->unseen[ETHD__MASS_X] && !f->unseen[ETHD__MASS_Y]) return;
    *f = before; /* the coupling only stood for another effect */
    f->unseen[ETHD__COUPLING] = true;
    p->plant = uncoupled;
  }
  if (!f->unseen[ETHD__COUPLING]) set_interval(f, ETHD__COUPLING, step[last], errors[last]);
  p->chosen = without;
  ethd__fit_errors(p, errors, NULL);
}

/* ---- all of it ---- */

static double rms_of(const ethd__shooting *p, const contest *c) {
  return c->sum > 0 ? sqrt(c->sum / fmax((double)(p->rows - ethd__shooting_states(p)), 1)) : 0;
}

/* Compares the starts of both models on some windows; the better model is fitted to all. If the residual of a rigid arm
   is as small as rounding, `floor`, no transmission is tried. */
static void choose_model(ethd__shooting *quick, ethd__shooting *p, const ethd_plant *plant, double floor,
                         ethd__fit *f) {
  contest stiff = {.problem = quick, .best = *plant, .least = (double)INFINITY};
  rigid_starts(&stiff, f->force);
  contest gives = {.problem = quick, .best = stiff.best, .least = (double)INFINITY, .factor = stiff.factor};
  if (rms_of(quick, &stiff) > ENOUGH * floor) compliant_starts(&gives, &stiff.best, f->force);
  f->criterion[0] = stiff.least;
  f->criterion[1] = gives.least;
  bool compliant_is_better = gives.least < stiff.least;
  p->plant = compliant_is_better ? gives.best : stiff.best;
  choose(p, compliant_is_better ? &compliant : &rigid, &p->plant, f->force);
  (void)ethd__fit_squares(p, LONG, "all windows");
}

static bool is_chosen(const ethd__chosen *chosen, ethd__unknown u) {
  for (int i = 0; i < chosen->count; i++)
    if (chosen->at[i] == u) return true;
  return false;
}

void ethd__fit_run(const ethd__evidence *e, const ethd_plant *plant, double count, ethd__shooting *p, ethd__fit *f) {
  clock_t begin = clock();
  double errors[ETHD__UNKNOWNS], at[ETHD__UNKNOWNS];
  ethd__shooting quick;
  *f = (ethd__fit){.force = ethd__fit_force(e)};
  for (int u = 0; u < ETHD__UNKNOWNS; u++) f->low[u] = f->high[u] = (double)NAN;
  ethd__shooting_open(e, QUICK, ROUGH, &quick);
  ethd__shooting_open(e, WINDOWS, ROUGH, p);
  choose_model(&quick, p, plant, count / sqrt(12), f);
  p->tolerance = FINE;
  f->sum = ethd__fit_squares(p, LONG, "finer");
  if (!is_chosen(&p->chosen, ETHD__FORCE_LIMIT)) {
    f->unseen[ETHD__FORCE_LIMIT] = true;
    p->plant.force_limit = kept(f, plant, ETHD__FORCE_LIMIT);
  }
  leave_unseen(p, plant, f, errors);
  look_for_coupling(p, plant, f, errors);
  f->plant = p->plant;
  f->chosen = p->chosen;
  ethd__chosen_get(&p->chosen, &p->plant, at);
  for (int i = 0; i < p->chosen.count; i++) set_interval(f, p->chosen.at[i], at[i], errors[i]);
  f->freedom = (double)(p->rows - ethd__shooting_states(p)) - p->chosen.count;
  f->simulated = ethd__shooting_simulated(p) + ethd__shooting_simulated(&quick);
  f->seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
  ethd__shooting_close(&quick);
}
