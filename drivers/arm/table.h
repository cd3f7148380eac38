/* The description of an arm as an INI file.

     [arm]
     convention = standard       of the rows of Denavit and Hartenberg's numbers: linkage.h
     safe = hold                 its safe state. hold: it stops within its accelerations and holds its position against
                                 gravity; brakes: its brakes stop it at once, and hold it without power
     [joint1]                    from the base, to [joint7] at most
     d = 0.1625                  m; a and d, alpha and offset (rad) are 0 where they aren't given
     alpha = 1.5707963267948966
     least = -6.28               rad
     most = 6.28
     speed = 3.14                rad/s
     acceleration = 15           rad/s^2
     torque = 150                Nm
     posture = 0                 rad: angle at the start, to which it returns as far as its task allows
     [base]                      of the first row's frame in R_0: x y z, m; roll pitch yaw, rad, as in a URDF
     [tool]                      in the frame behind the last row: x y z, m: the end effector's point; facing_x facing_y
                                 facing_z: from the hand into the plate, of any length
     [servo]                     each joint's speed follows what was commanded by a second order behind a dead time
     frequency = 100             rad/s
     damping = 1                 1: without overshoot
     delay = 0.008               s
     rate = 500                  Hz, of the commands
     [inverse]                   inverse.h and motion.h
     singular = 0.03             m
     pull = 1                    1/s, to the posture
     turn = 5                    1/s, of a plate to its commanded normal, at most 1 rad/s; 0: it isn't rotated

   Numbers without a default must be given. */
#ifndef ETHD__ARM_TABLE_H
#define ETHD__ARM_TABLE_H

#include "arm/linkage.h"
#include "ethd/param.h"

enum { ETHD__ARM_HOLDS, ETHD__ARM_BRAKES };

typedef struct ethd__arm_table {
  ethd__linkage linkage;
  ethd_joint_limits limits; /* of speeds, with the period 1 / rate */
  double posture[ETHD_JOINTS_MAX];
  int32_t safe;
  struct {
    double frequency, damping, delay, rate;
  } servo;
  double singular, pull, turn;
} ethd__arm_table;

/* Reads a table. Every refusal is one line with file:line. [main] */
ETHD_MUST_CHECK ethd_status ethd__arm_table_parse(const char *text, size_t length, const char *name,
                                                  ethd__arm_table *out, char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__arm_table_load(const char *path, const char *name, ethd__arm_table *out,
                                                 char message[ETHD_MESSAGE_MAX]);

#endif
