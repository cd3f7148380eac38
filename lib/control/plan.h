/* A plan: a posted setup with all values that [main] can compute from it before a tick. */
#ifndef ETHD__CONTROL_PLAN_H
#define ETHD__CONTROL_PLAN_H

#include "core/plan.h"

/* The places of objects: 0 is the scene that stands still, i is bodies[i - 1]. */
#define ETHD__PLACES (1 + ETHD_BODIES_MAX)

static inline const ethd_scene *ethd__place_scene(const ethd_setup *setup, int place) ETHD_RT {
  return place == 0 ? setup->scene : setup->bodies[place - 1];
}

typedef struct ethd__plan {
  ethd__core_plan core;
  ethd_setup setup;
  int64_t period_ns;      /* setup.period, rounded */
  int places;             /* places from here on have no scene */
  bool has_rare_limits;   /* one of the limits that most setups don't have is set: gap, joints, reach, heat */
  bool watches_finger;    /* limits.finger_age or finger_lost is set */
  ethd_velocity velocity; /* estimators, prepared */
  ethd_fit fit;
  ethd_filter filter;
  double lag;                 /* s, of the velocity estimate */
  ethd_guard_device device;   /* the guard's model of it */
  double brake_time;          /* s in which full torque brakes from limits.speed; 0: no limit, or a mass isn't known */
  double mobility[2];         /* 1/(kg m^2): inverse inertia of the links' absolute angles; NaN: not known */
  double lag_least, lag_most; /* least and largest of setup.ray_lag and 0, s; equal: no ray lags */
  /* the contact law's parameters for each material of each place */
  double material_p[ETHD__PLACES][ETHD_MATERIALS_MAX][ETHD_PARAMS_MAX];
} ethd__plan;

/* Checks the setup and makes the plan; a failure leaves the plan undefined. [main] */
ethd_status ethd__plan_prepare(const ethd_setup *setup, ethd__plan *out, ethd_error *error);

/* Returns the contact law's parameters on a material of a place; -1 is no material. [rt] */
static inline const double *ethd__contact_p(const ethd__plan *plan, int place, int32_t material) ETHD_RT {
  return material < 0 ? plan->core.contact_p : plan->material_p[place][material];
}

#endif
