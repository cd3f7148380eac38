/* Runs an open device tick by tick, without a controller. */
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
  ethd_device *device;
  int64_t now, period; /* ns */
  atomic_int stop;     /* the `units` I/O threads */
  uint32_t units;
  ethd__conform_rig_unit unit[ETHD_UNITS_MAX];
  ethd_sense sense;
  char message[ETHD_MESSAGE_MAX];
  /* over all ticks since the device was opened */
  double resolution, speed, age; /* smallest step, rad; fastest, rad/s; oldest, s */
  double late;                   /* s: the largest lateness of a tick, which isn't the device's fault */
  double span;                   /* s: sum of the `spans` times between neighbouring samples */
  int64_t faults, grave, reading_ns;
  int backwards, ahead, failed, finite, samples, spans, readings;
};

ethd_verdict ethd__conform_rig_answer(ethd_conform_answer *a, ethd_verdict verdict, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

typedef struct ethd__conform_question {
  const char *name;
  ethd_verdict (*ask)(const ethd_conform_def *def, ethd_conform_answer *a);
  bool moves;
} ethd__conform_question;

/* Asks all questions, those that move the device only if it may be pushed; returns as ethd_conform does. */
ethd_status ethd__conform_ask(const ethd_conform_def *def, const ethd__conform_question *questions, int count,
                              double push, ethd_conform_answer *answers);

/* Returns whether def->stop ends the questions. Then ticks take no time, and the device has been made safe. */
bool ethd__conform_stopped(const ethd_conform_def *def);

/* Opens the device; false: r->message says why not. All [main]. */
bool ethd__conform_rig_open(const ethd_conform_def *def, ethd__conform_rig *r);

/* Opens and starts the device, with its I/O threads unless the clock is virtual; false: the answer says why not. */
bool ethd__conform_rig_begin(const ethd_conform_def *def, ethd__conform_rig *r, ethd_conform_answer *a);

/* Stops the device; closes it. */
void ethd__conform_rig_stop(ethd__conform_rig *r);
void ethd__conform_rig_end(ethd__conform_rig *r);

/* Starts the device, for the first time or after a stop, and returns its status. A device that refuses is asked to
   clear its own fault first, possibly its watchdog's from the question before. */
ethd_status ethd__conform_rig_start(ethd__conform_rig *r);

/* Sends no message to the device for this time, not even from its I/O threads; not for a virtual clock. */
void ethd__conform_rig_hush(ethd__conform_rig *r, double seconds);

/* Waits for the next tick's instant. */
void ethd__conform_rig_await(ethd__conform_rig *r);

/* Runs ticks for `seconds` with `torque`, Nm, on one joint and 0 on the other. */
void ethd__conform_rig_run(ethd__conform_rig *r, double seconds, int joint, double torque);

/* Applies no torque until both joints stand still, because the question before may have left them moving. Gives up
   after 2 s. */
void ethd__conform_rig_settle(ethd__conform_rig *r);

/* Returns the smallest acceleration, rad/s^2, that two windows of `window` s can distinguish from the steps of the
   angle. */
double ethd__conform_rig_least(const ethd__conform_rig *r, double window);

/* Returns the mean time from one joint sample to the next so far, s. */
double ethd__conform_rig_spacing(const ethd__conform_rig *r);

/* Returns the mean acceleration of a joint over two windows of `window` s, by the instants of its samples, rad/s^2.
   With `write` 0 it writes no command meanwhile. */
double ethd__conform_rig_acceleration(ethd__conform_rig *r, int joint, double torque, int write, double window);

#endif
