/* The whole tick, hot: a tap played again and again through the step, recording included. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "common/cli.h"
#include "ethd/ethd.h"

#define TICKS 2048

typedef struct work {
  const char *scene_name;
  ethd_scene *scene;
  ethd_sense senses[TICKS];
  ethd_trace traces[TICKS]; /* the record of the run */
} work;

/* A finger that taps at x = 0.238 and comes back, the ring 2 ms behind. */
static void script(const ethd_setup *setup, ethd_sense *senses) {
  for (int k = 0; k < TICKS; k++) {
    double phase = 2 * 3.141592653589793 * k / TICKS, t = 0.002;
    ethd_vec ring = {0.27 + 0.022 * cos(phase), 0.25 + 0.01 * sin(3 * phase)};
    double speed = -0.022 * sin(phase) * 2 * 3.141592653589793 / (TICKS * 0.001);
    ethd_sense *s = &senses[k];
    memset(s, 0, sizeof *s);
    s->have = ETHD_HAVE_FINGER;
    s->finger[0] = ring.x + t * speed;
    s->finger[1] = ring.y;
    s->finger_v[0] = speed;
    if (ethd_arm_angles(&setup->arm, ring, -1, s->q) < 0)
      ethd__fail(ETHD_EXIT_FAILED, "the scripted tap leaves the arm's reach");
  }
}

/* A wall on the left, and a wavy outline around the workspace of `segments` edges. */
static ethd_scene *make_scene(size_t segments) {
  ethd_object_def objects[2];
  const double wall[3] = {-1, 0, -0.238};
  double *outline = malloc((2 * segments + 2) * sizeof *outline);
  ethd_error error;
  ethd_scene *scene;
  if (!outline) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  for (size_t i = 0; i <= segments; i++) {
    double a = 6.283185307179586 * (double)i / (double)segments, r = 0.06 + 0.004 * sin(17 * a);
    outline[2 * i] = 0.28 + r * cos(a);
    outline[2 * i + 1] = 0.25 + r * sin(a);
  }
  objects[0] = (ethd_object_def){ETHD_HALFPLANE, -1, wall, 3, 0};
  objects[1] = (ethd_object_def){ETHD_POLYLINE, -1, outline, 2 * segments + 2, 0};
  ethd_scene_def def = {objects, segments ? 2 : 1, NULL, 0};
  if (ethd_scene_create(&def, &scene, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "scene: %s", ethd_status_sentence(error.status));
  free(outline);
  return scene;
}

static ethd_control *make_control(const ethd_transition_law *law, const ethd_scene *scene) {
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ethd_error error;
  ethd_setup_transition(&setup, law);
  setup.scene = scene;
  if (ethd_control_create(&setup, &control, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  return control;
}

static void step(ethd_control *control, work *w, int k) {
  ethd_command command;
  if (ethd_control_step(control, &w->senses[k], &command, &w->traces[k]) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "tick %d is at fault", k);
}

/* Mean without a clock in the loop; percentiles from steps timed one by one, the clock's cost taken off. */
static ethd__bench_times measure(ethd_control *control, work *w, int rounds) {
  double *ns = malloc((size_t)(rounds * TICKS) * sizeof *ns);
  if (!ns) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  double cost = ethd__bench_clock_cost();
  for (int k = 0; k < TICKS; k++) step(control, w, k);
  int64_t start = ethd__bench_now();
  for (int r = 0; r < rounds; r++)
    for (int k = 0; k < TICKS; k++) step(control, w, k);
  double mean = (double)(ethd__bench_now() - start) / (rounds * TICKS);
  for (int i = 0; i < rounds * TICKS; i++) {
    int64_t a = ethd__bench_now();
    step(control, w, i % TICKS);
    ns[i] = fmax(0, (double)(ethd__bench_now() - a) - cost);
  }
  ethd__bench_times t = ethd__bench_percentiles(ns, (size_t)(rounds * TICKS));
  t.mean = mean;
  free(ns);
  return t;
}

static int run(const char *folder, int quick) {
  static const ethd_transition_law *const laws[] = {&ethd_transition_abrupt, &ethd_transition_smooth,
                                                    &ethd_transition_offset};
  static const struct {
    const char *name;
    long segments; /* -1: no scene */
  } scenes[] = {{"none", -1}, {"wall", 0}, {"100", 100}, {"1000", 1000}};
  static work w;
  ethd_setup setup = ethd_setup_default();
  script(&setup, w.senses);
  FILE *csv = ethd__bench_csv(folder, "tick", "", "law,scene,mean_ns,median_ns,p99_ns,p999_ns,max_ns");
  printf("the whole tick, hot, ns; scene: none, a wall, a wall and an outline of 100 or 1000 segments\n");
  printf("%-8s %-6s %8s %8s %8s %8s %10s\n", "law", "scene", "mean", "median", "p99", "p99.9", "max");
  for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
    ethd_scene *scene = scenes[s].segments < 0 ? NULL : make_scene((size_t)scenes[s].segments);
    for (size_t l = 0; l < 3; l++) {
      ethd_control *control = make_control(laws[l], scene);
      ethd__bench_times t = measure(control, &w, quick ? 20 : 200);
      printf("%-8s %-6s %8.0f %8.0f %8.0f %8.0f %10.0f\n", laws[l]->law.id, scenes[s].name, t.mean,
             t.median, t.p99, t.p999, t.max);
      fprintf(csv, "%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g\n", laws[l]->law.id, scenes[s].name, t.mean,
              t.median, t.p99, t.p999, t.max);
      ethd_control_destroy(control);
    }
    ethd_scene_destroy(scene);
  }
  return fclose(csv) == 0 ? ETHD_EXIT_DONE : ETHD_EXIT_FAILED;
}

const ethd__bench ethd__bench_tick = {"tick", "the whole tick, by law and scene", run};
