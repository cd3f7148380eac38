/* Reaches through an oblique wall to a plate on a simulated UR5e that is commanded by velocity, by ethd-tap's own rig: law
   `approach`, a headset at 72 Hz that is 30 ms late. The plate is to stand at the wall when the finger comes. The drawn
   reaches are of seeds that nobody tuned on: the table's accelerations were chosen on other draws. tests/tap_arm.sh has
   recorded people. */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "tap/reach_table.h"
#include "unit/arm_tables.h"

enum { TAPS = 40 };

static ethd__reach_plan plan;
static const ethd__gain *gains; /* one, or none */
static ethd__speed speed = {.word = "0.4", .commanded = 0.4};

static void describe(double delay, double gap, double bias, uint64_t seed) {
  static const char *const laws[] = {"approach"};
  char message[ETHD_MESSAGE_MAX];
  ethd__reaches *r = &plan.reaches;
  const ethd_vec3 aslant = {0.9, 0.35, -0.25};
  ethd__tool tool;
  plan = (ethd__reach_plan){.laws = laws, .law_count = 1, .speeds = &speed, .speed_count = 1, .taps = TAPS};
  *r = (ethd__reaches){.gap = gap, .rate = 72, .bias = bias, .seed = seed, .gains = gains, .gain_count = gains != NULL};
  arm_table("ur5e", "", &r->table);
  r->table.servo.delay = delay;
  ethd__linkage_place(&r->table.linkage, r->table.posture, &tool);
  r->n = ethd_vec3_scale(1 / ethd_vec3_norm(aslant), aslant);
  r->wall = ethd_vec3_dot(r->n, tool.x) + 0.12;
  ck_assert_msg(ethd__reaches_prepare(r, "ur5e", message) == ETHD_OK, "%s", message);
}

static ethd__reach_figures all(double delay, double gap, double bias, uint64_t seed) {
  char message[ETHD_MESSAGE_MAX];
  describe(delay, gap, bias, seed);
  ethd__reach_cell *cells = ethd__reach_cells_create(&plan);
  ck_assert_ptr_nonnull(cells);
  ck_assert_msg(ethd__reach_cells_run(&plan, cells, message) == ETHD_OK, "%s", message);
  const ethd__reach_figures f = ethd__reach_figures_of(cells);
  printf("delay %2.0f ms, gap %3.0f mm, bias %+3.0f mm: felt offset %+.3f mm, %.4f (%.4f) m/s, early %zu of %zu\n",
         1e3 * delay, 1e3 * gap, 1e3 * bias, 1e3 * f.felt, f.speed, f.fastest, f.early, f.early + f.valid);
  ck_assert_uint_eq(f.early + f.valid, TAPS);
  ethd__reach_cells_free(cells);
  return f;
}

TEST_LOOP(test_goals, 0, 4) {
  const bool late = _i & 1;
  const double delay = late ? 0.03 : 0.008, gap = 0.06;
  const uint64_t seed = 20260701 + (uint64_t)_i;
  const ethd__reach_figures f = all(delay, gap, 0, seed);
  ck_assert_double_le(fabs(f.felt), 0.1e-3);
  ck_assert_double_le(f.speed, 0.01);
  ck_assert_double_le(f.fastest, late ? 0.10 : 0.05);
  ck_assert_double_le(f.early_share, late ? 0.08 : 0.05);
  /* a headset that sees the hand 13 mm off shortens or lengthens the gap, and no more */
  for (double bias = -13e-3; bias < 0.02; bias += 26e-3) {
    const ethd__reach_figures off = all(delay, gap, bias, seed);
    ck_assert_double_le(fabs(off.felt), 0.1e-3);
    ck_assert_double_le(off.early_share, f.early_share + 0.01);
  }
}

/* gap >= v t_d + v^2 / (2 a) is needed, unless the plate waits at the wall: with less nearly every touch is early. */
TEST(test_gap_is_needed) {
  static const ethd__gain none = {"transition.wait", "0"};
  const ethd__reach_figures ahead = all(0.008, 0.012, 0, 1);
  ck_assert_double_le(ahead.early_share, 0.5);
  gains = &none;
  const ethd__reach_figures f = all(0.008, 0.012, 0, 1);
  gains = NULL;
  const double late = 0.008 + 2 / 150.0, a = plan.reaches.acceleration;
  ck_assert_double_ge(0.4 * late + 0.4 * 0.4 / (2 * a), 0.012);
  ck_assert_double_ge(f.early_share, 0.9);
}

/* To the bit, also after another tap. */
TEST(test_repeats) {
  static ethd__reach_rig rig;
  ethd__reach first, second, other;
  char message[ETHD_MESSAGE_MAX];
  describe(0.008, 0.06, 0, 3);
  ck_assert_int_eq(ethd__reach_open(&plan.reaches, "approach", &rig, message), ETHD_OK);
  ck_assert_int_eq(ethd__reach_run(&rig, 0.4, 5, &first, NULL), ETHD_OK);
  ck_assert_int_eq(ethd__reach_run(&rig, 0.3, 6, &other, NULL), ETHD_OK);
  ck_assert_int_eq(ethd__reach_run(&rig, 0.4, 5, &second, NULL), ETHD_OK);
  ck_assert(first.reason == ETHD_TAP_OK && first.felt == second.felt && first.speed == second.speed);
  ck_assert(first.felt != other.felt);
  ethd__reach_close(&rig);
}

/* A drawn reach has the speed asked for where the finger meets the wall. */
TEST(test_speed_at_the_wall) {
  static ethd__reach_rig rig;
  ethd__reach_rows rows = {0};
  ethd__reach tap;
  char message[ETHD_MESSAGE_MAX];
  describe(0.008, 0.06, 0, 4);
  ck_assert_int_eq(ethd__reach_open(&plan.reaches, "approach", &rig, message), ETHD_OK);
  for (uint64_t k = 0; k < 8; k++) {
    ck_assert_int_eq(ethd__reach_run(&rig, 0.4, k, &tap, &rows), ETHD_OK);
    const ethd__reach_row *at = &rows.row[rows.touch];
    ck_assert_double_eq_tol(at->v_finger, 0.4, 0.01);
    ck_assert(tap.felt == at->plate && tap.speed == at->v_plate && at->finger >= at->plate);
    ck_assert(at[-1].finger < at[-1].plate && at->state == ETHD_VO);
  }
  free(rows.row);
  ethd__reach_close(&rig);
}

/* A recording with z is laid so that all three axes are at the wall when it has fallen to the speed asked for. */
TEST(test_recording_in_space) {
  static ethd__reach_rig rig;
  ethd__recorded recorded;
  ethd__reach tap;
  char message[ETHD_MESSAGE_MAX], path[] = "/tmp/ethd-reach-XXXXXX";
  FILE *out = fdopen(mkstemp(path), "w");
  fputs("t_s,x_m,y_m,z_m\n", out);
  for (int i = 0; i <= 240; i++) { /* x falls by a half cosine, at most 0.59 m/s; y and z bend */
    const double t = i / 200.0, c = cos(M_PI * t / 1.2);
    fprintf(out, "%.4f,%.17g,%.17g,%.17g\n", t, 0.225 * c, 0.03 * t * t, 0.2 + 0.05 * c * c);
  }
  fclose(out);
  ck_assert_msg(ethd__recorded_load(path, &ethd__movement_si, &recorded, message) == ETHD_OK, "%s", message);
  unlink(path);
  describe(0.008, 0.06, 0, 1);
  plan.reaches.recorded = &recorded;
  plan.reaches.recorded_count = 1;
  ck_assert_int_eq(ethd__reach_open(&plan.reaches, "approach", &rig, message), ETHD_OK);
  ck_assert_int_eq(ethd__reach_run(&rig, 0.4, 0, &tap, NULL), ETHD_OK);
  ck_assert_int_eq(tap.reason, ETHD_TAP_OK);
  const ethd__arm_finger *f = &rig.sim.finger;
  const double fast = 0.225 * M_PI / 1.2, down = (M_PI - asin(0.4 / fast)) * 1.2 / M_PI; /* s: it has fallen to 0.4 */
  const ethd_vec3 axes[] = {f->n, f->across, f->up};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(ethd_vec3_dot(axes[i], axes[k]), i == k, 1e-14);
  for (double t = 0.1; t < 1.15; t += 0.1) {
    ethd_vec3 x, v;
    ethd__arm_finger_true(f, f->begin + t, &x, &v);
    const double c = cos(M_PI * t / 1.2), at = cos(M_PI * down / 1.2);
    const ethd_vec3 way = ethd_vec3_sub(x, plan.reaches.at);
    ck_assert_double_eq_tol(ethd_vec3_dot(f->n, way) + ETHD_REACH_FINGER, -0.225 * (c - at), 1e-4);
    ck_assert_double_eq_tol(ethd_vec3_dot(f->across, way), 0.03 * (t * t - down * down), 1e-4);
    ck_assert_double_eq_tol(ethd_vec3_dot(f->up, way), 0.05 * (c * c - at * at), 1e-4);
    ck_assert_double_eq_tol(ethd_vec3_dot(f->up, v), -0.1 * c * sin(M_PI * t / 1.2) * M_PI / 1.2, 1e-3);
  }
  ethd__reach_close(&rig);
  ethd__recorded_free(&recorded);
}

/* Told to be safe in the middle of a motion, an arm that holds itself stops by its accelerations and one with brakes at
   once; both stay. */
TEST_LOOP(test_safe, 0, 2) {
  static ethd__arm_sim sim;
  arm_table("ur5e", "", &sim.table);
  sim.table.safe = _i ? ETHD__ARM_BRAKES : ETHD__ARM_HOLDS;
  ethd__arm_sim_start(&sim);
  ethd_space_command command = {.value = {0.2, 0.1, -0.1}, .kind = ETHD_SPACE_VELOCITY};
  for (int k = 0; k < 250; k++) ethd__arm_sim_write(&sim, &command);
  ethd__tool moving, at, later;
  ethd_vec3 v;
  ethd__arm_sim_true(&sim, &moving, &v);
  ck_assert_double_ge(ethd_vec3_norm(v), 0.2);
  command.safe = 1;
  for (int k = 0; k < 250; k++) ethd__arm_sim_write(&sim, &command);
  ethd__arm_sim_true(&sim, &at, &v);
  ck_assert_double_le(ethd_vec3_norm(v), 1e-12);
  const double way = ethd_vec3_norm(ethd_vec3_sub(at.x, moving.x));
  if (_i)
    ck_assert(way == 0);
  else
    ck_assert_double_le(way, 0.25 * (0.008 + 2 / 150.0 + 0.05));
  for (int k = 0; k < 250; k++) ethd__arm_sim_write(&sim, &command);
  ethd__arm_sim_true(&sim, &later, &v);
  ck_assert_double_le(ethd_vec3_norm(ethd_vec3_sub(later.x, at.x)), 1e-12);
}
