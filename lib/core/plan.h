/* The core's part of a plan, made by [main]: the laws, the effector's sizes, and the limits of a contact. */
#ifndef ETHD__CORE_PLAN_H
#define ETHD__CORE_PLAN_H

#include <stdbool.h>

#include "ethd/control.h"

typedef struct ethd__core_plan {
  double period;        /* s */
  double radius;        /* R_r of the effector, m */
  double finger_radius; /* R_f, m */
  double d_beta;        /* R_r - R_f,max, m */
  double v_hysteresis;  /* m/s */
  double swap_time;     /* s */
  double energy;        /* J that a contact may release */
  double damping_max;   /* Ns/m that the passivity controller may add */
  double brake;         /* Ns/m: damping of a force that holds a ruling's speed; 0: the front bounds the speed itself */
  bool watches_energy;  /* `energy` is a limit */
  bool latches;         /* limits.latch */
  bool by_velocity;     /* `follow` calls the law's velocity, not its force */
  int foreign;          /* bits: kinds whose law isn't the library's own */
  const ethd_tracking_law *tracking;
  const ethd_contact_law *contact;
  const ethd_transition_law *transition;
  double tracking_p[ETHD_PARAMS_MAX], transition_p[ETHD_PARAMS_MAX];
  /* the laws' steps as a tick calls them, see fence.h */
  ethd_status (*track)(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT;
  ethd_status (*follow)(const double *p, void *state, const ethd_follow_in *in, ethd_vec3 *out) ETHD_RT;
  ethd_status (*push)(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT;
  ethd_status (*rule)(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT;
  double (*range)(const double *p, double speed) ETHD_RT; /* of the transition law; NULL: it doesn't look ahead */
  double contact_p[ETHD_PARAMS_MAX];                      /* without a material */
} ethd__core_plan;

#endif
