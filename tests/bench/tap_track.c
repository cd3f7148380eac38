#include "bench/tap_track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "unit/draw.h"

#define WALL 0.238   /* m */
#define AHEAD 0.002  /* s: lag of the ring behind the finger */
#define LATENCY 2e-3 /* s */
#define NOISE 0.1e-3 /* m, of a reading or a ray */
#define RATE 300.0   /* Hz */

typedef struct path_place {
  ethd_vec ring, finger, v;
} path_place;

static path_place at(double t) {
  double w = 2 * M_PI / (1e-3 * ETHD__TAP_TICKS), a = 0.022;
  path_place p = {
      {0.27 + a * cos(w * t), 0.25 + 0.01 * sin(3 * w * t)}, {0, 0}, {-a * w * sin(w * t), 0.03 * w * cos(3 * w * t)}};
  p.finger = ethd_vec_add(p.ring, ethd_vec_scale(AHEAD, p.v));
  return p;
}

static void put(double to[2], ethd_vec from) {
  to[0] = from.x;
  to[1] = from.y;
}

static void add_reading(const ethd_setup *setup, ethd__tap_finger how, uint64_t i, double sampled, ethd_sense *s) {
  path_place then = at(sampled);
  ethd_vec relative = ethd_vec_sub(then.finger, then.ring);
  s->sample_ns = (int64_t)rint(1e9 * sampled);
  if (how == ETHD__TAP_CENTRE) {
    s->have |= ETHD_HAVE_CENTRE;
    put(s->centre, relative);
    for (uint64_t k = 0; k < 2; k++) s->centre[k] += NOISE * draw_normal(16 * i + k);
  } else {
    s->have |= ETHD_HAVE_RAYS;
    ethd_fit_rays(setup->ring_radius, setup->finger_radius, relative, s->rays);
    for (uint64_t k = 0; k < ETHD_RAYS; k++) s->rays[k] += NOISE * draw_normal(16 * i + k);
  }
}

void ethd__tap_senses(const ethd_setup *setup, ethd__tap_finger how, ethd_sense senses[ETHD__TAP_TICKS]) {
  double next = -LATENCY;
  for (int k = 0; k < ETHD__TAP_TICKS; k++) {
    ethd_sense *s = &senses[k];
    path_place p = at(1e-3 * k);
    ethd_pose pose;
    memset(s, 0, sizeof *s);
    s->time_ns = 1000000 * (int64_t)k;
    if (ethd_arm_angles(&setup->arm, p.ring, -1, s->q) < 0)
      ethd__fail(ETHD_EXIT_FAILED, "the scripted tap leaves the arm's reach");
    if (how == ETHD__TAP_KNOWN) {
      ethd_arm_pose(&setup->arm, s->q, &pose);
      put(s->dq, ethd_mat_mul(pose.j_inv, p.v));
      s->have |= ETHD_HAVE_DQ;
    }
    if (how <= ETHD__TAP_ENCODER) {
      s->have |= ETHD_HAVE_FINGER;
      put(s->finger, p.finger);
      put(s->finger_v, p.v);
    } else if (next + LATENCY <= 1e-3 * k) {
      add_reading(setup, how, (uint64_t)k, next, s);
      next += 1 / RATE;
    }
  }
}

static void outline(ethd__tap_wall wall, size_t n, double *points) {
  double wave = wall == ETHD__TAP_OUTLINE ? 0.5e-3 : 4e-3;
  double middle = wall == ETHD__TAP_OUTLINE ? WALL + 0.06 : WALL + 0.042;
  for (size_t i = 0; i < n; i++) {
    double a = 2 * M_PI * (double)i / (double)n, r = 0.06 + wave * (cos(17 * a) + 1);
    points[2 * i] = middle + r * cos(a);
    points[2 * i + 1] = 0.25 + r * sin(a);
  }
}

ethd_scene *ethd__tap_scene(ethd__tap_wall wall, size_t segments) {
  static const double plane[3] = {-1, 0, -WALL};
  double *points = malloc((2 * segments + 1) * sizeof *points);
  if (!points) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  outline(wall, segments, points);
  const ethd_object_def objects[] = {{ETHD_SHAPE_HALFPLANE, -1, plane, 3, 0},
                                     {ETHD_SHAPE_POLYLINE, -1, points, 2 * segments, 0}};
  const size_t first = wall == ETHD__TAP_OUTLINE, last = wall == ETHD__TAP_PLANE ? 1 : 2;
  ethd_scene_def def = {objects + first, last - first, NULL, 0};
  ethd_error error;
  ethd_scene *scene = NULL;
  if (wall != ETHD__TAP_NOTHING && ethd_scene_create(&def, &scene, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "scene: %s", ethd_status_sentence(error.status));
  free(points);
  return scene;
}

/* A law that looks ahead is told of plant n, or it would be offset. */
static void tell(ethd_setup *setup) {
  setup->dynamics = (ethd_dynamics){{0.1173, 0.25}, 0.398, 1.267, 0.071e-3};
  setup->limits.torque = 1.34;
}

ethd_control *ethd__tap_control(const ethd_transition_law *law, const ethd_scene *scene) {
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ethd_error error;
  ethd_setup_transition(&setup, law);
  if (ETHD_LAW_HAS(law, range)) tell(&setup);
  setup.scene = scene;
  if (ethd_control_create(&setup, &control, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  return control;
}
