#include "ethd/estimate.h"

#include <math.h>
#include <string.h>

#include "estimate/filter_methods.h"
#include "fp_mode.h"

/* How far off a filter's start may be: the variances of each axis. Only for ca is the acceleration uncertain. */
typedef struct doubt {
  double x, v, a; /* m^2, m^2/s^2, m^2/s^4 */
} doubt;

static void begin(const ethd_filter *f, ethd_filter_state *s, ethd_vec x, ethd_vec v, doubt d) {
  double p[6] = {d.x, 0, 0, d.v, 0, f->method == ETHD_FILTER_CA ? d.a : 0};
  s->x[0] = x.x, s->x[1] = x.y;
  s->v[0] = v.x, s->v[1] = v.y;
  s->a[0] = s->a[1] = 0;
  memcpy(s->cov, p, sizeof p);
  s->started = 1;
  s->gated_in_a_row = 0;
}

void ethd_filter_start(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x, ethd_vec v) {
  begin(filter, state, x, v, (doubt){1e-6, 1e-4, 1}); /* sd 1 mm, 1 cm/s, 1 m/s^2: the start is known */
  state->age = filter->compensation == ETHD_COMPENSATION_STAMP ? -filter->p[FILTER_LATENCY] : INFINITY;
}

/* What a reading says: where, how long ago, and how far off it may be (sd of each axis). */
typedef struct sighting {
  ethd_vec x;
  double age, noise; /* s, m */
} sighting;

static void start_from(const ethd_filter *f, ethd_filter_state *s, const sighting *seen) {
  double square = seen->noise * seen->noise;
  begin(f, s, seen->x, (ethd_vec){0, 0}, (doubt){square, 1, 100}); /* sd 1 m/s, 10 m/s^2: a finger in full motion */
  s->age = seen->age;
  s->used++;
}

static void advance(const ethd_filter *f, ethd_filter_state *s, double t) {
  ethd__filter_motion w = ethd__filter_motion_over(f, t);
  for (int i = 0; i < 2; i++) {
    s->x[i] += s->v[i] * t + s->a[i] * w.ax;
    s->v[i] += s->a[i] * w.av;
    s->a[i] *= w.aa;
  }
  if (ethd__filter_is_kalman(f)) ethd__filter_spread(f, s, w);
}

ETHD__FP_APART void ethd__filter_predict(const ethd_filter *f, ethd_filter_state *s, double dt) {
  s->age += dt;
  if (f->compensation == ETHD_COMPENSATION_NONE) advance(f, s, dt);
}

void ethd_filter_predict(const ethd_filter *filter, ethd_filter_state *state, double dt) {
  const uint64_t callers = ethd__fp_take();
  ethd__filter_predict(filter, state, dt);
  ethd__fp_give(callers);
}

static bool correct(const ethd_filter *f, ethd_filter_state *s, const sighting *seen, double elapsed) {
  ethd_vec r = {seen->x.x - s->x[0], seen->x.y - s->x[1]};
  if (ethd__filter_is_kalman(f)) return ethd__filter_correct(f, s, r, seen->noise);
  bool hold = f->method == ETHD_FILTER_HOLD;
  double alpha = hold ? 1 : f->p[ALPHA_BETA_ALPHA], beta = hold ? 0 : f->p[ALPHA_BETA_BETA];
  s->x[0] += alpha * r.x;
  s->x[1] += alpha * r.y;
  s->v[0] += beta * r.x / elapsed;
  s->v[1] += beta * r.y / elapsed;
  return true;
}

static ethd_status gated(const ethd_filter *f, ethd_filter_state *s, const sighting *seen) {
  s->gated++;
  if (++s->gated_in_a_row < ETHD_FILTER_GATED_MAX) return ETHD_STATUS_STALE;
  start_from(f, s, seen);
  s->restarts++;
  return ETHD_OK;
}

ETHD__FP_APART ethd_status ethd__filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x,
                                               double age, double noise) {
  if (!(noise > 0)) noise = ethd__filter_is_kalman(filter) ? filter->p[FILTER_NOISE] : 0;
  const sighting seen = {x, age, noise};
  if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(age)) {
    state->gated++;
    return ETHD_STATUS_STALE;
  }
  if (!state->started) {
    start_from(filter, state, &seen);
    return ETHD_OK;
  }
  double elapsed = state->age - age;
  if (!(elapsed > 0)) {
    state->late++;
    return ETHD_STATUS_STALE;
  }
  ethd_filter_state next = *state;
  if (filter->compensation == ETHD_COMPENSATION_STAMP) advance(filter, &next, elapsed);
  if (!correct(filter, &next, &seen, elapsed)) return gated(filter, state, &seen);
  next.age = age;
  next.used++;
  next.gated_in_a_row = 0;
  *state = next;
  return ETHD_OK;
}

ethd_status ethd_filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x, double age) {
  const uint64_t callers = ethd__fp_take();
  const ethd_status status = ethd__filter_update(filter, state, x, age, 0);
  ethd__fp_give(callers);
  return status;
}

ETHD__FP_APART void ethd__filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x,
                                        ethd_vec *v) {
  bool stamp = filter->compensation == ETHD_COMPENSATION_STAMP;
  double t = stamp ? state->age + filter->p[FILTER_LATENCY] : 0;
  ethd__filter_motion w = ethd__filter_motion_over(filter, t);
  const double *p = state->x, *q = state->v, *a = state->a;
  *x = (ethd_vec){p[0] + (q[0] * t + a[0] * w.ax), p[1] + (q[1] * t + a[1] * w.ax)};
  *v = (ethd_vec){q[0] + a[0] * w.av, q[1] + a[1] * w.av};
}

void ethd_filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x, ethd_vec *v) {
  const uint64_t callers = ethd__fp_take();
  ethd__filter_output(filter, state, x, v);
  ethd__fp_give(callers);
}
