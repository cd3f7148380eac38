/* The functions of the plane and of space share their code: `axes`, 2 or 3, is a constant where it is inlined. In the
   plane the third components stay 0. */
#include "ethd/estimate.h"

#include <math.h>
#include <string.h>

#include "estimate/filter_methods.h"
#include "fp_mode.h"

#define FOR_AXES static inline __attribute__((always_inline))

/* ---- start ---- */

/* The uncertainty of a filter's start: the variances of each axis. Only ca has an uncertain acceleration. */
typedef struct doubt {
  double x, v, a; /* m^2, m^2/s^2, m^2/s^4 */
} doubt;

static void begin(const ethd_filter *f, ethd_filter_state *s, ethd_vec3 x, ethd_vec3 v, doubt d) {
  double p[6] = {d.x, 0, 0, d.v, 0, f->method == ETHD_FILTER_CA ? d.a : 0};
  ethd_vec3_put(x, s->x);
  ethd_vec3_put(v, s->v);
  s->a[0] = s->a[1] = s->a[2] = 0;
  memcpy(s->cov, p, sizeof p);
  s->started = 1;
  s->gated_in_a_row = 0;
  s->acquired = 1;
}

void ethd_filter_start3(const ethd_filter *filter, ethd_filter_state *state, ethd_vec3 x, ethd_vec3 v) {
  begin(filter, state, x, v, (doubt){1e-6, 1e-4, 1}); /* sd 1 mm, 1 cm/s, 1 m/s^2: the start is known */
  state->age = filter->compensation == ETHD_COMPENSATION_STAMP ? -filter->p[FILTER_LATENCY] : INFINITY;
}

void ethd_filter_start(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x, ethd_vec v) {
  ethd_filter_start3(filter, state, (ethd_vec3){x.x, x.y, 0}, (ethd_vec3){v.x, v.y, 0});
}

/* Begins at a reading of known noise. Without a velocity the finger starts at rest, with a sd of 1 m/s; the sd of the
   acceleration is 10 m/s^2: a finger in full motion. */
static void start_from(const ethd_filter *f, ethd_filter_state *s, const ethd_filter_reading *seen) {
  const bool moves = seen->v_noise > 0 && ethd__filter_is_kalman(f);
  const doubt d = {seen->noise * seen->noise, moves ? seen->v_noise * seen->v_noise : 1, 100};
  begin(f, s, seen->x, moves ? seen->v : (ethd_vec3){0, 0, 0}, d);
  s->age = seen->age;
  s->used++;
}

/* ---- time passes ---- */

FOR_AXES void advance(const ethd_filter *f, ethd_filter_state *s, double t, int axes) {
  ethd__filter_motion w = ethd__filter_motion_over(f, t);
  for (int i = 0; i < axes; i++) {
    s->x[i] += s->v[i] * t + s->a[i] * w.ax;
    s->v[i] += s->a[i] * w.av;
    s->a[i] *= w.aa;
  }
  if (ethd__filter_is_kalman(f)) ethd__filter_spread(f, s, w);
}

ETHD__FP_APART void ethd__filter_predict(const ethd_filter *f, ethd_filter_state *s, double dt) {
  s->age += dt;
  if (f->compensation == ETHD_COMPENSATION_NONE) advance(f, s, dt, 3);
}

void ethd_filter_predict(const ethd_filter *filter, ethd_filter_state *state, double dt) {
  ETHD__FP_DO(ethd__filter_predict(filter, state, dt));
}

/* ---- readings ---- */

/* Gives the reading minus the prediction, and returns its squared length. */
FOR_AXES double innovation(const double expected[3], ethd_vec3 seen, double r[3], int axes) {
  r[0] = seen.x - expected[0];
  r[1] = seen.y - expected[1];
  r[2] = axes == 3 ? seen.z - expected[2] : 0;
  return axes == 3 ? r[0] * r[0] + r[1] * r[1] + r[2] * r[2] : r[0] * r[0] + r[1] * r[1];
}

FOR_AXES void move(ethd_filter_state *s, const double k[3], const double r[3], int axes) {
  for (int i = 0; i < axes; i++) {
    s->x[i] += k[0] * r[i];
    s->v[i] += k[1] * r[i];
    s->a[i] += k[2] * r[i];
  }
}

FOR_AXES bool correct_by_kalman(ethd_filter_state *s, const ethd_filter_reading *seen, double gate, int axes) {
  double k[3], r[3], square = innovation(s->x, seen->x, r, axes);
  if (!ethd__filter_gains(s, square, seen->noise, gate, k)) return false;
  move(s, k, r, axes);
  if (!(seen->v_noise > 0)) return true;
  square = innovation(s->v, seen->v, r, axes);
  if (!ethd__filter_v_gains(s, square, seen->v_noise, gate, k)) return false;
  move(s, k, r, axes);
  return true;
}

FOR_AXES bool correct(const ethd_filter *f, ethd_filter_state *s, const ethd_filter_reading *seen, double elapsed,
                      int axes) {
  if (ethd__filter_is_kalman(f)) {
    const bool acquires = axes == 3 && s->acquired < ETHD_FILTER_ACQUIRED;
    const double n = s->acquired, gate = f->p[FILTER_GATE];
    return correct_by_kalman(s, seen, acquires ? gate * (1 + 4 / (n * sqrt(n))) : gate, axes);
  }
  const bool hold = f->method == ETHD_FILTER_HOLD;
  const double alpha = hold ? 1 : f->p[ALPHA_BETA_ALPHA], beta = hold ? 0 : f->p[ALPHA_BETA_BETA];
  double r[3];
  innovation(s->x, seen->x, r, axes);
  for (int i = 0; i < axes; i++) {
    s->x[i] += alpha * r[i];
    s->v[i] += beta * r[i] / elapsed;
  }
  return true;
}

static ethd_status restart(const ethd_filter *f, ethd_filter_state *s, const ethd_filter_reading *seen) {
  start_from(f, s, seen);
  s->restarts++;
  return ETHD_OK;
}

static ethd_status gated(const ethd_filter *f, ethd_filter_state *s, const ethd_filter_reading *seen) {
  s->gated++;
  return ++s->gated_in_a_row < ETHD_FILTER_GATED_MAX ? ETHD_STATUS_STALE : restart(f, s, seen);
}

/* Processes a reading with possible numbers. If ages aren't compensated, the time from a known start to the first
   reading is unknown: then `elapsed` is infinite, and no loss counts. */
FOR_AXES ethd_status use(const ethd_filter *f, ethd_filter_state *s, const ethd_filter_reading *seen, int axes) {
  if (!s->started) {
    start_from(f, s, seen);
    return ETHD_OK;
  }
  double elapsed = s->age - seen->age;
  if (!(elapsed > 0)) {
    s->late++;
    return ETHD_STATUS_STALE;
  }
  if (axes == 3 && elapsed > ETHD_FILTER_LOSS && elapsed < INFINITY) return restart(f, s, seen);
  ethd_filter_state next = *s;
  if (f->compensation == ETHD_COMPENSATION_STAMP) advance(f, &next, elapsed, axes);
  if (!correct(f, &next, seen, elapsed, axes)) return gated(f, s, seen);
  next.age = seen->age;
  next.used++;
  next.gated_in_a_row = 0;
  if (axes == 3 && next.acquired < ETHD_FILTER_ACQUIRED) next.acquired++;
  *s = next;
  return ETHD_OK;
}

static double own_noise(const ethd_filter *f) { return ethd__filter_is_kalman(f) ? f->p[FILTER_NOISE] : 0; }

ETHD__FP_APART ethd_status ethd__filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x,
                                               double age, double noise) {
  if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(age)) {
    state->gated++;
    return ETHD_STATUS_STALE;
  }
  const ethd_filter_reading seen = {
      .x = {x.x, x.y, 0}, .age = age, .noise = noise > 0 ? noise : own_noise(filter), .v_noise = 0};
  return use(filter, state, &seen, 2);
}

ethd_status ethd_filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x, double age) {
  ETHD__FP_RETURN(ethd_status, ethd__filter_update(filter, state, x, age, 0));
}

/* Returns whether x, v, age and noises are possible numbers; unmeasured ones aren't checked. */
static bool is_possible(const ethd_filter_reading *r) {
  const bool moves = !(r->v_noise == 0);
  if (!(r->noise >= 0 && r->noise <= ETHD_FILTER_NOISE_MAX)) return false;
  if (moves && !(r->v_noise > 0 && r->v_noise <= ETHD_FILTER_V_NOISE_MAX)) return false;
  if (moves && !(isfinite(r->v.x) && isfinite(r->v.y) && isfinite(r->v.z))) return false;
  return isfinite(r->x.x) && isfinite(r->x.y) && isfinite(r->x.z) && (r->extrapolated || isfinite(r->age));
}

/* A reading that was extrapolated to now counts as one whose stamp is the latency ahead of now. */
ETHD__FP_APART static ethd_status update3(const ethd_filter *f, ethd_filter_state *s, const ethd_filter_reading *r) {
  if (!is_possible(r)) {
    s->gated++;
    return ETHD_STATUS_STALE;
  }
  ethd_filter_reading seen = *r;
  if (!(seen.noise > 0)) seen.noise = own_noise(f);
  if (seen.extrapolated) seen.age = f->compensation == ETHD_COMPENSATION_STAMP ? -f->p[FILTER_LATENCY] : 0;
  return use(f, s, &seen, 3);
}

ethd_status ethd_filter_update3(const ethd_filter *filter, ethd_filter_state *state,
                                const ethd_filter_reading *reading) {
  ETHD__FP_RETURN(ethd_status, update3(filter, state, reading));
}

/* ---- output ---- */

FOR_AXES void extrapolate(const ethd_filter *f, const ethd_filter_state *s, double x[3], double v[3], int axes) {
  const double t = f->compensation == ETHD_COMPENSATION_STAMP ? s->age + f->p[FILTER_LATENCY] : 0;
  const ethd__filter_motion w = ethd__filter_motion_over(f, t);
  for (int i = 0; i < axes; i++) {
    x[i] = s->x[i] + (s->v[i] * t + s->a[i] * w.ax);
    v[i] = s->v[i] + s->a[i] * w.av;
  }
}

ETHD__FP_APART void ethd__filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x,
                                        ethd_vec *v) {
  double at[3], speed[3];
  extrapolate(filter, state, at, speed, 2);
  *x = ethd_vec_of(at);
  *v = ethd_vec_of(speed);
}

void ethd_filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x, ethd_vec *v) {
  ETHD__FP_DO(ethd__filter_output(filter, state, x, v));
}

ETHD__FP_APART static void output3(const ethd_filter *f, const ethd_filter_state *s, ethd_vec3 *x, ethd_vec3 *v) {
  double at[3], speed[3];
  extrapolate(f, s, at, speed, 3);
  *x = ethd_vec3_of(at);
  *v = ethd_vec3_of(speed);
}

void ethd_filter_output3(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec3 *x, ethd_vec3 *v) {
  ETHD__FP_DO(output3(filter, state, x, v));
}
