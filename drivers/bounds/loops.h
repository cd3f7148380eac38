/* The sampled loops of a setup on a device: tracking, the wall and braking, along x and along y. Pure functions. [any] */
#ifndef ETHD_BOUNDS_LOOPS_H
#define ETHD_BOUNDS_LOOPS_H

#include "bounds/stability.h"
#include "ethd/control.h"

typedef enum ethd__loop_kind { ETHD_LOOP_TRACKING, ETHD_LOOP_WALL, ETHD_LOOP_BRAKING, ETHD_LOOP_KINDS } ethd__loop_kind;

extern const char *const ethd__loop_names[ETHD_LOOP_KINDS];

/* What moves, and how late a torque is. */
typedef struct ethd__loop_device {
  double mass[2]; /* kg at the ring along x and y, what is pressed against it included */
  double delay;   /* s from measurement to torque */
} ethd__loop_device;

/* Stiffness and damping of tracking as they are felt at the ring at (0.25, 0.25) m, along x and y: the diagonal of
   J^-T K J^-1, N/m and Ns/m. False: the law has no k_t, or the arm doesn't reach there. */
bool ethd__loop_felt(const ethd_setup *setup, double stiffness[2], double damping[2]);

/* The loop along an axis (0: x, 1: y). A gain that the law hasn't is 0. False: tracking that ethd__loop_felt can't say. */
bool ethd__loop_of(const ethd_setup *setup, const ethd__loop_device *device, ethd__loop_kind kind, int axis,
                   ethd__sampled_loop *out);

/* What is asked of every loop. */
typedef struct ethd__loop_margin {
  double gain;  /* its stiffness, its damping, and both at once may be that many times as large */
  double delay; /* s: a torque may be that much later */
} ethd__loop_margin;

/* Whether the loop is stable as it is and at each of these. A loop without gains is. */
bool ethd__loop_keeps(const ethd__sampled_loop *loop, const ethd__loop_margin *margin);

#endif
