/* Finds a joint's angle by moving it slowly, with little torque, until it meets its stop or its encoder's index mark.
   One joint moves at a time and the other gets no torque; there is one call per exchange.

     stop    away from it a little (an encoder that doesn't follow is found out here), then towards it until it stands
             under nearly all of the torque for a while: that place is `angle`
     index   towards the mark until it has passed: that count is `angle` */
#ifndef ETHD__SERVO_HOMING_H
#define ETHD__SERVO_HOMING_H

#include <stdbool.h>

#include "ethd/base.h"

typedef enum ethd__homing_method { ETHD__HOMING_JIG, ETHD__HOMING_STOP, ETHD__HOMING_INDEX } ethd__homing_method;

typedef struct ethd__homing_def {
  ethd__homing_method method; /* STOP or INDEX */
  double direction;           /* 1 or -1: of the joint's angle, towards stop or mark */
  double speed;               /* rad/s */
  double torque;              /* Nm, the largest; above the joint's friction */
} ethd__homing_def;

/* Initially all zero. */
typedef struct ethd__homing {
  double begin, last, v, sum; /* rad, rad, rad/s filtered, Nm */
  double time, still, travel; /* s since the beginning; s for which it has stood; rad moved in this stretch */
  bool begun, towards;
  const char *failure;
} ethd__homing;

/* Adds a sample of the joint, dt s after the one before; `mark`: the index mark has passed since then.
   ETHD_STATUS_BUSY: command *torque until the next sample. ETHD_OK: found; the joint is at the place now (STOP) or was
   there when the mark passed (INDEX). ETHD_E_DEVICE: `failure` has the reason. *torque: zero unless BUSY. */
ETHD_MUST_CHECK ethd_status ethd__homing_turn(const ethd__homing_def *def, ethd__homing *homing, double q, double dt,
                                              bool mark, double *torque);

#endif
