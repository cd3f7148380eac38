/* Subnormal numbers: a low-pass whose input stays 0 decays into them and, with rounding to nearest, stays there. The
   programs set FTZ and DAZ, so that a tick takes no longer then. But for what is subnormal the results are the same
   bits. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "clock.h"
#include "denormals.h"
#include "stress/mass.h"

#define TICKS 500
#define CUTOFF 10.0 /* Hz */

typedef struct standing {
  ethd_scene *scene;
  ethd_control *control;
  ethd_sense sense;
  ethd_command command;
  ethd_trace trace;
  double tick; /* s, the least over rounds */
} standing;

static void turn(standing *o) {
  o->sense.q[0] -= 1e-3, o->sense.q[1] -= 1e-3;
  (void)ethd_control_step(o->control, &o->sense, &o->command, NULL);
  o->sense.q[0] += 1e-3, o->sense.q[1] += 1e-3;
}

/* The ring stands still for `still` ticks after a turn. */
static void rest(standing *o, int64_t still) {
  ethd_setup setup = ethd_setup_default();
  *o = (standing){.scene = rig_scene(RIG_WALL), .tick = INFINITY};
  setup.scene = o->scene;
  rig_set(&setup, "velocity.cutoff", CUTOFF);
  o->sense.have = ETHD_HAVE_FINGER;
  o->sense.finger[0] = 0.249, o->sense.finger[1] = 0.25;
  o->control = rig_control(&setup);
  ck_assert_int_eq(ethd_arm_angles(&setup.arm, (ethd_vec){0.2495, 0.25}, -1, o->sense.q), ETHD_OK);
  turn(o);
  for (int64_t k = 0; k < still; k++) (void)ethd_control_step(o->control, &o->sense, &o->command, NULL);
}

static void measure(standing *o) {
  double start = 1e-9 * (double)ethd__clock_now();
  for (int k = 0; k < TICKS; k++) (void)ethd_control_step(o->control, &o->sense, &o->command, &o->trace);
  o->tick = fmin(o->tick, (1e-9 * (double)ethd__clock_now() - start) / TICKS);
}

static void end(standing *o) {
  ethd_control_destroy(o->control);
  ethd_scene_destroy(o->scene);
}

/* 1e-300 is far above the subnormal numbers and far below what moves anything. */
static double apart(double a, double b) { return fabs(a - b) <= 1e-300 ? 0 : fabs(a - b); }

/* Looks at the bits, since with DAZ the number compares as 0. */
static bool subnormal(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  bits &= ~((uint64_t)1 << 63);
  return bits != 0 && bits < (uint64_t)1 << 52;
}

TEST(test_denormals) {
  int rounds = (int)pick(40, 400);
  standing calm, flushed, kept;
  uint64_t before = ethd__denormals_flush();
  rest(&calm, 0);
  rest(&flushed, 20000);
  for (int r = 0; r < rounds; r++) { /* by turns, so that a busy machine slows down both */
    turn(&calm);
    measure(&calm);
    measure(&flushed);
  }
  ethd__denormals_keep();
  rest(&kept, 20000);
  for (int r = 0; r < rounds; r++) measure(&kept);
  ethd__denormals_restore(before);
  double off = 0;
  for (int i = 0; i < 2; i++) {
    off = fmax(off, apart(flushed.trace.tau[i], kept.trace.tau[i]));
    off = fmax(off, apart(flushed.trace.qd[i], kept.trace.qd[i]));
    off = fmax(off, apart(flushed.trace.fe[i], kept.trace.fe[i]));
    off = fmax(off, apart(flushed.trace.x[i], kept.trace.x[i]));
  }
  within(subnormal(kept.trace.qd[0]), 0, 0, "kept by the caller: nothing subnormal is left");
  bound(fabs(flushed.trace.qd[0]), DBL_MIN / (1 - exp(-2 * M_PI * CUTOFF * 0.001)),
        "flushed: the speed that is left <= least normal number / a");
  within(off, 0, 0, "torques, forces, speeds flushed and kept differ by");
  bound(flushed.tick / calm.tick, 1.5, "flushed: tick at rest over a tick in motion");
  end(&calm);
  end(&flushed);
  end(&kept);
}
