#include "unit/bench.h"

#include <string.h>

static ethd_status dev_start(void *d) { return ((device *)d)->starts++, ((device *)d)->start_gives; }

static ethd_status dev_read(void *device_, int64_t now, ethd_sense *out) ETHD_RT {
  device *d = device_;
  *out = d->sense;
  out->time_ns = now;
  d->read_at[d->reads] = now;
  *d->clock += d->stall_read[d->reads];
  return d->reads++ == d->fail_read ? ETHD_E_DEVICE : ETHD_OK;
}

static ethd_status dev_write(void *device_, int64_t now, const ethd_command *command) ETHD_RT {
  device *d = device_;
  (void)now;
  d->written[d->writes] = *command;
  *d->clock += d->stall_write[d->writes];
  return d->writes++ == d->fail_write ? ETHD_E_DEVICE : ETHD_OK;
}

static void dev_safe(void *d) ETHD_RT { ((device *)d)->safes++; }
static uint32_t dev_units(const void *d) { return (void)d, 1; }
static ethd_status dev_service(void *d, uint32_t unit, int64_t now) {
  return (void)unit, (void)now, ((device *)d)->services++, ETHD_OK;
}
static ethd_status dev_stop(void *d) { return (void)d, ETHD_OK; }

static const ethd_driver driver = {.size = sizeof driver,
                                   .abi = ETHD_DRIVER_ABI,
                                   .id = "test",
                                   .brief = "test",
                                   .start = dev_start,
                                   .read = dev_read,
                                   .write = dev_write,
                                   .units = dev_units,
                                   .service = dev_service,
                                   .safe = dev_safe,
                                   .stop = dev_stop};

void bench_open(bench *b) {
  memset(b, 0, sizeof *b);
  rig_begin(&b->r, NULL, NULL);
  motion m = rig_at(0.01, 0, 0.001);
  b->clock = 5 * (int64_t)PERIOD;
  b->d = (device){.clock = &b->clock, .fail_read = -1, .fail_write = -1, .sense = rig_sense(&b->r.setup.arm, &m)};
  b->def = ethd_loop_default();
  device_of(&b->of_d, &driver, &b->d);
  b->def.device = &b->of_d;
  b->def.control = b->r.control;
  b->def.clock = &b->clock;
  b->def.soft_start = 0;
}

void bench_start(bench *b) {
  ck_assert_int_eq(ethd_loop_create(&b->def, &b->loop, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(b->loop, NULL), ETHD_OK);
}

ethd_loop_row bench_tick(bench *b) {
  ethd_loop_row row;
  ethd_loop_tick(b->loop);
  ck_assert_int_eq(ethd_loop_take(b->loop, &row), ETHD_OK);
  return row;
}

void bench_close(bench *b) {
  ethd_loop_destroy(b->loop);
  rig_close(&b->r);
}
