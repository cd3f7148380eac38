/* A plan of the front for space: a posted setup with all values that [main] can compute from it. */
#ifndef ETHD__SPACE_PLAN_H
#define ETHD__SPACE_PLAN_H

#include "core/plan.h"
#include "ethd/space.h"

#define ETHD__FACES 7 /* of the workspace: a box's six and the ball's */

typedef struct ethd__space_plan {
  ethd__core_plan core;
  ethd_space_setup setup;
  ethd_filter filter;
  bool has_box, has_ball; /* the workspace has bounds */
  bool watches_finger;    /* finger_age or finger_lost is set */
  bool watches_rim;       /* of a cap */
} ethd__space_plan;

/* Refuses a setup that ethd_space_setup_default didn't make (ETHD_E_ARGUMENT), or made for other headers
   (ETHD_E_SIZE). */
ethd_status ethd__space_setup_made(const void *setup, ethd_error *error);

/* Checks the setup and makes the plan; a failure leaves the plan undefined. [main] */
ethd_status ethd__space_prepare(const ethd_space_setup *setup, ethd__space_plan *out, ethd_error *error);

#endif
