/* A loop on a virtual clock around a device that says what it was asked, and stalls when told to. */
#ifndef ETHD_TESTS_BENCH_H
#define ETHD_TESTS_BENCH_H

#include "ethd/loop.h"
#include "unit/device_of.h"
#include "unit/rig.h"

#define PERIOD 1000000 /* ns */

typedef struct device {
  int64_t *clock;
  int64_t read_at[64];
  int reads, writes, starts, safes, services;
  int64_t stall_read[64], stall_write[64]; /* ns, by tick */
  int fail_read, fail_write;               /* at this tick; -1 never */
  ethd_status start_gives;
  ethd_command written[64];
  ethd_sense sense;
} device;

typedef struct bench {
  rig r;
  device d;
  ethd_device of_d;
  int64_t clock;
  ethd_loop_def def;
  ethd_loop *loop;
} bench;

/* Ring in free space, finger 1 mm ahead: a torque that isn't 0. Then def is to be changed, or the device. */
void bench_open(bench *b);
void bench_start(bench *b);
ethd_loop_row bench_tick(bench *b);
void bench_close(bench *b);

#endif
