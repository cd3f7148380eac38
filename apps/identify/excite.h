/* A recording for identification, made by a device that moves by itself. All [main]. */
#ifndef ETHD_APPS_IDENTIFY_EXCITE_H
#define ETHD_APPS_IDENTIFY_EXCITE_H

#include <stdbool.h>

#include "ethd/vec.h"

typedef struct ethd__excitation {
  const char *config, *record; /* config NULL: the simulated device */
  bool replace, is_virtual;
  double seconds, share, torque; /* of the torque limit; Nm, NaN: the device's or the configuration's */
  double half;                   /* m */
  ethd_vec at;                   /* m in R_0 */
} ethd__excitation;

/* Dry run, what will be done, and the session. The exit code. */
int ethd__excite(const ethd__excitation *excitation);

#endif
