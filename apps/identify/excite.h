/* Makes a recording for identification, under multisine torques. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_EXCITE_H
#define ETHD__APPS_IDENTIFY_EXCITE_H

#include <stdbool.h>

#include "ethd/maths.h"

typedef struct ethd__excitation {
  const char *config, *record; /* config NULL: the simulated device */
  bool replace, is_virtual;
  double seconds, share, torque; /* share is of the torque limit, Nm; NaN: the device's or the configuration's limit */
  double half;                   /* m, half of the box's side */
  ethd_vec at;                   /* m in R_0, its middle */
} ethd__excitation;

/* Makes the dry run, prints the plan, and runs the session. Returns the program's exit code. */
int ethd__excite(const ethd__excitation *excitation);

#endif
