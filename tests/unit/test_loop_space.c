/* The loop around a device in space, on a virtual clock. */
#include <math.h>
#include <string.h>

#include "unit/device_of.h"
#include "unit/mover_driver.h"
#include "unit/suite.h"

#define PERIOD 1000000 /* ns */

typedef struct space_bench {
  ethd_space_setup setup;
  ethd_space *space;
  mover_device d;
  ethd_driver driver;
  ethd_device of_d;
  walls walls;
  int64_t clock;
  ethd_loop_def def;
  ethd_loop *loop;
} space_bench;

static space_bench b;

/* An effector at the origin and a finger that leaves it along `v`. Then setup, device and def are to be changed. */
static void begin(ethd_vec3 v) {
  memset(&b, 0, sizeof b);
  b.setup = ethd_space_setup_default();
  b.setup.acceleration = 20;
  b.d = mover_device_at((ethd_vec3){0, 0, 0}, 0);
  b.d.finger_v = v;
  b.driver = mover_driver;
  b.clock = -PERIOD; /* the first tick is at 0 */
  b.def = ethd_loop_default();
  b.def.clock = &b.clock;
  b.def.soft_start = 0;
  b.def.surfaces = walls_near;
  b.def.surfaces_of = &b.walls;
}

static void start(void) {
  device_of(&b.of_d, &b.driver, &b.d);
  b.of_d.in_space = true;
  b.space = made(&b.setup);
  b.def.device = &b.of_d;
  b.def.space = b.space;
  ck_assert_int_eq(ethd_loop_create(&b.def, &b.loop, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(b.loop, NULL), ETHD_OK);
}

static ethd_space_row tick(void) {
  ethd_space_row row;
  ethd_loop_tick(b.loop);
  ck_assert_int_eq(ethd_loop_take_space(b.loop, &row), ETHD_OK);
  return row;
}

static void end(void) {
  ethd_loop_destroy(b.loop);
  ethd_space_destroy(b.space);
}

static const ethd_space_command *last_written(void) { return &b.d.written[b.d.writes - 1]; }

static bool is_let_go(const ethd_space_command *c) {
  return c->safe && c->kind == (int32_t)b.setup.kind && c->value[0] == 0 && c->value[1] == 0 && c->value[2] == 0;
}

/* ---- the controller's ticks ---- */

/* Through device and loop a reach through an oblique wall is, to the bit, what a loop written by hand makes of it. */
TEST(test_as_by_hand) {
  const ethd_vec3 n = {0.6, 0, 0.8}, v = {0.2, 0.1, 0.3};
  begin(v);
  b.walls = (walls){.n = {n}, .c = {0.2}, .count = 1};
  b.setup.ability.delay = 8e-3;
  mover m = {.setup = b.setup};
  mover_open(&m, 8, (ethd_vec3){0, 0, 0});
  start();
  for (int i = 0; i < 1500; i++) {
    const ethd_surface near = wall_at(m.at, n, 0.2, 0);
    mover_step(&m, ethd_vec3_add((ethd_vec3){0, 0, 0}, ethd_vec3_scale(1e-9 * (double)((int64_t)PERIOD * i), v)), v,
               &near, 1);
    const ethd_space_row row = tick();
    ck_assert_msg(!memcmp(&row.trace, &m.trace, sizeof m.trace), "tick %d differs", i);
    ck_assert(row.share == 1 && row.armed == 1 && row.marks == (i ? 0 : ETHD_ROW_STARTED));
    ck_assert(ethd_vec3_norm(ethd_vec3_sub(b.d.at, m.at)) == 0);
  }
  ck_assert(fabs(ethd_vec3_dot(n, b.d.at) - 0.2 + b.setup.radius) < 1e-6); /* it stands in the wall */
  ck_assert_int_eq(b.walls.asked, 1500);
  ethd_space_destroy(m.space);
  end();
}

/* While the speed's share grows, what the device gets keeps the acceleration: the controller is told of it. */
TEST(test_soft_start) {
  begin((ethd_vec3){1, 0, 0});
  b.def.soft_start = 0.050;
  start();
  double last = 0;
  for (int i = 0; i < 400; i++) {
    const ethd_space_row row = tick();
    const double share = i < 50 ? i / 50.0 : 1, written = last_written()->value[0];
    ck_assert_double_eq_tol(row.share, share, 1e-12);
    ck_assert_double_eq(written, row.share * row.trace.command[0]);
    ck_assert(fabs(written - last) <= 20e-3 * (1 + 1e-12));
    const bool told = row.trace.sense.have & ETHD_SPACE_HAVE_COMMANDED;
    ck_assert(told == (i > 0 && i <= 50) && (!told || row.trace.sense.commanded[0] == last));
    last = written;
  }
  ck_assert_double_eq_tol(last, 1, 0.05);
  end();
}

/* A driver that cuts a command knows what it did. */
TEST(test_device_cuts) {
  begin((ethd_vec3){1, 0, 0});
  b.d.speed = 0.3;
  start();
  for (int i = 0; i < 200; i++) {
    const ethd_space_row row = tick();
    ck_assert(row.trace.command[0] <= 0.3 + 20e-3 * (1 + 1e-12));
    ck_assert(ethd_vec3_norm(b.d.v) <= 0.3 + 1e-15);
  }
  ck_assert_double_eq_tol(b.d.v.x, 0.3, 1e-15);
  end();
}

/* ---- what the loop asks ---- */

static double along[3];
static ethd_ability able(const void *d, const double n[3]) ETHD_RT {
  (void)d;
  memcpy(along, n, sizeof along);
  return (ethd_ability){.speed = 2, .acceleration = 7, .delay = 0.004, .mass = NAN, .force = NAN, .friction = NAN};
}

static ethd_status read_with_ability(void *device, int64_t now, ethd_space_sense *out) ETHD_RT {
  out->have |= ETHD_SPACE_HAVE_ABILITY;
  for (int i = 0; i < ETHD_ABILITY; i++) out->ability[i] = i;
  return mover_driver.read_space(device, now, out);
}

TEST(test_ability) {
  begin((ethd_vec3){0.01, 0, 0});
  b.driver.able = able;
  b.walls = (walls){.n = {{1, 0, 0}, {0, -1, 0}}, .c = {0.2, 0.15}, .count = 2};
  start();
  ethd_space_row row = tick();
  ck_assert(row.trace.sense.have & ETHD_SPACE_HAVE_ABILITY && row.trace.sense.ability[1] == 7);
  ck_assert(along[0] == 0 && along[1] == -1 && along[2] == 0); /* the nearer one */
  b.walls.c[1] = 0.5;
  (void)tick();
  ck_assert(along[0] == 1 && along[1] == 0);
  b.walls.count = 0; /* no normal, no ability: the setup's counts */
  row = tick();
  ck_assert(!(row.trace.sense.have & ETHD_SPACE_HAVE_ABILITY));
  end();
  begin((ethd_vec3){0.01, 0, 0}); /* the driver's read knows better */
  b.driver.able = able;
  b.driver.read_space = read_with_ability;
  b.walls = (walls){.n = {{1, 0, 0}}, .c = {0.2}, .count = 1};
  start();
  row = tick();
  ck_assert(row.trace.sense.ability[1] == 1 && row.trace.sense.ability[5] == 5);
  end();
}

/* What the callback gives is judged by the controller, not trusted by the loop. */
static uint32_t too_many(void *of, const ethd_space_sense *sense, ethd_surface out[ETHD_SURFACES_MAX]) ETHD_RT {
  return (void)of, (void)sense, (void)out, ETHD_SURFACES_MAX + 1;
}
TEST(test_impossible_surfaces) {
  begin((ethd_vec3){0.01, 0, 0});
  b.driver.able = able;
  b.def.surfaces = too_many;
  start();
  const ethd_space_row row = tick();
  ck_assert(row.trace.fault == ETHD_FAULT_INPUT && !row.armed && is_let_go(last_written()));
  end();
}

/* ---- samples that don't come ---- */

/* Without a newer sample the command is held; the step that follows knows how many periods that took. */
TEST(test_held_samples) {
  begin((ethd_vec3){1, 0, 0});
  b.d.stale_from = 20;
  b.d.stale_until = 23;
  start();
  ethd_space_row row;
  for (int i = 0; i < 20; i++) (void)tick();
  const int writes = b.d.writes;
  for (int i = 0; i < 3; i++) {
    ethd_loop_tick(b.loop);
    ck_assert_int_eq(ethd_loop_take_space(b.loop, &row), ETHD_STATUS_EMPTY);
  }
  ck_assert_int_eq(b.d.writes, writes);
  row = tick();
  ck_assert(row.trace.sense.missed == 3 && row.trace.fault == 0 && row.trace.sense.time_ns == 23 * PERIOD);
  end();
}

/* What takes the power doesn't wait for a sample: the last one stands in. */
TEST(test_pressing_fault) {
  begin((ethd_vec3){1, 0, 0});
  b.d.stale_from = 20;
  b.d.stale_until = 30;
  start();
  for (int i = 0; i < 20; i++) (void)tick();
  b.d.faults = ETHD_FAULT_BIT(ETHD_FAULT_EMERGENCY_STOP);
  const ethd_space_row row = tick();
  ck_assert(row.trace.fault == ETHD_FAULT_EMERGENCY_STOP && !row.armed && is_let_go(last_written()));
  ck_assert(row.trace.sense.time_ns == 19 * PERIOD && row.trace.sense.x[0] > 0 && b.d.safes == 1);
  end();
}

TEST(test_failed_read) {
  begin((ethd_vec3){1, 0, 0});
  b.d.fail_read = 10;
  start();
  for (int i = 0; i < 10; i++) (void)tick();
  const int asked = b.walls.asked;
  ethd_space_row row = tick();
  ck_assert(row.trace.fault == ETHD_FAULT_INPUT && !row.armed && row.share == 0 && is_let_go(last_written()));
  ck_assert(b.walls.asked == asked && b.d.safes == 1 && !ethd_loop_armed(b.loop));
  ethd_loop_acknowledge(b.loop);
  row = tick();
  ck_assert(row.marks == ETHD_ROW_CLEARED && row.trace.fault == 0 && !row.armed && is_let_go(last_written()));
  end();
}

/* ---- letting go, and going on ---- */

TEST(test_disarm_and_enable) {
  ethd_loop_stats stats;
  begin((ethd_vec3){1, 0, 0});
  start();
  for (int i = 0; i < 100; i++) (void)tick();
  ethd_loop_disarm(b.loop);
  for (int i = 0; i < 5; i++) {
    const ethd_space_row row = tick();
    ck_assert(!row.armed && row.share == 0 && is_let_go(last_written()) && b.d.safes == 1);
    ck_assert(!i == !(row.trace.sense.have & ETHD_SPACE_HAVE_COMMANDED)); /* the controller knows that it stands */
    ck_assert(i < 1 || fabs(row.trace.command[0]) <= 20e-3);
  }
  ethd_loop_raise(b.loop, ETHD_FAULT_EMERGENCY_STOP);
  ck_assert_int_eq(tick().trace.fault, ETHD_FAULT_EMERGENCY_STOP);
  ck_assert_int_eq(ethd_loop_enable(b.loop), ETHD_OK);
  ck_assert_int_eq(b.d.starts, 1);
  const ethd_space_row row = tick();
  ck_assert(row.marks == ETHD_ROW_STARTED && row.trace.tick == 0 && row.armed && row.trace.fault == 0);
  ck_assert(!(row.trace.sense.have & ETHD_SPACE_HAVE_COMMANDED) && last_written()->value[0] > 0);
  ethd_loop_read(b.loop, &stats);
  ck_assert_uint_eq(stats.faults[ETHD_FAULT_EMERGENCY_STOP], 1); /* over the restart */
  ethd_loop_stop(b.loop);
  ck_assert_int_eq(ethd_loop_join(b.loop), ETHD_OK);
  ck_assert(is_let_go(last_written()));
  end();
}

/* A stop of the controller's brakes with the acceleration first; then the device is made safe. */
TEST(test_stop) {
  begin((ethd_vec3){1, 0, 0});
  start();
  for (int i = 0; i < 200; i++) (void)tick();
  ethd_loop_raise(b.loop, ETHD_FAULT_APPLICATION);
  int ticks = 0;
  double last = b.d.v.x;
  for (ethd_space_row row = tick(); row.armed; row = tick(), ticks++) {
    ck_assert(row.trace.fault == ETHD_FAULT_APPLICATION && !last_written()->safe);
    ck_assert(fabs(last - 20e-3 - b.d.v.x) < 1e-12 || b.d.v.x == 0);
    last = b.d.v.x;
  }
  ck_assert(ticks > 40 && ticks < 60 && b.d.safes == 1 && is_let_go(last_written())); /* 1 m/s at 20 m/s^2 */
  end();
}

/* ---- what is refused ---- */

TEST(test_refused) {
  ethd_error error;
  begin((ethd_vec3){0, 0, 0});
  start();
  ethd_loop *other;
  ethd_loop_row row;
  ck_assert_int_eq(ethd_loop_take(b.loop, &row), ETHD_E_ARGUMENT);
#define REFUSED(field_name, ...)                                               \
  do {                                                                         \
    ethd_loop_def def = b.def;                                                 \
    __VA_ARGS__;                                                               \
    ck_assert_int_eq(ethd_loop_create(&def, &other, &error), ETHD_E_ARGUMENT); \
    ck_assert_str_eq(error.name, field_name);                                  \
  } while (0)
  const ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ck_assert_int_eq(ethd_control_create(&setup, &control, &error), ETHD_OK);
  REFUSED("control", def.space = NULL);
  REFUSED("control and space", def.control = control);
  REFUSED("device", def.space = NULL, def.control = control);
  REFUSED("period", def.period = 0.002);
  ck_assert(error.min == 0.001 && error.max == 0.001);
  ethd_control_destroy(control);
  end();
}
