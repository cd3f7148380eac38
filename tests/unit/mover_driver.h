/* The mover as a driver: an effector in space that takes velocities, late by whole ticks, with a finger that is known. */
#ifndef ETHD_TESTS_MOVER_DRIVER_H
#define ETHD_TESTS_MOVER_DRIVER_H

#include "ethd/loop.h"
#include "unit/mover.h"

#define MOVES_MAX 4096

typedef struct mover_device {
  ethd_vec3 at, v;              /* commanded */
  ethd_vec3 past[LATE_MAX + 1]; /* commanded places, the newest first */
  int late;
  double period;                 /* s */
  ethd_vec3 finger_v, finger_at; /* of the finger, and where it is at instant 0 */
  int reads, writes, starts, safes;
  int fail_read, fail_write;   /* at this call; -1: never */
  int stale_from, stale_until; /* calls of read that have no newer sample */
  int64_t faults;              /* that every read reports */
  bool is_safe;                /* whatever is written */
  double speed;                /* m/s: the device cuts a faster command, and says so; INFINITY: it takes all */
  double travel;               /* m from the origin along each axis: it stops there, and says so */
  bool cut;                    /* it has cut the last one */
  ethd_space_command written[MOVES_MAX];
} mover_device;

/* A device that stands at a place. */
mover_device mover_device_at(ethd_vec3 at, int late);

/* Reads: time_ns is the tick's instant; x, v as commanded. `safe` holds it where it is until the next start. Its open
   makes one that stands at the origin. */
extern const ethd_driver mover_driver;

/* Walls n.p = c as the loop's surfaces. */
typedef struct walls {
  ethd_vec3 n[2];
  double c[2];
  uint32_t count;
  int asked;
} walls;

uint32_t walls_near(void *walls, const ethd_space_sense *sense, ethd_surface out[ETHD_SURFACES_MAX]) ETHD_RT;

#endif
