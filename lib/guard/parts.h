/* Parts of the guard, all [rt]. */
#ifndef ETHD__GUARD_PARTS_H
#define ETHD__GUARD_PARTS_H

#include <stdbool.h>
#include <string.h>

#include "ethd/guard.h"
#include "ethd/maths.h"

/* The guard's first half: stop or margin's wall, finite, heat and torque limits. Returns ETHD_GUARD_* bits. */
int32_t ethd__guard_limit(const ethd_limits *limits, const ethd_guard_device *device, ethd_guard_state *state,
                          const ethd_guard_motion *motion, double torque[2]) ETHD_RT;

/* The rest of a swap's fade: while it lasts, a torque may exceed its limits by `share` of the excess at the swap. */
typedef struct ethd__guard_faded {
  double share;   /* 0 to 1 */
  double from[2]; /* Nm, >= 0: size of the torque at the swap */
} ethd__guard_faded;

/* The guard's second half: the rate, and heat and torque limits again; remembers the torque. `bits` are the first
   half's; it returns those of both. faded: NULL without a fade. */
int32_t ethd__guard_finish(const ethd_limits *limits, ethd_guard_state *state, const ethd__guard_faded *faded,
                           double dt, int32_t bits, double torque[2]) ETHD_RT;

/* Returns whether the first half's torque is the stop's, or zero because it wasn't finite: it must not be changed. */
static inline bool ethd__guard_stops(const ethd_guard_state *s, int32_t bits) ETHD_RT {
  return s->stopping || (bits & (ETHD_GUARD_SPEED | ETHD_GUARD_WORKSPACE | ETHD_GUARD_FAULT));
}

/* The motion at this tick of the body that a stop brakes. */
typedef struct ethd__stop_motion {
  double speed;    /* m/s */
  double given;    /* m/s^2: acceleration intended by the last command */
  double reaction; /* s, as in ethd/guard.h */
  double period, dt;
} ethd__stop_motion;

/* Counts a tick of the stop, and returns the change of speed, m/s, that it may still command. */
double ethd__stop_allowed(ethd_guard_stop *stop, const ethd__stop_motion *motion) ETHD_RT;

/* Returns whether a stop of at most `most` s is over: the body stands still, or the stop doesn't brake it. */
bool ethd__stop_is_over(const ethd_guard_stop *stop, const ethd__stop_motion *motion, double most) ETHD_RT;

/* Returns the rate, 1/s, of the stop's decay, if `left` m/s may still be commanded, > 0. */
double ethd__stop_decay(const ethd__stop_motion *motion, double left) ETHD_RT;

/* Replaces the torque by the stop's. */
void ethd__guard_stop(const ethd_limits *limits, const ethd_guard_device *device, ethd_guard_state *state,
                      const ethd_guard_motion *motion, double torque[2]) ETHD_RT;

/* Adds the push of the workspace's wall to the torque; returns false if the ring doesn't touch it. */
bool ethd__guard_wall(const ethd_limits *limits, const ethd_guard_device *device, const ethd_guard_motion *motion,
                      double torque[2]) ETHD_RT;

/* Returns the largest torque, Nm, that a motor of this heat may give. */
double ethd__guard_cool(const ethd_limits *limits, double heat) ETHD_RT;

#endif
