/* The loop's threads around a device in space. No wall-clock bound is asserted. */
#include <stdatomic.h>
#include <string.h>
#include <time.h>

#include "unit/device_of.h"
#include "unit/mover_driver.h"
#include "unit/suite.h"

static mover_device d;
static atomic_int reads, services;

static ethd_status read_counted(void *device, int64_t now, ethd_space_sense *out) ETHD_RT {
  atomic_fetch_add(&reads, 1);
  const ethd_status status = mover_driver.read_space(device, now, out);
  ethd_vec3_put((ethd_vec3){0.3, 0, 0}, out->finger);
  return status;
}
static uint32_t one(const void *device) { return (void)device, 1; }
static ethd_status service(void *device, uint32_t unit, int64_t now) {
  return (void)device, (void)unit, (void)now, atomic_fetch_add(&services, 1), ETHD_STATUS_STALE;
}

static void await_reads(int n) {
  const struct timespec t = {.tv_nsec = 1000000};
  for (const int until = atomic_load(&reads) + n; atomic_load(&reads) < until;) nanosleep(&t, NULL);
}

/* Rows come in order from a run that is disarmed, enabled and stopped; the wall stops the effector. */
TEST(test_runs) {
  static ethd_driver driver;
  static ethd_device of_d;
  static walls near = {.n = {{1, 0, 0}}, .c = {0.02}, .count = 1};
  ethd_space_setup setup = ethd_space_setup_default();
  setup.acceleration = 20;
  driver = mover_driver;
  driver.read_space = read_counted;
  driver.units = one;
  driver.service = service;
  d = mover_device_at((ethd_vec3){0, 0, 0}, 0);
  device_of(&of_d, &driver, &d);
  of_d.in_space = true;
  ethd_space *space = made(&setup);
  ethd_loop_def def = ethd_loop_default();
  def.device = &of_d;
  def.space = space;
  def.surfaces = walls_near;
  def.surfaces_of = &near;
  def.early_wake = 1e-4;
  def.stack = (size_t)4 << 20; /* sanitizers keep their own things there */
  ethd_loop *loop;
  ck_assert_int_eq(ethd_loop_create(&def, &loop, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  await_reads(300);
  ethd_loop_disarm(loop);
  await_reads(5);
  ck_assert_int_eq(ethd_loop_armed(loop), 0);
  ck_assert_int_eq(ethd_loop_enable(loop), ETHD_OK);
  await_reads(300);
  ck_assert_int_eq(ethd_loop_armed(loop), 1);
  ethd_loop_stop(loop);
  ck_assert_int_eq(ethd_loop_join(loop), ETHD_OK);
  ethd_space_row row;
  int rows = 0, starts = 0;
  for (int64_t next = 0; ethd_loop_take_space(loop, &row) == ETHD_OK; next++, rows++) {
    if (row.marks & ETHD_ROW_STARTED) next = 0, starts++;
    if (row.trace.tick != next || row.trace.fault) ck_abort_msg("row %d: tick %ld", rows, (long)row.trace.tick);
  }
  ck_assert(rows >= 605 && starts == 2 && d.starts == 1 && atomic_load(&services) > 0);
  ck_assert(d.at.x > 0 && d.at.x <= 0.02 - setup.radius + 1e-5);
  const ethd_space_command *last = &d.written[(d.writes - 1) % MOVES_MAX];
  ck_assert(last->safe && last->value[0] == 0 && last->kind == ETHD_SPACE_VELOCITY);
  ethd_loop_destroy(loop);
  ethd_space_destroy(space);
}
