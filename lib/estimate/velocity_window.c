/* Lines through the last samples: least squares and first-order adaptive windowing. */
#include <math.h>

#include "estimate/velocity_methods.h"

/* Sums over samples, each with its age t and its position y relative to the newest sample. So a large clock or position
   costs no accuracy, and the newest sample itself adds only to n. */
typedef struct slope_line {
  double n, t, tt, y, ty;
} slope_line;

static void line_add(slope_line *l, double t, double y) {
  l->n += 1;
  l->t += t;
  l->tt += t * t;
  l->y += y;
  l->ty += t * y;
}

/* Returns the slope over time. Ages run backwards, so the sign changes. */
static double line_slope(const slope_line *l) { return (l->t * l->y - l->n * l->ty) / (l->n * l->tt - l->t * l->t); }

static uint32_t samples(const ethd_velocity *v, const ethd_velocity_state *s) {
  return s->count < v->window ? s->count : v->window;
}

double ethd__velocity_lsq(const ethd_velocity *v, const ethd_velocity_state *s) {
  slope_line l = {.n = 1};
  double age = 0;
  for (uint32_t i = 1, n = samples(v, s); i < n; i++) {
    age += s->dt[ethd__velocity_back(s, i - 1)];
    line_add(&l, age, s->q[ethd__velocity_back(s, i)] - s->q[s->head]);
  }
  return line_slope(&l);
}

/* A line through the newest sample passes within `noise` of the sample at age t iff its slope lies in
   (rise -+ noise) / t. [low, high] are the slopes that all samples so far allow, so each sample is tested once. */
double ethd__velocity_foaw(const ethd_velocity *v, const ethd_velocity_state *s) {
  double noise = v->p[FOAW_NOISE];
  slope_line l = {.n = 1};
  double age = 0, low = -INFINITY, high = INFINITY;
  for (uint32_t i = 1, n = samples(v, s); i < n; i++) {
    age += s->dt[ethd__velocity_back(s, i - 1)];
    double rise = s->q[s->head] - s->q[ethd__velocity_back(s, i)];
    double slope = rise / age;
    if (!(slope >= low && slope <= high)) break;
    line_add(&l, age, -rise);
    low = fmax(low, (rise - noise) / age);
    high = fmin(high, (rise + noise) / age);
  }
  return line_slope(&l);
}
