/* A device between open and close, run tick by tick without a controller. */
#ifndef ETHD__CONFORM_CONFORM_RIG_H
#define ETHD__CONFORM_CONFORM_RIG_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "ethd/conform.h"

typedef struct ethd__conform_rig ethd__conform_rig;

/* A thread for a unit of blocking I/O. */
typedef struct ethd__conform_rig_unit {
  ethd__conform_rig *rig;
  uint32_t number;
  pthread_t thread;
} ethd__conform_rig_unit;

struct ethd__conform_rig {
  const ethd_conform_def *def;
  const ethd_driver *driver;
  void *device;
  int64_t now, period; /* ns */
  atomic_int stop;     /* the I/O threads, of which there are `units` */
  uint32_t units;
  ethd__conform_rig_unit unit[ETHD_UNITS_MAX];
  ethd_sense sense;
  char message[ETHD_MESSAGE_MAX];
  /* over all ticks since the device was opened */
  double resolution, speed, age; /* smallest step, rad; fastest, rad/s; oldest, s */
  double late;                   /* s: the latest that a tick came, through no fault of the device */
  double span;                   /* s: sum of the times between neighbouring samples, of which there are `spans` */
  int64_t faults, grave, reading_ns;
  int backwards, ahead, failed, finite, samples, spans, readings;
};

ethd_verdict ethd__conform_rig_answer(ethd_conform_answer *a, ethd_verdict verdict, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* False: r->message says why. All [main]. */
bool ethd__conform_rig_open(const ethd_conform_def *def, ethd__conform_rig *r);

/* Open and started, with its I/O threads unless the clock is virtual; false: the answer says why not. */
bool ethd__conform_rig_begin(const ethd_conform_def *def, ethd__conform_rig *r, ethd_conform_answer *a);

/* Stopped; and closed. */
void ethd__conform_rig_stop(ethd__conform_rig *r);
void ethd__conform_rig_end(ethd__conform_rig *r);

/* Starts the device, again after a stop; a device that refuses is first asked to leave a fault of its own, its
   watchdog's from the question before, say. Returns its status. */
ethd_status ethd__conform_rig_start(ethd__conform_rig *r);

/* Nobody speaks to the device for so long, not even its I/O threads; not on a virtual clock. */
void ethd__conform_rig_hush(ethd__conform_rig *r, double seconds);

/* Runs ticks for `seconds` with `torque`, Nm, on one joint and 0 on the other. */
void ethd__conform_rig_run(ethd__conform_rig *r, double seconds, int joint, double torque);

/* Applies no torque until both joints stand still, because the question before may have left them moving. Gives up
   after 2 s. */
void ethd__conform_rig_settle(ethd__conform_rig *r);

/* The smallest acceleration that such windows can tell from the steps of the angle, rad/s^2. */
double ethd__conform_rig_least(const ethd__conform_rig *r, double window);

/* s from one joint sample to the next, on the mean so far. */
double ethd__conform_rig_spacing(const ethd__conform_rig *r);

/* Mean acceleration of a joint over two windows of s, by the instants of its samples, rad/s^2; write 0: nothing is
   written meanwhile. */
double ethd__conform_rig_acceleration(ethd__conform_rig *r, int joint, double torque, int write, double window);

#endif
