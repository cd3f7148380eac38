/* ETHD__ARMS arms of one kind, side by side, without finger and pad: the equations of body.h by the series of series.h,
   to compare the responses of several plants, or states, to the same commands. The arms share their steps. The most
   demanding arm sets the step's length, so that differences between nearly equal arms are smooth. Computing several
   arms together is also fast: within one arm each term depends on the term before it, and meanwhile the processor
   computes the other arms' terms. */
#ifndef ETHD__SIM_ARMS_H
#define ETHD__SIM_ARMS_H

#include "sim/body.h"

enum { ETHD__ARMS = 4, ETHD__ARMS_TERMS = ETHD__ORDER_MAX + 2 };

/* Coefficients as in ethd__body, for both joints. `torque` is the one in effect, Nm. */
typedef struct ethd__arms_body {
  ethd__two torque, torque_max, length, inertia, inverse_inertia, inverse_motor_inertia;
  ethd__two stiffness, damping, friction, viscous, sharpness;
  double coupling;
} ethd__arms_body;

typedef struct ethd__arms {
  bool serial, compliant, coupled;
  double tolerance;
  int order_max;
  ethd__arms_body body[ETHD__ARMS];
} ethd__arms;

/* Absolute angles of the links, angles of the joints' motor sides if the transmission is compliant, and their
   speeds. */
typedef struct ethd__arms_state {
  ethd__two link, link_v, motor, motor_v;
} ethd__arms_state;

/* Term k belongs to (t - begin)^k; speeds have terms 0 to order, angles one more. */
typedef struct ethd__arms_series {
  ethd__two link[ETHD__ARMS_TERMS], link_v[ETHD__ARMS_TERMS], motor[ETHD__ARMS_TERMS], motor_v[ETHD__ARMS_TERMS];
} ethd__arms_series;

/* One step; each arm has its own length, s. */
typedef struct ethd__arms_step {
  int order;
  double length[ETHD__ARMS];
  ethd__arms_state to[ETHD__ARMS];
  ethd__arms_series series[ETHD__ARMS];
} ethd__arms_step;

/* Prepares arms. The bodies must have the same mechanism and tolerance, and either all or none have a compliant
   transmission. */
void ethd__arms_prepare(const ethd__body bodies[ETHD__ARMS], ethd__arms *out) ETHD_RT;

void ethd__arms_put(ethd__arms_state *out, const ethd__sim_state *state) ETHD_RT;

/* Makes a step from step->to on, at most left[i] s long for arm i. Returns whether all arms made it in full; else each
   made the same share. */
bool ethd__arms_advance(const ethd__arms *arms, const double left[ETHD__ARMS], ethd__arms_step *step) ETHD_RT;

/* Fills an arm's joint angles, as ethd__body_joints does, `at` s after the step's beginning. */
void ethd__arms_joints(const ethd__arms *arms, const ethd__arms_step *step, int arm, double at, double out[2]) ETHD_RT;

#endif
