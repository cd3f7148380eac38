/* What moves, and what is skipped. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "unit/moody.h"

#define NOISE 1e-12

/* A half-plane in its own frame: the object is at x < 0. */
#define FRAME_WALL "halfplane -1 0 0\n"

static void open_with_body(rig *r, const char *scene, const char *body) {
  rig_open(r, scene);
  r->setup.bodies[0] = rig_scene(body);
  ethd_setup_transition(&r->setup, &ethd_transition_smooth);
  rig_start(r);
}

static void close_with_body(rig *r) {
  ethd_scene *body = (ethd_scene *)r->setup.bodies[0];
  rig_close(r);
  ethd_scene_destroy(body);
}

/* One tick with a pose of the first body, NULL: none. */
static void step_with_pose(rig *r, const motion *m, const double *pose) {
  ethd_sense s = rig_sense(&r->setup.arm, m);
  if (pose) {
    s.have |= ETHD_HAVE_BODY;
    memcpy(s.bodies, pose, 6 * sizeof *pose);
  }
  ck_assert_int_eq(rig_try(r, &s), ETHD_OK);
}

static motion resting(double x) {
  motion m = {{x, 0.25}, {0, 0}, {x, 0.25}, {0, 0}};
  return m;
}

/* F = (K_e d - B_e v) n with v = n.(V_r - V_s): 1 mm deep, met at 0.1 m/s: 2.5 + 4.5 N. */
TEST(test_moving_wall_pushes) {
  rig r;
  open_with_body(&r, NULL, FRAME_WALL);
  motion m = resting(0.25);
  const double pose[6] = {0.239, 0.7, 0, 0.1, 0, 0};
  step_with_pose(&r, &m, pose);
  ck_assert_double_eq_tol(r.trace.d_re, -0.001, NOISE);
  ck_assert_double_eq_tol(r.trace.v_n, 0.1, NOISE);
  ck_assert_double_eq_tol(r.trace.fe[0], 7, 1e-9);
  ck_assert(r.trace.body == 1 && r.trace.object == 0 && r.trace.state == ETHD_VO);
  const double leaving[6] = {0.239, 0.7, 0, -0.1, 0, 0};
  step_with_pose(&r, &m, leaving);
  ck_assert_double_eq_tol(r.trace.fe[0], 2.5, 1e-9);
  close_with_body(&r);
}

/* A wall that turns about a point 0.2 m below the ring at 2 rad/s meets it at 0.4 m/s. */
TEST(test_turning_wall) {
  rig r;
  open_with_body(&r, NULL, FRAME_WALL);
  motion m = resting(0.25);
  const double pose[6] = {0.237, 0.05, 0, 0, 0, -2};
  step_with_pose(&r, &m, pose);
  ck_assert_double_eq_tol(r.trace.d_re, 0.001, NOISE);
  ck_assert_double_eq_tol(r.trace.v_n, 0.4, NOISE);
  close_with_body(&r);
}

static double draw(uint64_t *seed) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) / 9007199254740992.0;
}

/* A body at a pose is the same as a scene drawn there. */
TEST(test_same_as_drawn_there) {
  uint64_t seed = 1;
  int touched = 0;
  for (int i = 0; i < 300; i++) {
    rig r, still;
    char text[200];
    double a = 6.28 * draw(&seed), x = 0.25 + 0.04 * (draw(&seed) - 0.5), y = 0.25 + 0.04 * (draw(&seed) - 0.5);
    double c = cos(a), s = sin(a);
    snprintf(text, sizeof text, "capsule %.17g %.17g %.17g %.17g 0.004\n", x - 0.01 * c, y - 0.01 * s, x + 0.03 * c,
             y + 0.03 * s);
    open_with_body(&r, NULL, "capsule -0.01 0 0.03 0 0.004\n");
    rig_begin(&still, text, &ethd_transition_smooth);
    motion m = {{0.25, 0.25}, {0.1, -0.2}, {0.251, 0.249}, {0.1, -0.2}};
    const double pose[6] = {x, y, a, 0, 0, 0};
    step_with_pose(&r, &m, pose);
    rig_step(&still, &m);
    ck_assert_int_eq(r.trace.contacts, still.trace.contacts);
    for (int k = 0; k < 2; k++) {
      ck_assert_double_eq_tol(r.trace.tau[k], still.trace.tau[k], 1e-9);
      ck_assert_double_eq_tol(r.trace.fe[k], still.trace.fe[k], 1e-9);
    }
    touched += r.trace.state == ETHD_VO;
    close_with_body(&r);
    rig_close(&still);
  }
  ck_assert_int_gt(touched, 50);
}

TEST(test_pose_holds) {
  rig r;
  open_with_body(&r, NULL, FRAME_WALL);
  motion m = resting(0.25);
  const double pose[6] = {0.239, 0, 0, 0, 0, 0};
  step_with_pose(&r, &m, NULL);
  ck_assert(r.trace.contacts == 0 && r.trace.queried == 0); /* not there yet */
  step_with_pose(&r, &m, pose);
  ck_assert_int_eq(r.trace.contacts, 1);
  step_with_pose(&r, &m, NULL);
  ck_assert_int_eq(r.trace.contacts, 1);
  ck_assert_double_eq_tol(r.trace.d_re, -0.001, NOISE);
  const double bad[6] = {0, 0, 0, 0, 0, NAN};
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  s.have |= ETHD_HAVE_BODY;
  memcpy(s.bodies, bad, sizeof bad);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_NOT_FINITE);
  close_with_body(&r);
}

/* A body that comes to a resting ring is seen in time, though the scene was skipped before. */
TEST(test_body_comes) {
  rig r;
  open_with_body(&r, RIG_WALL, FRAME_WALL);
  motion m = resting(0.30);
  int queries = 0;
  for (int tick = 0; tick < 2000; tick++) {
    double x = 0.0001 * tick, d = 0.30 - x - 0.012;
    const double pose[6] = {x, 0, 0, 0.1, 0, 0};
    step_with_pose(&r, &m, pose);
    queries += (int)r.trace.queried;
    ck_assert_int_eq(r.trace.contacts, d < 0.0025);
  }
  ck_assert_int_lt(queries, 20); /* never within reach: some ten questions on the way */
  for (int tick = 2000; tick < 2900; tick++) {
    double x = 0.0001 * tick, d = 0.30 - x - 0.012;
    const double pose[6] = {x, 0, 0, 0.1, 0, 0};
    step_with_pose(&r, &m, pose);
    if (fabs(d - 0.0025) > 1e-9) ck_assert_int_eq(r.trace.contacts, d < 0.0025);
  }
  close_with_body(&r);
}

TEST(test_released) {
  rig r;
  rig_open(&r, RIG_WALL);
  ethd_scene *a = rig_scene(FRAME_WALL), *b = rig_scene(FRAME_WALL);
  r.setup.bodies[0] = a;
  r.setup.bodies[1] = b;
  r.setup.bodies[2] = b;
  rig_start(&r);
  motion m = resting(0.30);
  r.setup.bodies[1] = r.setup.bodies[2] = NULL;
  r.setup.bodies[3] = a;
  rig_post(&r);
  rig_step(&r, &m);
  ethd_event e = rig_poll(&r);
  ck_assert(e.kind == ETHD_EVENT_TAKEN && e.scene == NULL);
  e = rig_poll(&r);
  ck_assert(e.kind == ETHD_EVENT_RELEASED && e.scene == b);
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  ethd_scene_destroy(b);
  rig_close(&r);
  ethd_scene_destroy(a);
}

/* ---- skipped ---- */

/* A wall 0.1 m away is asked for a handful of times, and never missed. */
TEST(test_skip) {
  rig r;
  int queries = 0;
  rig_begin(&r, RIG_WALL, NULL);
  for (int tick = 0; tick < 900; tick++) {
    double d = 0.1 - 0.0001 * tick, ahead = 0.002;
    motion m = rig_at(d, 0.1, ahead);
    rig_step(&r, &m);
    queries += (int)r.trace.queried;
    int counts = d < 0.0025 || d - ahead <= 0.0025;
    if (fabs(d - ahead - 0.0025) > 1e-9) ck_assert_int_eq(r.trace.contacts, counts);
  }
  ck_assert_int_lt(queries, 30);
  rig_close(&r);
}

/* Far from everything no memory of the scene is touched: it can't even be read. */
TEST(test_unreadable_scene) {
  rig r;
  enum { CIRCLES = 20000 };
  char *text = malloc(CIRCLES * 40), *end = text;
  for (int i = 0; i < CIRCLES; i++) end += sprintf(end, "circle %d.5 %d.25 0.1\n", 2 + i % 200, 2 + i / 200);
  rig_open(&r, text);
  free(text);
  rig_start(&r);
  motion m = resting(0.30);
  rig_step(&r, &m);
  ck_assert_int_eq(r.trace.queried, 1);
  ethd_scene_info info;
  ethd_scene_describe(r.scene, &info);
  uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), first = (uintptr_t)r.scene & ~(page - 1);
  uintptr_t last = ((uintptr_t)r.scene + info.bytes + page - 1) & ~(page - 1);
  ck_assert_int_eq(mprotect((void *)first, last - first, PROT_NONE), 0);
  for (int tick = 0; tick < 5000; tick++) {
    double phase = 0.001 * tick;
    m = resting(0.30 + 0.1 * sin(6.28 * phase));
    rig_step(&r, &m);
    ck_assert_int_eq(r.trace.queried, 0);
  }
  ck_assert_int_eq(mprotect((void *)first, last - first, PROT_READ | PROT_WRITE), 0);
  rig_close(&r);
}

/* ---- one surface, one push ---- */

/* Inside of a circle drawn with 180 edges the ring is pushed once, wherever it presses, and n turns with it. */
TEST(test_fine_curve_pushes_once) {
  enum { EDGES = 180 };
  char text[EDGES * 60 + 60], *end = text + sprintf(text, "polyline");
  for (int i = 0; i <= EDGES; i++)
    end += sprintf(end, " %.17g %.17g", 0.27 + 0.05 * cos(i % EDGES * 6.283185307179586 / EDGES),
                   0.25 + 0.05 * sin(i % EDGES * 6.283185307179586 / EDGES));
  *end = '\n';
  end[1] = 0;
  rig r;
  rig_open(&r, text);
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  ethd_setup_contact(&r.setup, &ethd_contact_spring);
  rig_start(&r);
  for (int tick = 0; tick < 3000; tick++) {
    double a = 0.00211 * tick;
    ethd_vec out = {cos(a), sin(a)}, x = {0.27 + 0.039 * out.x, 0.25 + 0.039 * out.y};
    motion m = {x, {0, 0}, x, {0, 0}};
    rig_step(&r, &m);
    ck_assert_int_eq(r.trace.contacts, 1);
    double push = -(r.trace.fe[0] * out.x + r.trace.fe[1] * out.y);
    ck_assert_double_eq_tol(push, 2500 * 0.001, 2500 * 0.00002); /* the chords are up to 8 um inside */
    ck_assert_double_lt(fabs(r.trace.fe[0] * out.y - r.trace.fe[1] * out.x), 0.05);
  }
  rig_close(&r);
}

/* A contact whose law fails at its first tick belongs to its body: nobody looks for it in the scene that isn't
   there, or in one without objects, and the next tick goes on as if the contact began then. */
TEST_LOOP(test_contact_fails_on_a_body, 0, 2) {
  const double pose[6] = {0.239, 0.7, 0, 0.1, 0, 0};
  for (int how = MOODY_FAIL; how <= MOODY_BAD; how++) {
    if (how == MOODY_POSITIVE) continue;
    rig r;
    moody_open(&r, 0);
    rig_close(&r);
    ethd_scene *body = rig_scene(FRAME_WALL);
    r.setup.bodies[0] = body;
    r.setup.scene = r.scene = _i ? rig_scene("") : NULL;
    rig_start(&r);
    motion m = resting(0.25);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.have |= ETHD_HAVE_BODY;
    memcpy(s.bodies, pose, sizeof pose);
    mood.contact = how;
    mood.value = NAN;
    for (int i = 0; i < 3; i++) {
      ck_assert_int_lt(rig_try(&r, &s), 0);
      ck_assert(r.command.torque[0] == 0 && r.command.torque[1] == 0);
      s.time_ns += 1000000;
    }
    mood.contact = MOODY_WELL;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    ck_assert_int_eq(r.trace.body, 1);
    ck_assert_double_eq_tol(r.trace.fe[0], 2.5, 1e-9); /* 2500 N/m, 1 mm deep */
    rig_close(&r);
    ethd_scene_destroy(body);
  }
}
