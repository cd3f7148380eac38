#include "bounds/stability.h"

#include <math.h>
#include <string.h>

#include "bounds/motion.h"
#include "ethd/maths.h"

/* One tick is a linear map of the motion's state, the speed's estimate, the filter's position, the last tick's force,
   the delayed forces and the last positions. Its matrix is found by applying it to unit vectors. */
enum {
  X = ETHD_MOTION_X,
  V = ETHD_MOTION_V,
  LEAD_V = ETHD_MOTION_LEAD_V,
  ESTIMATE = ETHD_MOTION_STATE,
  FILTER,
  LAST,
  WAITING,
  STATE_MAX = WAITING + ETHD_LOOP_DELAY_MAX + 1 + ETHD_VELOCITY_WINDOW_MAX
};

typedef double matrix[STATE_MAX][STATE_MAX];

typedef struct model {
  const ethd__sampled_loop *loop;
  int waiting, past, size;            /* number of delayed forces; index of x_k-1; length of the state */
  int samples;                        /* number of past positions that are kept */
  double w[ETHD_VELOCITY_WINDOW_MAX]; /* v^ from x_k, x_k-1, ... */
  double keep;                        /* share of the last estimate (lowpass) */
  double alpha, beta, inertia;        /* kalman at the ring */
  ethd__bounds_motion before, after;  /* while the last tick's force still acts, and after that */
} model;

/* ---- estimators: v^_k = keep v^_k-1 + sum w_i x_k-i, but for the Kalman filter ---- */

static void use_difference(model *m, double share) {
  m->samples = 1;
  m->keep = 1 - share;
  m->w[0] = share / m->loop->period;
  m->w[1] = -m->w[0];
}

/* Uses the slope of the least-squares line through n samples at -i T. */
static void use_line(model *m, int n) {
  double mean = (n - 1) / 2.0, sum = n * ((double)n * n - 1) / 12;
  m->samples = n - 1;
  for (int i = 0; i < n; i++) m->w[i] = (mean - i) / (sum * m->loop->period);
}

/* Uses the steady gains of the filter driven by white acceleration (Kalata 1984). */
static void use_kalman(model *m) {
  const double *p = m->loop->p; /* noise, acceleration, inertia */
  double index = p[1] * m->loop->period * m->loop->period / p[0];
  double root = (4 + index - sqrt(index * (8 + index))) / 4;
  m->alpha = 1 - root * root;
  m->beta = 2 * (1 - root) * (1 - root);
  m->inertia = p[2] / (m->loop->link * m->loop->link);
}

static void prepare(const ethd__sampled_loop *loop, model *m) {
  *m = (model){.loop = loop};
  switch (loop->method) { /* without a default, so that the compiler reports a missing estimator */
  case ETHD_VELOCITY_LOWPASS: use_difference(m, 1 - ethd_exp(-2 * M_PI * loop->p[0] * loop->period)); break;
  case ETHD_VELOCITY_LSQ:
  case ETHD_VELOCITY_FOAW: use_line(m, (int)loop->p[0]); break;
  case ETHD_VELOCITY_KALMAN: use_kalman(m); break;
  case ETHD_VELOCITY_DIFFERENCE:
  case ETHD_VELOCITY_COUNT: use_difference(m, 1); break;
  }
  m->waiting = loop->delay + (loop->late > 0);
  ethd__bounds_motion_over(loop, loop->late, &m->before);
  ethd__bounds_motion_over(loop, loop->period - loop->late, &m->after);
  m->past = WAITING + m->waiting;
  m->size = m->past + m->samples;
}

static double estimate(const model *m, const double *s, double *filter) {
  double T = m->loop->period, v = m->keep * s[ESTIMATE] + m->w[0] * s[X];
  for (int i = 0; i < m->samples; i++) v += m->w[i + 1] * s[m->past + i];
  if (m->loop->method != ETHD_VELOCITY_KALMAN) return v;
  double u = s[LAST] / m->inertia;
  double position = s[FILTER] + (s[ESTIMATE] + u * T / 2) * T, speed = s[ESTIMATE] + u * T;
  *filter = position + m->alpha * (s[X] - position);
  return speed + m->beta / T * (s[X] - position);
}

/* ---- the tick ---- */

/* Maps the state over one tick. For its first `late` seconds the force of one tick earlier still acts. */
static void tick(const model *m, const double *s, double *next) {
  const ethd__sampled_loop *l = m->loop;
  double filter = 0;
  double v = estimate(m, s, &filter);
  double f = -l->stiffness * s[X] - l->damping * v;
  double now = l->delay ? s[WAITING + m->waiting - l->delay] : f, before = l->late > 0 ? s[WAITING] : 0;
  memcpy(next, s, ESTIMATE * sizeof *next);
  if (l->late > 0) ethd__bounds_motion_apply(&m->before, before, next);
  ethd__bounds_motion_apply(&m->after, now, next);
  next[ESTIMATE] = v;
  next[FILTER] = filter;
  next[LAST] = f;
  for (int i = 0; i < m->waiting; i++) next[WAITING + i] = i + 1 < m->waiting ? s[WAITING + i + 1] : f;
  for (int i = 0; i < m->samples; i++) next[m->past + i] = i ? s[m->past + i - 1] : s[X];
}

/* Fills the matrix in units that make its entries alike in size: m, T, and the force that moves the mass by 1 m in
   T. */
static void fill(const model *m, matrix a) {
  double unit[STATE_MAX], column[STATE_MAX], scale[STATE_MAX];
  double T = m->loop->period, force = m->loop->mass / (T * T);
  for (int i = 0; i < m->size; i++) scale[i] = i == V || i == LEAD_V || i == ESTIMATE ? 1 / T : 1;
  for (int i = LAST; i < m->past; i++) scale[i] = force;
  for (int j = 0; j < m->size; j++) {
    memset(unit, 0, sizeof unit);
    unit[j] = scale[j];
    tick(m, unit, column);
    for (int i = 0; i < m->size; i++) a[i][j] = column[i] / scale[i];
  }
}

/* ---- spectral radius: the limit of |A^k|^(1/k), k = 2^SQUARINGS ---- */

#define SQUARINGS 32

static double normalise(matrix a, int n) {
  double largest = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) largest = fmax(largest, fabs(a[i][j]));
  for (int i = 0; i < n && largest > 0; i++)
    for (int j = 0; j < n; j++) a[i][j] /= largest;
  return largest;
}

static void square(matrix a, matrix out, int n) {
  for (int i = 0; i < n; i++) {
    memset(out[i], 0, (size_t)n * sizeof(double));
    for (int k = 0; k < n; k++)
      for (int j = 0; j < n; j++) out[i][j] += a[i][k] * a[k][j];
  }
  memcpy(a, out, sizeof(matrix));
}

double ethd__sampled_radius(const ethd__sampled_loop *loop) {
  matrix a, scratch;
  model m;
  memset(scratch, 0, sizeof scratch);
  prepare(loop, &m);
  fill(&m, a);
  double log_norm = 0, share = 1;
  for (int i = 0; i <= SQUARINGS; i++, share /= 2) {
    double norm = normalise(a, m.size);
    if (!(norm > 0)) return 0;
    log_norm += share * log(norm);
    if (i < SQUARINGS) square(a, scratch, m.size);
  }
  return exp(log_norm);
}

/* The newest position has the weight w[0] in the estimate, or the Kalman filter's beta. */
double ethd__sampled_kick(const ethd__sampled_loop *loop, double count) {
  model m;
  prepare(loop, &m);
  double newest = loop->method == ETHD_VELOCITY_KALMAN ? m.beta / loop->period : m.w[0];
  double moved = ethd__sampled_gives_way(loop) ? loop->motor_mass : loop->mass;
  return (loop->stiffness + loop->damping * newest) * count * loop->period / moved;
}

/* A free ring's position is neither stable nor unstable, so its radius is 1, which counts as stable. */
bool ethd__sampled_stable(const ethd__sampled_loop *loop) { return ethd__sampled_radius(loop) <= 1 + 1e-7; }

double ethd__sampled_passive_friction(const ethd__sampled_loop *loop) {
  return loop->stiffness * loop->period / 2 + loop->damping;
}
