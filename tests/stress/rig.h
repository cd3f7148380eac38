/* Runs the library's whole step against an exactly computed mass, so that no integrator stands between formula and
   measurement.

      push                          arm parallel, links at 90 and 0 degrees: x is driven by joint 1
        |   |//////  wall           alone, with the inertia m L^2
        v   |//////
     ( ring )|/////   wall on the left: n = (-1, 0), d_re = gap at the start                           */
#ifndef ETHD_TESTS_STRESS_RIG_H
#define ETHD_TESTS_STRESS_RIG_H

#include <stdbool.h>

#include "ethd/control.h"
#include "sim/body.h"

#define ETHD__STRESS_RIG_DELAY_MAX 16
#define ETHD__STRESS_RIG_STRAIGHT ETHD_ARM_LINK_MAX /* m: links on which a joint's turn is a straight line */

typedef struct ethd__stress_rig {
  ethd_setup setup; /* changed before start */
  double mass;      /* kg at the ring, both joints alike */
  double gap;       /* m to the wall at the start */
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
  ethd_scene *scene;
  ethd_control *control;
  double q[2], w[2]; /* rad, rad/s: true at the present tick */
  double way[ETHD__STRESS_RIG_DELAY_MAX][2];
  int64_t tick;
  int64_t missed; /* periods that went by since the last step without one */
  ethd_status status;
  ethd_command command;
  ethd_trace trace; /* of the last tick */
} ethd__stress_rig;

/* Opens a rig with the default setup without tracking and friction, `gap` m from the wall (d_re; < 0: inside). */
void ethd__stress_rig_open(ethd__stress_rig *rig, double mass, double gap);

/* Sets a number of a setup by its name; exits where that is refused. */
void ethd__stress_set(ethd_setup *setup, const char *name, double value);

/* Chooses the velocity estimator; `value` is its first parameter where it has one: a cutoff or a window. */
void ethd__stress_rig_velocity(ethd__stress_rig *rig, ethd_velocity_method method, double value);

/* Brakes with `damping` Ns/m until the ring is slower than v_th m/s, however long and deep that gets. */
void ethd__stress_rig_brakes(ethd__stress_rig *rig, double damping, double v_th);

/* Creates the controller and starts the ring with `speed` m/s into the wall. Exits when the setup is refused. */
void ethd__stress_rig_start(ethd__stress_rig *rig, double speed);
void ethd__stress_rig_close(ethd__stress_rig *rig);

/* Lets this push act from now on; the delayed torques already balance it (start does so for rig->push). */
void ethd__stress_rig_push(ethd__stress_rig *rig, ethd_vec push);

/* Runs one tick: a step, then the mass moves for a period. */
const ethd_trace *ethd__stress_rig_tick(ethd__stress_rig *rig);

/* Run the two halves of a tick. A move without a step before it is a lost tick, in which the torque stays. */
const ethd_trace *ethd__stress_rig_step(ethd__stress_rig *rig);
void ethd__stress_rig_move(ethd__stress_rig *rig);

/* Returns a tick's sense by the rig's present state. */
ethd_sense ethd__stress_rig_sense(const ethd__stress_rig *rig);

/* Return how far and how fast the ring is along n, m and m/s: joint 1's angle times L. */
double ethd__stress_rig_depth(const ethd__stress_rig *rig);
double ethd__stress_rig_speed(const ethd__stress_rig *rig);

/* Measures how a swing grows, ln per tick. For a pair of modes z, z* of x_k, the `order`-th differences of the motion,
   x_k^2 - x_k+1 x_k-1 is proportional to |z|^2k exactly, whatever the phase is (for one real mode it is 0, and the
   motion itself is measured). It is measured from tick `settle` on over `span` ticks: INFINITY as soon as a difference
   is over `ceiling` m, the mean so far once differences are below `floor` m. */
typedef struct ethd__swing {
  int order, settle, span;
  double floor, ceiling;
} ethd__swing;

double ethd__stress_rig_growth(ethd__stress_rig *rig, const ethd__swing *swing);

/* Returns a scene of one half-plane; exits without memory. */
ethd_scene *ethd__stress_rig_wall(double c);

#endif
