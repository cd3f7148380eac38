/* Properties that every tap on the default wall must have, worked out anew from the published equations:
   n = (-1, 0), wall at x = 0.238 m, the gains of the paper. */
#ifndef ETHD_TESTS_PROPERTIES_H
#define ETHD_TESTS_PROPERTIES_H

#include "tap/metrics.h"

typedef enum kind { ABRUPT, SMOOTH, OFFSET } kind;

/* The controller's numbers that differ between plants. */
typedef struct gains {
  double finger_radius, finger_radius_max; /* m */
  double torque_max;                       /* Nm */
} gains;

/* Each asserts; `where` stands in the message. */
void assert_finite(const ethd__tap_rows *rows, const char *where);
void assert_torque_within(const ethd__tap_rows *rows, const gains *with, const char *where);
void assert_forces(const ethd__tap_rows *rows, kind law, const char *where);
void assert_beta(const ethd__tap_rows *rows, kind law, const gains *with, const char *where);
void assert_beta_jumps(const ethd__tap_rows *rows, kind law, const gains *with, const char *where);
void assert_energy(const ethd__tap_rows *rows, const char *where);

#endif
