/* Passivity observer and controller: gains over the sampled loop's bound, on an exact mass that is pressed
   against a wall; and walls that are passive enough, which it leaves alone. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bounds/stability.h"
#include "stress/rig.h"
#include "unit/rig.h"

#define MASS 0.25
#define BOUND 0.002 /* J */

typedef struct run {
  double early, late; /* m: swing of the depth in the first and the last 0.25 s */
  ethd_fault fault;
  int64_t seen;      /* rows told, as bits */
  double most_force; /* N, along n: positive would pull */
} run;

static double swing(double *lo, double *hi, double x) {
  *lo = fmin(*lo, x);
  *hi = fmax(*hi, x);
  return *hi - *lo;
}

static void poll(ethd_control *control, run *out) {
  ethd_event e;
  while (ethd_control_poll(control, &e) == ETHD_OK)
    if (e.kind == ETHD_EVENT_FAULT) out->seen |= ETHD_FAULT_BIT(e.code);
}

/* 3 s pressed with 4 N against a wall of stiffness K, damping B on the way in. */
static run press(double K, double B, int delay, double energy) {
  enum { TICKS = 3000 };
  static ethd__stress_rig ring;
  run out = {.most_force = -INFINITY};
  double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
  ethd__stress_rig_open(&ring, MASS, -0.001);
  ring.delay = delay;
  ring.measured = 1;
  ring.push = (ethd_vec){-4, 0};
  ring.setup.limits.energy = energy;
  ethd_setup_transition(&ring.setup, &ethd_transition_smooth);
  ethd_setup_contact(&ring.setup, &ethd_contact_kelvin_voigt);
  const ethd_law *law = &ethd_contact_kelvin_voigt.law;
  ring.setup.contact_p[ethd_params_find(law->params, law->param_count, "k_e")] = K;
  ring.setup.contact_p[ethd_params_find(law->params, law->param_count, "b_e")] = B;
  ethd__stress_rig_start(&ring, 0);
  for (int i = 0; i < TICKS; i++) {
    const ethd_trace *t = ethd__stress_rig_tick(&ring);
    if (t->fault) {
      out.fault = (ethd_fault)t->fault;
      break;
    }
    if (i < 250) out.early = swing(&lo[0], &hi[0], ethd__stress_rig_depth(&ring));
    if (i >= TICKS - 250) out.late = swing(&lo[1], &hi[1], ethd__stress_rig_depth(&ring));
    out.most_force = fmax(out.most_force, -t->fe[0]); /* n = (-1, 0) */
  }
  poll(ring.control, &out);
  ethd__stress_rig_close(&ring);
  return out;
}

static bool is_stable(double K, double B, int delay) {
  ethd__sampled_loop loop = {.mass = MASS, .period = 1e-3, .stiffness = K, .damping = B, .delay = delay, .link = 0.25};
  loop.method = ETHD_VELOCITY_DIFFERENCE;
  return ethd__sampled_stable(&loop);
}

/* A spring is over the bound at any stiffness: it swings up without, and comes to rest with. */
static const struct {
  double K;
  int delay;
} springs[] = {{1000, 0}, {3000, 0}, {10000, 0}, {1000, 1}, {3000, 1}};

START_TEST(test_oscillation) {
  double K = springs[_i].K;
  int delay = springs[_i].delay;
  ck_assert(!is_stable(K, 0, delay));
  run without = press(K, 0, delay, INFINITY), with = press(K, 0, delay, BOUND);
  printf("K %g, %d ticks: swing %.3g -> %.3g mm without, %.3g -> %.3g mm with\n", K, delay, 1e3 * without.early,
         1e3 * without.late, 1e3 * with.early, 1e3 * with.late);
  ck_assert_double_gt(without.late, without.early);
  ck_assert_double_lt(with.late, 0.1 * without.late);
  ck_assert(with.fault == ETHD_FAULT_NONE && with.seen & ETHD_FAULT_BIT(ETHD_FAULT_ENERGY));
  ck_assert_double_le(with.most_force, 0);
}
END_TEST

/* Far over the bound damping doesn't help: the ring is stopped. */
START_TEST(test_beyond_help) {
  run with = press(60000, 0, 1, BOUND);
  ck_assert(with.fault == ETHD_FAULT_ENERGY);
}
END_TEST

/* Walls under the bound are left alone, to the bit. */
START_TEST(test_passive) {
  const double walls[][2] = {{500, 45}, {1000, 45}, {2500, 45}, {2500, 20}};
  for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
    run without = press(walls[i][0], walls[i][1], 0, INFINITY), with = press(walls[i][0], walls[i][1], 0, BOUND);
    ck_assert(with.seen == 0 && with.early == without.early && with.late == without.late);
  }
}
END_TEST

int main(void) {
  Suite *suite = suite_create("passivity");
  TCase *t = tcase_create("passivity");
  tcase_add_loop_test(t, test_oscillation, 0, sizeof springs / sizeof *springs);
  tcase_add_test(t, test_beyond_help);
  tcase_add_test(t, test_passive);
  suite_add_tcase(suite, t);
  return rig_run(suite);
}
