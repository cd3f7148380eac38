/* Arms alone, ETHD__ARMS of one kind side by side, without finger and pad: the equations of body.h by the series of
   series.h, for those who ask what several plants, or states, make of the same commands. The arms share their steps,
   which are as short as the most demanding of them needs, so that differences between arms that are nearly alike are
   smooth. And the terms of one arm are worked out beside those of the others: within an arm each waits for the one
   before it. */
#ifndef ETHD_SIM_ARMS_H
#define ETHD_SIM_ARMS_H

#include "sim/body.h"

enum { ETHD__ARMS = 4, ETHD__ARMS_TERMS = ETHD__ORDER_MAX + 2 };

/* Coefficients as in ethd__body, of both joints. The torque is that in effect, Nm. */
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

/* Absolute angles of the links, motors' sides of the joints where the transmission gives way, and their speeds. */
typedef struct ethd__arms_state {
  ethd__two link, link_v, motor, motor_v;
} ethd__arms_state;

/* Term k belongs to (t - begin)^k; speeds have terms 0 to order, angles one more. */
typedef struct ethd__arms_series {
  ethd__two link[ETHD__ARMS_TERMS], link_v[ETHD__ARMS_TERMS], motor[ETHD__ARMS_TERMS], motor_v[ETHD__ARMS_TERMS];
} ethd__arms_series;

/* One step, its length s of each arm. */
typedef struct ethd__arms_step {
  int order;
  double length[ETHD__ARMS];
  ethd__arms_state to[ETHD__ARMS];
  ethd__arms_series series[ETHD__ARMS];
} ethd__arms_step;

/* The bodies are of one mechanism, all with a transmission that gives way or none, and of one tolerance. */
void ethd__arms_prepare(const ethd__body bodies[ETHD__ARMS], ethd__arms *out) ETHD_RT;

void ethd__arms_put(ethd__arms_state *out, const ethd__sim_state *state) ETHD_RT;

/* A step from step->to on, each arm's at most `left` s. Returns whether all arms took the whole of it; else each took
   the same share. */
bool ethd__arms_advance(const ethd__arms *arms, const double left[ETHD__ARMS], ethd__arms_step *step) ETHD_RT;

/* The joints' angles of an arm, as ethd__body_joints has them, `at` s after the step's beginning. */
void ethd__arms_joints(const ethd__arms *arms, const ethd__arms_step *step, int arm, double at, double out[2]) ETHD_RT;

#endif
