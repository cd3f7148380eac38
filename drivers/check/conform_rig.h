/* A device between open and close, run tick by tick without a controller. */
#ifndef ETHD_CHECK_CONFORM_RIG_H
#define ETHD_CHECK_CONFORM_RIG_H

#include "ethd/conform.h"

typedef struct ethd__rig {
  const ethd_conform_def *def;
  const ethd_driver *driver;
  void *device;
  int64_t now, period; /* ns */
  ethd_sense sense;
  char message[ETHD_MESSAGE_MAX];
  /* over all ticks since it was opened */
  double resolution, speed, age; /* smallest step, rad; fastest, rad/s; oldest, s */
  int64_t faults;
  int backwards, ahead, failed, finite, samples;
} ethd__rig;

ethd_verdict ethd__rig_answer(ethd_conform_answer *a, ethd_verdict verdict, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* False: r->message says why. All [main]. */
int ethd__rig_open(const ethd_conform_def *def, ethd__rig *r);

/* Open and started; false: the answer says why not. */
int ethd__rig_begin(const ethd_conform_def *def, ethd__rig *r, ethd_conform_answer *a);

/* Stopped and closed. */
void ethd__rig_end(ethd__rig *r);

/* `seconds` of ticks with `torque`, Nm, on a joint, 0 on the other. */
void ethd__rig_run(ethd__rig *r, double seconds, int joint, double torque);

/* Mean acceleration of a joint over two windows of s, rad/s^2; write 0: nothing is written meanwhile. */
double ethd__rig_acceleration(ethd__rig *r, int joint, double torque, int write, double window);

#endif
