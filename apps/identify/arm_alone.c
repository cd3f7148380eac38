/* The arm alone as the subject of a fit: in windows of its stretches, the encoders are predicted from the commands. */
#include <math.h>
#include <string.h>

#include "identify/shooting.h"

#define STEP_ANGLE 1e-6 /* rad, and */
#define STEP_SPEED 1e-4 /* rad/s, by which a state is changed to find its slopes by differences */
#define STIFF 1e4       /* 1/s: friction that stops a joint faster would take the simulator thousands of steps a tick */

static int states(const ethd_plant *plant) { return isfinite(plant->stiffness) ? ETHD__STATE_MOST : ETHD__STATE_RIGID; }

static double step(int i) { return i == 2 || i == 3 || i >= 6 ? STEP_SPEED : STEP_ANGLE; }

static double extent(int i) {
  (void)i;
  return (double)INFINITY;
}

static void try_all(const ethd__shooting *p, const ethd__fit_window *w, const ethd__trial *trials, int count) {
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

/* Returns whether the transmission can be told from a rigid one: it can't if it swings faster than half the sampling
   rate, or not at all. */
static bool is_seen(const ethd__evidence *e, const ethd_plant *x, double least) {
  double reduced = x->motor_mass * (1 - x->motor_mass / least), w = sqrt(x->stiffness / reduced);
  return x->stiffness > 1 && w * e->period < M_PI && x->damping > -0.1 && x->damping < 4 * reduced * w;
}

static bool is_possible(const ethd__shooting *p, const ethd_plant *x) {
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

static const ethd__fit_subject arm_alone = {states, step, extent, ETHD__ARMS, try_all, is_possible};

/* ---- windows ---- */

static void thin(ethd__shooting *p, size_t most) {
  size_t kept = 0, count = p->window_count;
  for (size_t i = 0; i < count; i++)
    if (kept * count <= i * most && kept < most) p->windows[kept++] = p->windows[i];
  p->passed_over = count - kept;
  p->window_count = kept;
}

/* The first guess at a state: the measured angles, and speeds by differences over some ticks. */
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
  ethd__shooting_begin(e, &arm_alone, tolerance, p);
  for (size_t i = 0; i < e->stretch_count; i++) {
    const ethd__passage *s = &e->stretches[i];
    for (size_t at = ETHD__BACK; at + least <= s->count; at += whole) {
      size_t count = s->count - at < whole ? s->count - at : whole;
      guess(e,
            ethd__shooting_add(p, &(ethd__shot){s->first + at, s->first, s->first + s->count, (int)count, s->recording},
                               2 * (int)count));
    }
  }
  if (p->window_count > most) thin(p, most);
  ethd__shooting_ready(p);
}
