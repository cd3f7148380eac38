/* Subnormal numbers: a low-pass whose input stays 0 decays into them and, with rounding to nearest, stays there. The
   programs set FTZ and DAZ, so that a tick takes no longer then. But for what is subnormal the results are the same
   bits. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "cli/cli.h"
#include "clock.h"
#include "denormals.h"
#include "stress/rig.h"
#include "stress/stress.h"

#define TICKS 500
#define CUTOFF 10.0 /* Hz */

typedef struct rest_found {
  double tick;  /* s, the least over rounds */
  double speed; /* rad/s that is left of joint 1 */
  ethd_trace trace;
} rest_found;

/* The ring stood still for `still` ticks after a turn. */
static rest_found rest(int64_t still, int rounds) {
  ethd_setup setup = ethd_setup_default();
  ethd_scene *scene = ethd__stress_rig_wall(-0.238);
  ethd_control *control;
  ethd_error error;
  rest_found o = {.tick = INFINITY};
  ethd_sense s;
  ethd_command c;
  setup.scene = scene;
  ethd__stress_set(&setup, "velocity.cutoff", CUTOFF);
  if (ethd_control_create(&setup, &control, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  memset(&s, 0, sizeof s);
  s.have = ETHD_HAVE_FINGER;
  if (ethd_arm_angles(&setup.arm, (ethd_vec){0.2495, 0.25}, -1, s.q) < 0) return o;
  s.finger[0] = 0.249, s.finger[1] = 0.25;
  s.q[0] -= 1e-3, s.q[1] -= 1e-3;
  (void)ethd_control_step(control, &s, &c, NULL);
  s.q[0] += 1e-3, s.q[1] += 1e-3;
  for (int64_t k = 0; k < still; k++) (void)ethd_control_step(control, &s, &c, NULL);
  for (int r = 0; r < rounds; r++) {
    double start = 1e-9 * (double)ethd__clock_now();
    for (int k = 0; k < TICKS; k++) (void)ethd_control_step(control, &s, &c, &o.trace);
    o.tick = fmin(o.tick, (1e-9 * (double)ethd__clock_now() - start) / TICKS);
  }
  o.speed = o.trace.qd[0];
  ethd_control_destroy(control);
  ethd_scene_destroy(scene);
  return o;
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

static void run(ethd__stress_log *log) {
  int rounds = (int)ethd__stress_pick(log, 40, 200, 400);
  uint64_t before = ethd__denormals_flush();
  rest_found calm = rest(100, rounds), flushed = rest(20000, rounds);
  ethd__denormals_keep();
  rest_found kept = rest(20000, rounds);
  ethd__denormals_restore(before);
  double off = 0;
  for (int i = 0; i < 2; i++) {
    off = fmax(off, apart(flushed.trace.tau[i], kept.trace.tau[i]));
    off = fmax(off, apart(flushed.trace.qd[i], kept.trace.qd[i]));
    off = fmax(off, apart(flushed.trace.fe[i], kept.trace.fe[i]));
    off = fmax(off, apart(flushed.trace.x[i], kept.trace.x[i]));
  }
  ethd__stress_within(log, "1", subnormal(kept.speed), 1, 0, "kept: the speed that is left is subnormal");
  ethd__stress_bound(log, "rad/s", fabs(flushed.speed), DBL_MIN / (1 - exp(-2 * M_PI * CUTOFF * 0.001)),
                     "flushed: the speed that is left <= least normal number / a");
  ethd__stress_within(log, "Nm", off, 0, 0, "torques, forces, speeds flushed and kept differ by");
  ethd__stress_bound(log, "1", flushed.tick / calm.tick, 1.5, "flushed: tick at rest over a tick in motion");
  ethd__stress_note(log, "tick in motion %.0f ns; at rest flushed %.0f ns, with subnormals kept %.0f ns",
                    1e9 * calm.tick, 1e9 * flushed.tick, 1e9 * kept.tick);
}

const ethd__stress ethd__stress_denormals = {"denormals", "subnormal numbers: same results, same pace", run};
