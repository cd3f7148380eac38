/* Memory that runs out at any allocation; a control thread that asks for none, takes no lock, writes
   nothing. Both by standing in the way of the C library. */
#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/cell.h"
#include "ethd/config.h"
#include "ethd/solids.h"
#include "unit/rig.h"
#include "unit/suite.h"

void forbid(const char *what);
#define SCARCE_MEMORY_SEES(function) forbid(function)
#include "unit/scarce_memory.h"

#ifdef SCARCE_MEMORY_SKIPPED
int main(void) {
  puts("SKIP: a sanitizer's build has an allocator of its own");
  return 77;
}
#else

/* ---- in the way ---- */

static volatile int in_step; /* a control thread is stepping */
void forbid(const char *what) {
  if (!in_step) return;
  in_step = 0;
  (void)!write(2, what, strlen(what));
  abort();
}

ETHD_API int pthread_mutex_lock(pthread_mutex_t *mutex) {
  static __typeof__(&pthread_mutex_lock) real;
  forbid("pthread_mutex_lock");
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "pthread_mutex_lock");
  return real(mutex);
}

ETHD_API ssize_t write(int fd, const void *bytes, size_t n) {
  static __typeof__(&write) real;
  forbid("write");
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "write");
  return real(fd, bytes, n);
}

/* ---- the n-th allocation fails ---- */

static const char scene_text[] =
    "material soft k_e=500\nhalfplane -1 0 -0.238 material=soft\ncircle 0.2 0.2 0.01\n"
    "polygon 0 0 0.6 0 0.6 0.238 0.238 0.238 0.238 0.6 0 0.6\npolyline 0 0 1 1 2 0\nsegment 0 0 1 0\ncircle 9 9 1\n";

static int well_said; /* a failure leaves its output empty and names its status */

/* Makes the object, destroys it, and returns what making it said. */
#define RETURN_MADE(object, destroy, call)                     \
  do {                                                         \
    ethd_error error;                                          \
    const ethd_status status_ = call;                          \
    if (status_ == ETHD_OK)                                    \
      destroy(object);                                         \
    else                                                       \
      well_said = (object) == NULL && error.status == status_; \
    return status_;                                            \
  } while (0)

static ethd_status make_controller(void) {
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  RETURN_MADE(control, ethd_control_destroy, ethd_control_create(&setup, &control, &error));
}

static ethd_status make_cell(void) {
  ethd_cell *cell;
  RETURN_MADE(cell, ethd_cell_destroy, ethd_cell_create(100, &cell, &error));
}

static ethd_status parse_scene(void) {
  ethd_scene *scene;
  RETURN_MADE(scene, ethd_scene_destroy, ethd_scene_parse(scene_text, strlen(scene_text), &scene, &error));
}

static ethd_status parse_solids(void) {
  static const char text[] = "material soft k_e=500\nhalfspace 0 0 -1 0 material=soft\nbox 0 0 0 1 1 1\n";
  ethd_solids *solids;
  RETURN_MADE(solids, ethd_solids_destroy, ethd_solids_parse(text, sizeof text - 1, &solids, &error));
}

static ethd_status make_scene(void) {
  const double wall[] = {-1, 0, -0.238}, shape[] = {0, 0, 1, 0, 1, 1};
  const ethd_object_def objects[] = {{ETHD_SHAPE_HALFPLANE, -1, wall, 3, 0}, {ETHD_SHAPE_POLYGON, -1, shape, 6, 0}};
  const ethd_scene_def def = {objects, 2, NULL, 0};
  ethd_scene *scene;
  RETURN_MADE(scene, ethd_scene_destroy, ethd_scene_create(&def, &scene, &error));
}

static ethd_status prune_scene(void) {
  static ethd_scene *whole;
  const ethd_arm arm = {ETHD_ARM_PARALLEL, 0.1, 0.1};
  ethd_scene *scene;
  if (!whole) whole = rig_scene("circle 0.1 0 0.01\ncircle 9 0 0.01\npolyline 0 0 1 0 1 1 2 1 2 2 3 3\n");
  RETURN_MADE(scene, ethd_scene_destroy, ethd_scene_prune(whole, &arm, 0.02, &scene, &error));
}

static char ini[64];

static ethd_status load_config(void) {
  ethd_config *config;
  char message[ETHD_MESSAGE_MAX];
  ethd_status status = ethd_config_load(ini, &config, message);
  if (status == ETHD_OK)
    ethd_config_free(config);
  else
    well_said = strlen(message) > 0;
  return status;
}

static void write_files(void) {
  char scene[80];
  snprintf(ini, sizeof ini, "/tmp/ethd-hygiene-%ld.ini", (long)getpid());
  snprintf(scene, sizeof scene, "%s.scene", ini);
  FILE *f = fopen(ini, "w");
  fprintf(f, "[transition]\nlaw = smooth\nbeta_min = 0.2\n[scene]\nfile = %s\n", scene);
  fclose(f);
  f = fopen(scene, "w");
  fputs(scene_text, f);
  fclose(f);
}

static void remove_files(void) {
  char scene[80];
  snprintf(scene, sizeof scene, "%s.scene", ini);
  unlink(ini);
  unlink(scene);
}

/* Each says that there is no memory, once for each allocation it makes, and keeps nothing. */
TEST_LOOP(test_memory_runs_out, 0, 7) {
  ethd_status (*const makers[])(void) = {make_controller, parse_scene, parse_solids, make_scene,
                                         prune_scene,     load_config, make_cell};
  write_files();
  ck_assert_int_eq(makers[_i](), ETHD_OK); /* what the C library keeps for itself is there now */
  int failures = 0;
  for (;; failures++) {
    live = 0;
    counting = 1;
    allowed = failures;
    ethd_status status = makers[_i]();
    allowed = -1;
    counting = 0;
    if (status == ETHD_OK) break;
    int fine = status == ETHD_E_MEMORY || (makers[_i] == load_config && status == ETHD_E_FILE);
    if (!fine || !well_said) ck_abort_msg("allocation %d: %s", failures, ethd_status_sentence(status));
    if (live != 0) ck_abort_msg("allocation %d fails: %d blocks are left", failures, live);
    ck_assert_int_lt(failures, 1000);
  }
  remove_files();
  ck_assert_int_eq(live, 0);
  ck_assert_int_ge(failures, 1);
}

/* ---- the control thread ---- */

static void step_guarded(rig *r, const ethd_sense *sense, int tick) {
  ethd_command command;
  ethd_counters counters;
  in_step = 1;
  (void)!ethd_control_step(r->control, sense, &command, tick % 2 ? &r->trace : NULL);
  if (tick % 5 == 0) (void)!ethd_control_rehearse(r->control, sense, &command);
  if (tick % 7 == 0) ethd_control_acknowledge(r->control);
  if (tick % 11 == 0) ethd_control_counters(r->control, &counters);
  in_step = 0;
}

/* An outline of many edges that the ring meets. */
static ethd_scene *large_scene(void) {
  enum { EDGES = 100000 };
  double *p = malloc(2 * EDGES * sizeof *p);
  ethd_object_def o = {ETHD_SHAPE_POLYLINE, -1, p, 2 * EDGES, 0};
  ethd_scene_def def = {&o, 1, NULL, 0};
  ethd_scene *scene;
  for (int i = 0; i < EDGES; i++) {
    double a = 6.283 * i / EDGES;
    p[2 * i] = 0.298 + 0.06 * cos(a);
    p[2 * i + 1] = 0.25 + 0.06 * sin(a);
  }
  ck_assert_int_eq(ethd_scene_create(&def, &scene, NULL), ETHD_OK);
  free(p);
  return scene;
}

/* Every law, estimator and filter; posts, scenes, faults, events. */
TEST(test_a_tap) {
  const ethd_transition_law *const laws[] = {&ethd_transition_abrupt, &ethd_transition_smooth, &ethd_transition_offset};
  const ethd_contact_law *const contacts[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                              &ethd_contact_hunt_crossley};
  rig r;
  int faults = 0, taken = 0;
  rig_open(&r, NULL);
  ethd_scene *scenes[] = {
      rig_scene("halfplane -1 0 -0.238\nsegment 0.2 0.1 0.2 0.4\n"),
      rig_scene("polyline 0.2 0.1 0.239 0.25 0.2 0.4\ncircle 0.2 0.3 0.02\nbox 0.3 0.2 0.01 0.01 0.3\n"),
      large_scene()};
  rig_start(&r);
  for (int tick = 0; tick < 4000; tick++) {
    double d = 0.004 - 0.008 * ((tick % 100) / 100.0);
    motion m = rig_at(d, 0.1, 0.001);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.time_ns = 1000000 * (int64_t)tick;
    s.sample_ns = s.time_ns - 1500000;
    s.have = tick % 4 == 0 ? s.have : tick % 4 == 1 ? ETHD_HAVE_CENTRE : tick % 4 == 2 ? ETHD_HAVE_RAYS : 0;
    for (int i = 0; i < 16; i++) s.rays[i] = 0.0045;
    if (tick % 333 == 0) s.q[0] = 0.0 / (double)(tick == -1);
    if (tick % 9 == 0) {
      int n = tick / 9;
      ethd_setup_transition(&r.setup, laws[n % 3]);
      ethd_setup_contact(&r.setup, contacts[n / 3 % 3]);
      ethd_setup_velocity(&r.setup, (ethd_velocity_method)(n % ETHD_VELOCITY_COUNT));
      ethd_setup_filter(&r.setup, (ethd_filter_method)(n % ETHD_FILTER_COUNT));
      ethd_setup_fit(&r.setup, (ethd_fit_method)(n % ETHD_FIT_COUNT));
      r.setup.scene = scenes[n % 3];
      rig_post(&r);
    }
    step_guarded(&r, &s, tick);
    for (ethd_event e; (e = rig_poll(&r)).kind != 0;)
      faults += e.kind == ETHD_EVENT_FAULT, taken += e.kind == ETHD_EVENT_TAKEN;
  }
  ck_assert_int_ge(faults, 10);
  ck_assert_int_ge(taken, 400);
  rig_close(&r);
  for (int i = 0; i < 3; i++) ethd_scene_destroy(scenes[i]);
}

/* The traps work: each call must abort. */
TEST_SIGNAL(test_traps, 0, 7, SIGABRT) {
  static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  void *volatile block = malloc(8);
  in_step = 1;
  if (_i == 0) block = malloc(8);
  if (_i == 1) free(block);
  if (_i == 2) block = calloc(1, 8);
  if (_i == 3) block = realloc(block, 16);
  if (_i == 4) pthread_mutex_lock(&mutex);
  if (_i == 5) (void)!write(2, "", 0);
  if (_i == 6) block = aligned_alloc(64, 64);
}
#endif
