#include "sim/path.h"

#include "denormals.h"
#include "ethd/maths.h"

#define PI 3.14159265358979323846
#define INSTANT 1e-12 /* s: a shorter movement is a jump */

static const ethd_vec ZERO = {0, 0};

static void hold(ethd_vec x, double begin, double end, ethd__piece *out) {
  *out = (ethd__piece){.begin = begin, .end = end, .a = x};
}

/* ---- synthetic, speed constant between ramps ---- */

/* Returns the time of constant speed. Ramps cover half of what the constant speed would in their time. A path
   that is too short for its ramps keeps its speed, and so ends beyond to_x. */
static double cruise_time(const ethd_path *path) {
  double length = fabs(path->to_x - path->from.x);
  return fmax(0, length / path->speed - (path->ramp_up + path->ramp_down) / 2);
}

/* Fills a ramp of the speed, V (1 - cos(w s))/2 with w duration = pi; a falling one is the mirror image, with s from
   its end. */
static void ramp(ethd_vec x, double velocity, double duration, double begin, double origin, ethd__piece *out) {
  hold(x, begin, begin + duration, out);
  out->origin = origin;
  out->w = PI / duration;
  out->b.x = velocity / 2;
  out->e.x = velocity / (2 * out->w);
}

static void constant_piece(const ethd_path *path, double t, ethd__piece *out) {
  double velocity = path->to_x < path->from.x ? -path->speed : path->speed;
  double cruise = path->ramp_up, brake = cruise + cruise_time(path), end = brake + path->ramp_down;
  ethd_vec x = path->from;
  if (t < 0) {
    hold(x, -INFINITY, 0, out);
    return;
  }
  if (t < cruise) {
    ramp(x, velocity, path->ramp_up, 0, 0, out);
    return;
  }
  x.x += velocity * path->ramp_up / 2;
  if (t < brake) {
    hold(x, cruise, brake, out);
    out->origin = cruise;
    out->b.x = velocity;
    return;
  }
  x.x += velocity * ((brake - cruise) + path->ramp_down / 2);
  if (t < end)
    ramp(x, velocity, path->ramp_down, brake, end, out);
  else
    hold(x, end, INFINITY, out);
}

/* ---- synthetic, minimum jerk ---- */

/* The speed is greatest halfway: 15/8 of the mean. */
static double jerk_time(const ethd_path *path) { return 1.875 * fabs(path->to_x - path->from.x) / path->speed; }

static void jerk_piece(const ethd_path *path, double t, ethd__piece *out) {
  double end = jerk_time(path), length = path->to_x - path->from.x, cube = end * end * end;
  if (t < 0) {
    hold(path->from, -INFINITY, 0, out);
  } else if (t >= end || end < INSTANT) {
    hold((ethd_vec){path->to_x, path->from.y}, end < INSTANT ? 0 : end, INFINITY, out);
  } else {
    hold(path->from, 0, end, out);
    out->d.x = 10 * length / cube;
    out->f = -15 * length / (cube * end);
    out->g = 6 * length / (cube * end * end);
  }
}

/* ---- recorded ---- */

static ethd_vec place(const ethd_path_sample *s) { return (ethd_vec){s->x, s->y}; }

static ethd_vec slope(const ethd_path_sample *s) {
  return ethd_vec_scale(1 / (s[1].t - s[0].t), ethd_vec_sub(place(s + 1), place(s)));
}

/* Returns the slope at sample i of the parabola through it and its neighbours (Catmull-Rom if they are evenly spaced);
   0 at both ends, where the path is held. */
static ethd_vec tangent(const ethd_path *path, size_t i) {
  if (i == 0 || i + 1 == path->sample_count) return ZERO;
  const ethd_path_sample *s = path->samples + i;
  double before = s[0].t - s[-1].t, after = s[1].t - s[0].t, whole = before + after;
  return ethd_vec_add(ethd_vec_scale(after / whole, slope(s - 1)), ethd_vec_scale(before / whole, slope(s)));
}

/* Finds the last sample at or before t. */
static size_t find(const ethd_path *path, double t) {
  size_t low = 0, high = path->sample_count;
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (path->samples[middle].t <= t)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Fills Hermite's cubic: c = (3 m - 2 g0 - g1)/h, d = (g0 + g1 - 2 m)/h^2, with mean slope m and end slopes g. */
static void recorded_piece(const ethd_path *path, double t, ethd__piece *out) {
  const ethd_path_sample *first = path->samples, *last = first + path->sample_count - 1;
  if (t < first->t) {
    hold(place(first), -INFINITY, first->t, out);
    return;
  }
  if (t >= last->t) {
    hold(place(last), last->t, INFINITY, out);
    return;
  }
  size_t i = find(path, t);
  const ethd_path_sample *s = first + i;
  double h = s[1].t - s[0].t;
  ethd_vec g0 = tangent(path, i), g1 = tangent(path, i + 1), m = slope(s);
  hold(place(s), s[0].t, s[1].t, out);
  out->origin = s[0].t;
  out->b = g0;
  out->c = (ethd_vec){(3 * m.x - 2 * g0.x - g1.x) / h, (3 * m.y - 2 * g0.y - g1.y) / h};
  out->d = (ethd_vec){(g0.x + g1.x - 2 * m.x) / (h * h), (g0.y + g1.y - 2 * m.y) / (h * h)};
}

/* ---- all ---- */

void ethd__path_piece(const ethd_path *path, double t, ethd__piece *out) {
  if (path->sample_count)
    recorded_piece(path, t, out);
  else if (path->profile == ETHD_PROFILE_MINIMUM_JERK)
    jerk_piece(path, t, out);
  else
    constant_piece(path, t, out);
}

ethd__sim_motion ethd__piece_at(const ethd__piece *p, double t) {
  double s = t - p->origin;
  ethd__sim_motion m;
  m.s = s;
  m.x.x = p->a.x + s * (p->b.x + s * (p->c.x + s * (p->d.x + s * (p->f + s * p->g))));
  m.x.y = p->a.y + s * (p->b.y + s * (p->c.y + s * p->d.y));
  m.v.x = p->b.x + s * (2 * p->c.x + s * (3 * p->d.x + s * (4 * p->f + s * (5 * p->g))));
  m.v.y = p->b.y + s * (2 * p->c.y + s * (3 * p->d.y));
  m.a.x = 2 * p->c.x + s * (6 * p->d.x + s * (12 * p->f + s * (20 * p->g)));
  m.a.y = 2 * p->c.y + s * (6 * p->d.y);
  if (p->w == 0) return m;
  double sine, cosine;
  ethd_sincos(p->w * s, &sine, &cosine);
  m.x.x -= p->e.x * sine;
  m.v.x -= p->w * p->e.x * cosine;
  m.a.x += p->w * p->w * p->e.x * sine;
  return m;
}

void ethd__piece_terms(const ethd__piece *p, const ethd__sim_motion *at, ethd__two out[ETHD__PATH_TERMS]) {
  double w2 = p->w * p->w, s = at->s;
  out[0] = (ethd__two){at->x.x, at->x.y};
  out[1] = (ethd__two){at->v.x, at->v.y};
  out[2] = (ethd__two){at->a.x, at->a.y} / 2;
  out[3] =
      (ethd__two){p->d.x + s * (4 * p->f + s * (10 * p->g)), p->d.y} - w2 / 6 * (out[1] - (ethd__two){p->b.x, p->b.y});
  out[4] = (ethd__two){p->f + s * (5 * p->g), 0} - w2 * (1.0 / 12) * out[2];
  out[5] = (ethd__two){p->g, 0} - w2 * (1.0 / 20) * out[3];
}

double ethd__piece_travel(const ethd__piece *p, const ethd__sim_motion *at, double h) {
  double v = fabs(at->v.x) + fabs(at->v.y), a = fabs(at->a.x) + fabs(at->a.y), s = at->s;
  double d = fabs(p->d.x + s * (4 * p->f + s * (10 * p->g))) + fabs(p->d.y), f = fabs(p->f + s * (5 * p->g));
  if (p->w != 0) a = (fabs(p->e.x) + fabs(p->e.y)) * p->w * p->w;
  return h * (v + h * (a / 2 + h * (d + h * (f + h * fabs(p->g)))));
}

__attribute__((noinline)) static void path_at(const ethd_path *path, double t, ethd_vec *x, ethd_vec *v) {
  ethd__piece piece;
  ethd__path_piece(path, t, &piece);
  ethd__sim_motion m = ethd__piece_at(&piece, t);
  *x = m.x;
  *v = m.v;
}

void ethd_path_at(const ethd_path *path, double t, ethd_vec *x, ethd_vec *v) {
  uint64_t before = ethd__traps_hold();
  path_at(path, t, x, v);
  ethd__denormals_restore(before);
}

__attribute__((noinline)) static double path_end(const ethd_path *path) {
  if (path->sample_count) return path->samples[path->sample_count - 1].t;
  if (path->profile == ETHD_PROFILE_MINIMUM_JERK) return jerk_time(path);
  return path->ramp_up + cruise_time(path) + path->ramp_down;
}

double ethd_path_end(const ethd_path *path) {
  uint64_t before = ethd__traps_hold();
  double end = path_end(path);
  ethd__denormals_restore(before);
  return end;
}
