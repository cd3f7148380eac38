#include "bench/scene_world.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "unit/draw.h"

const char *const ethd__world_names[ETHD__WORLDS] = {"random", "contour"};
const char *const ethd__ask_names[ETHD__ASKS] = {"incoherent", "warm", "horizon"};

/* ---- segments ---- */

static void random_segment(size_t i, size_t count, double s[4]) {
  uint64_t k = 8 * (uint64_t)i;
  double x = draw(k, -0.5, 0.5), y = draw(k + 1, -0.5, 0.5);
  double a = draw(k + 2, 0, 2 * M_PI), half = draw(k + 3, 0.1, 0.5) / sqrt((double)count);
  s[0] = x - half * cos(a), s[1] = y - half * sin(a);
  s[2] = x + half * cos(a), s[3] = y + half * sin(a);
}

static void outline(size_t i, size_t count, double p[2]) {
  double a = 2 * M_PI * (double)(i % count) / (double)count;
  double r = 0.2 * (1 + 0.3 * sin(3 * a) + 0.1 * sin(7 * a) + 0.02 * sin(31 * a));
  p[0] = r * cos(a);
  p[1] = r * sin(a);
}

void ethd__world_create(ethd__world_kind kind, size_t count, ethd__world *out) {
  *out = (ethd__world){kind, count, malloc(count * sizeof *out->segments)};
  if (!out->segments) ethd__fail(ETHD_EXIT_FAILED, "no memory for %zu segments", count);
  for (size_t i = 0; i < count; i++) {
    if (kind == ETHD__RANDOM) {
      random_segment(i, count, out->segments[i]);
    } else {
      outline(i, count < 3 ? 3 : count, out->segments[i]);
      outline(i + 1, count < 3 ? 3 : count, out->segments[i] + 2);
    }
  }
}

void ethd__world_destroy(ethd__world *world) { free(world->segments); }

/* ---- points ---- */

void ethd__world_path(ethd_vec *points) {
  for (int i = 0; i < BENCH_POINTS; i++) {
    double t = 1e-3 * i;
    points[i] = (ethd_vec){0.22 * sin(2 * M_PI * 0.43 * t + 0.3), 0.22 * sin(2 * M_PI * 0.571 * t)};
  }
}

void ethd__world_anywhere(ethd_vec *points) {
  for (uint64_t i = 0; i < BENCH_POINTS; i++)
    points[i] = (ethd_vec){draw(2 * i + 1000000007, -0.5, 0.5), draw(2 * i + 1000000008, -0.5, 0.5)};
}

/* ---- contenders ---- */

/* Returns the processor time of this process alone, s, so that other programs don't count. */
static double cpu_time(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ethd_scene *our_scene(const ethd__world *w, const ethd_object_def *objects, size_t count) {
  ethd_scene_def def = {objects, count, NULL, 0};
  ethd_scene *scene;
  ethd_error error;
  if (ethd_scene_create(&def, &scene, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "a scene of %zu segments: %s", w->count, ethd_status_sentence(error.status));
  return scene;
}

static double create_ours(ethd__scene_contender *c, const ethd__world *w) {
  size_t objects = c->chain ? 1 : w->count;
  ethd_object_def *defs = malloc(objects * sizeof *defs);
  double *points = malloc(2 * (w->count + 1) * sizeof *points);
  if (!defs || !points) ethd__fail(ETHD_EXIT_FAILED, "no memory for %zu segments", w->count);
  for (size_t i = 0; i < objects; i++) defs[i] = (ethd_object_def){ETHD_SHAPE_SEGMENT, -1, w->segments[i], 4, 0};
  if (c->chain) {
    for (size_t i = 0; i <= w->count; i++) {
      const double *p = i < w->count ? w->segments[i] : w->segments[w->count - 1] + 2;
      points[2 * i] = p[0];
      points[2 * i + 1] = p[1];
    }
    defs[0] = (ethd_object_def){ETHD_SHAPE_POLYLINE, -1, points, 2 * (w->count + 1), 0};
  }
  double start = cpu_time();
  c->self = our_scene(w, defs, objects);
  double seconds = cpu_time() - start;
  free(defs);
  free(points);
  return seconds;
}

double ethd__contender_create(ethd__scene_contender *c, const ethd__world *w) {
  c->hint = (ethd_scene_hint){0};
  c->clearance = -INFINITY;
  if (!c->peer) return create_ours(c, w);
  double start = cpu_time();
  c->self = c->peer->create((const double(*)[4])w->segments, w->count);
  return cpu_time() - start;
}

void ethd__contender_destroy(ethd__scene_contender *c) {
  if (c->peer)
    c->peer->destroy(c->self);
  else
    ethd_scene_destroy(c->self);
}

size_t ethd__contender_bytes(const ethd__scene_contender *c) {
  ethd_scene_info info;
  if (c->peer) return c->peer->bytes ? c->peer->bytes(c->self) : 0;
  ethd_scene_describe(c->self, &info);
  return info.bytes;
}

/* Asks as a controller does: nothing can be within the horizon until the ring has travelled the distance to it. */
static double ours_within(ethd__scene_contender *c, ethd_vec x) {
  ethd_vec way = ethd_vec_sub(x, c->asked);
  double left = c->clearance - BENCH_HORIZON;
  ethd_nearest nearest;
  if (left > 0 && ethd_vec_dot(way, way) < left * left) return INFINITY;
  ethd_scene_query_near(c->self, x, &c->hint, &nearest);
  c->asked = x;
  c->clearance = nearest.distance;
  return nearest.distance <= BENCH_HORIZON ? nearest.distance : INFINITY;
}

double ethd__contender_nearest(ethd__scene_contender *c, ethd__ask ask, ethd_vec x) {
  ethd_nearest nearest;
  double out[3];
  if (c->peer) {
    c->peer->nearest(c->self, &x.x, ask == ETHD__HORIZON ? BENCH_HORIZON : INFINITY, ask != ETHD__COLD, out);
    c->n = ethd_vec_scale(1 / out[0], ethd_vec_sub((ethd_vec){out[1], out[2]}, x));
    return out[0];
  }
  if (ask == ETHD__HORIZON) return ours_within(c, x);
  if (ask == ETHD__WARM)
    ethd_scene_query_near(c->self, x, &c->hint, &nearest);
  else
    ethd_scene_query(c->self, x, &nearest);
  return nearest.distance;
}
