/* Largest torques of a tap's ticks, and the forces that they make. [any] */
#ifndef ETHD__APPS_REPORT_FORCES_H
#define ETHD__APPS_REPORT_FORCES_H

#include "ethd/arm.h"
#include "tap/ticks.h"

/* What the motors were asked for, and what the guard let through to them. */
typedef struct ethd__strongest {
  double asked_nm, let_nm; /* of either joint */
  double asked_n, let_n;   /* the same torques as a force at the ring */
} ethd__strongest;

ethd__strongest ethd__strongest_of(const ethd_arm *arm, const ethd__tap_rows *rows);

#endif
