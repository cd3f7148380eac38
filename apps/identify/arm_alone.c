/* The arm in a window: its encoders are predicted from the commands. And how recordings are cut into windows. */
#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "identify/shooting.h"

#define STEP_ANGLE 1e-6 /* rad, and */
#define STEP_SPEED 1e-4 /* rad/s: step of a state for slopes by finite differences */
#define STIFF 1e4       /* 1/s: friction that stops a joint faster would need thousands of simulator steps a tick */

int ethd__arm_states(const ethd_plant *plant) {
  return isfinite(plant->stiffness) ? ETHD__STATE_MOST : ETHD__STATE_RIGID;
}

double ethd__arm_step(int i) { return i == 2 || i == 3 || i >= 6 ? STEP_SPEED : STEP_ANGLE; }

void ethd__arm_try_all(const ethd__shooting *p, const ethd__fit_window *w, const ethd__trial *trials, int count) {
  ethd__predictor predictors[ETHD__ARMS];
  ethd__forecast f[ETHD__ARMS] = {{0}};
  for (int i = 0; i < count; i++) {
    ethd__predictor_prepare(p->evidence, trials[i].plant, p->tolerance, &predictors[i]);
    f[i] = (ethd__forecast){&predictors[i], trials[i].state, trials[i].out};
  }
  if (count == 1)
    ethd__predict(predictors, &w->window, trials->state, trials->out);
  else
    ethd__predict_many(f, count, &w->window);
  const double *measured = p->evidence->q[w->window.first];
  for (int i = 0; i < count; i++)
    for (int k = 0; k < w->rows; k++) trials[i].out[k] = measured[k] - trials[i].out[k];
}

/* Returns whether the transmission is observable: its frequency must be below half the sampling rate. */
static bool is_seen(const ethd__evidence *e, const ethd_plant *x, double least) {
  double reduced = x->motor_mass * (1 - x->motor_mass / least), w = sqrt(x->stiffness / reduced);
  return x->stiffness > 1 && w * e->period < M_PI && x->damping > -0.1 && x->damping < 4 * reduced * w;
}

bool ethd__arm_is_possible(const ethd__shooting *p, const ethd_plant *x) {
  const ethd__evidence *e = p->evidence;
  bool compliant = isfinite(x->stiffness);
  double least = fmin(x->mass[0], x->mass[1]), own = compliant ? x->motor_mass : 0, l = e->arm.link1 * e->arm.link2;
  if (!(least > 1e-3 && fmax(x->mass[0], x->mass[1]) < 1e3 && x->force_limit > 1e-6 && x->force_limit < 1e6))
    return false;
  double moved = compliant ? own : least; /* the mass on which friction acts */
  if (!(x->friction > -0.05 * (1 + x->force_limit) && x->friction < STIFF * moved * ETHD__STICK)) return false;
  if (!(x->viscous > -1 && x->viscous < STIFF * moved)) return false;
  if (!(x->delay > -e->period && x->delay < (ETHD__BACK - 2) * e->period)) return false;
  if (!(fabs(x->coupling) < 0.95 * l * sqrt((x->mass[0] - own) * (x->mass[1] - own)))) return false;
  return !compliant || (own > 0.02 * least && own < 0.98 * least && is_seen(e, x, least));
}

/* ---- windows ---- */

static void thin(ethd__shooting *p, size_t most) {
  size_t kept = 0, count = p->window_count;
  for (size_t i = 0; i < count; i++)
    if (kept * count <= i * most && kept < most) p->windows[kept++] = p->windows[i];
  p->passed_over = count - kept;
  p->window_count = kept;
}

/* First guess of a state: measured angles, and speeds by differences over some ticks. */
static void guess(const ethd__evidence *e, ethd__fit_window *w) {
  const int span = 5;
  size_t i = w->window.first;
  for (int j = 0; j < 2; j++) {
    w->state[j] = e->q[i][j];
    w->state[2 + j] = (e->q[i + span][j] - e->q[i][j]) / (span * e->period);
  }
}

static ethd__fit_window *add(ethd__shooting *p) {
  if (!(p->window_count & (p->window_count + 1))) {
    p->windows = realloc(p->windows, (2 * p->window_count + 2) * sizeof *p->windows);
    if (!p->windows) ethd__fail_memory();
  }
  return &p->windows[p->window_count++];
}

static void cut(ethd__shooting *p, const ethd__passage *s, size_t first, size_t count) {
  ethd__fit_window *w = add(p);
  *w = (ethd__fit_window){.window = {first, s->first, s->first + s->count, (int)count, s->recording},
                          .rows = 2 * (int)count};
  guess(p->evidence, w);
}

static void make_basis(ethd__shooting *p) {
  for (size_t i = 0; i < p->window_count; i++) {
    p->windows[i].row = p->rows;
    p->windows[i].rank = 0;
    p->rows += (size_t)p->windows[i].rows;
  }
  p->basis = calloc(p->rows ? ETHD__STATES * p->rows : 1, sizeof *p->basis);
  if (!p->basis) ethd__fail_memory();
}

void ethd__shooting_open(const ethd__evidence *e, size_t most, double tolerance, ethd__shooting *p) {
  size_t whole = (size_t)fmin(fmax(rint(ETHD__WINDOW / e->period), 16), ETHD__WINDOW_MOST);
  size_t least = (size_t)fmax(rint(ETHD__WINDOW_LEAST / e->period), 16);
  *p = (ethd__shooting){.evidence = e, .tolerance = tolerance};
  for (size_t i = 0; i < e->stretch_count; i++) {
    const ethd__passage *s = &e->stretches[i];
    for (size_t at = ETHD__BACK; at + least <= s->count; at += whole)
      cut(p, s, s->first + at, s->count - at < whole ? s->count - at : whole);
  }
  if (p->window_count > most) thin(p, most);
  make_basis(p);
}

void ethd__shooting_part(const ethd__shooting *whole, uint32_t recording, ethd__shooting *p) {
  *p = (ethd__shooting){
      .evidence = whole->evidence, .plant = whole->plant, .chosen = whole->chosen, .tolerance = whole->tolerance};
  for (size_t i = 0; i < whole->window_count; i++)
    if (whole->windows[i].window.recording == recording) *add(p) = whole->windows[i];
  make_basis(p);
}
