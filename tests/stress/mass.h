/* Runs the library's whole step against an exactly computed mass, so that no integrator stands between formula and
   measurement.

      push                          arm parallel, links at 90 and 0 degrees: x is driven by joint 1
        |   |//////  wall           alone, with the inertia m L^2
        v   |//////
     ( ring )|/////   wall on the left: n = (-1, 0), d_re = gap at the start                           */
#ifndef ETHD_TESTS_STRESS_MASS_H
#define ETHD_TESTS_STRESS_MASS_H

#include <stdbool.h>

#include "sim/body.h"
#include "unit/rig.h"

#define MASS_DELAY_MAX 16
#define MASS_STRAIGHT ETHD_ARM_LINK_MAX /* m: links on which a joint's turn is a straight line */

typedef struct mass_rig {
  rig on;      /* its setup is changed before the start */
  double mass; /* kg at the ring, both joints alike */
  double gap;  /* m to the wall at the start */
  /* A transmission that gives way: kg of the mass on the motor's side, N/m, Ns/m; 0: rigid. With one the simulator's
     arm moves, and push and friction act on the motor's side. */
  double motor_mass, spring, damper;
  double friction; /* N at the ring, Coulomb's */
  int delay;       /* ticks from measurement to torque */
  bool measured;   /* 1: joint speeds are measured, 0: the setup estimates them */
  bool has_finger;
  ethd_vec finger, finger_v; /* m, m/s; without one it is where the ring is */
  ethd_vec push;             /* N on the ring from outside */
  double force_limit;        /* N: torque limit of each joint / L; INFINITY: none */

  ethd__body body;
  ethd__sim_state state; /* of both, where the transmission gives way */
  double q[2], w[2];     /* rad, rad/s: true at the present tick */
  double way[MASS_DELAY_MAX][2];
  int64_t tick;
  int64_t missed; /* periods that went by since the last step without one */
} mass_rig;

/* Opens a rig with the default setup without tracking and friction, `gap` m from the wall (d_re; < 0: inside). */
void mass_open(mass_rig *r, double mass, double gap);

/* Chooses the velocity estimator; `value` is its first parameter where it has one: a cutoff or a window. */
void mass_velocity(mass_rig *r, ethd_velocity_method method, double value);

/* Brakes with `damping` Ns/m until the ring is slower than v_th m/s, however long and deep that gets. */
void mass_brakes(mass_rig *r, double damping, double v_th);

/* Creates the controller and starts the ring with `speed` m/s into the wall. Fails when the setup is refused. */
void mass_start(mass_rig *r, double speed);
void mass_close(mass_rig *r);

/* Lets this push act from now on; the delayed torques already balance it (start does so for r->push). */
void mass_push(mass_rig *r, ethd_vec push);

/* Runs one tick: a step, then the mass moves for a period. */
const ethd_trace *mass_tick(mass_rig *r);

/* Run the two halves of a tick. A move without a step before it is a lost tick: the torque stays. */
const ethd_trace *mass_step(mass_rig *r);
void mass_move(mass_rig *r);

/* Returns a tick's sense by the rig's present state. */
ethd_sense mass_sense(const mass_rig *r);

/* Return how far and how fast the ring is along n, m and m/s: joint 1's angle times L. */
double mass_depth(const mass_rig *r);
double mass_speed(const mass_rig *r);

/* Measures how a swing grows, ln per tick. For a pair of modes z, z* of x_k, the `order`-th differences of the motion,
   x_k^2 - x_k+1 x_k-1 is proportional to |z|^2k exactly, whatever the phase is (for one real mode it is 0, and the
   motion itself is measured). It is measured from tick `settle` on over `span` ticks: INFINITY as soon as a difference
   is over `ceiling` m, the mean so far once differences are below `floor` m. */
typedef struct swing_span {
  int order, settle, span;
  double floor, ceiling;
} swing_span;

double mass_growth(mass_rig *r, const swing_span *swing);

/* ---- figures beside their closed forms ---- */

/* Asserts that |measured - analytic| <= share |analytic|. Words are printf's. */
void near(double measured, double analytic, double share, const char *what, ...) __attribute__((format(printf, 4, 5)));

/* Asserts that |measured - analytic| <= distance. */
void within(double measured, double analytic, double distance, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* Asserts that measured <= most. */
void bound(double measured, double most, const char *what, ...) __attribute__((format(printf, 3, 4)));

/* Returns `some`, or `many` where ETHD_STRESS is set. */
int64_t pick(int64_t some, int64_t many);

#endif
