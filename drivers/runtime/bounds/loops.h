/* The sampled loops of a setup on a device (tracking, wall and braking, each along x and along y), and the distance of
   each of their numbers from instability. Links from libethd-drivers. Pure functions. [any] */
#ifndef ETHD__BOUNDS_LOOPS_H
#define ETHD__BOUNDS_LOOPS_H

#include "bounds/stability.h"
#include "ethd/sim.h"

typedef enum ethd__bounds_kind {
  ETHD_LOOP_TRACKING,
  ETHD_LOOP_WALL,
  ETHD_LOOP_BRAKING,
  ETHD_LOOP_KINDS
} ethd__bounds_kind;

extern const char *const ethd__bounds_names[ETHD_LOOP_KINDS];

/* The numbers of a device on which stability depends. NaN: unknown. */
typedef struct ethd__bounds_device {
  double mass[2];           /* kg at the ring along x and y, with the mass pressed against it */
  double motor_mass;        /* kg, its part on the motor's side of the transmission; 0: the transmission is rigid */
  double spring, damper;    /* N/m, Ns/m of the transmission */
  double delay;             /* s from measurement to torque; an unknown one counts as 0 */
  double friction, viscous; /* N, Ns/m at the ring */
  double count;             /* rad per encoder count at the joint; 0: ideal */
} ethd__bounds_device;

/* Returns the numbers of a plant, with the share `hand` of its finger's mass pressed against the ring. */
ethd__bounds_device ethd__bounds_device_of(const ethd_plant *plant, double hand);

/* The point at which tracking's stiffness and damping are stated, m. */
#define ETHD_LOOP_FELT_X 0.25
#define ETHD_LOOP_FELT_Y 0.25

/* Stiffness and damping of tracking at the ring at that point: the matrix J^-T K J^-1, N/m and Ns/m. */
typedef struct ethd__bounds_felt {
  double stiffness[2], damping[2];         /* along x and y */
  double stiffness_across, damping_across; /* off the diagonal */
} ethd__bounds_felt;

/* Fills stiffness and damping at that point. False: the law names no stiffness, or the arm doesn't reach the point. */
bool ethd__bounds_feel(const ethd_setup *setup, ethd__bounds_felt *out);

/* The gains of a loop, by the names of their keys ("contact.k_e"); a gain that the law lacks has no key, and is 0. */
typedef struct ethd__bounds_gains {
  char stiffness_key[48], damping_key[48];
  double stiffness, damping;
} ethd__bounds_gains;

/* Fills the gains that the loop's law names (ethd_gains). False: the law names no gains, so the loop's stability is
   unknown. */
bool ethd__bounds_gains_of(const ethd_setup *setup, ethd__bounds_kind kind, ethd__bounds_gains *out);

/* Returns the law of a loop that doesn't name its gains, NULL if it does. */
const ethd_law *ethd__bounds_unjudged(const ethd_setup *setup, ethd__bounds_kind kind);

/* Fills the loop along an axis (0: x, 1: y); an unknown mass is 1 kg. False: its gains aren't known, or the stiffness
   of tracking. */
bool ethd__bounds_of(const ethd_setup *setup, const ethd__bounds_device *device, ethd__bounds_kind kind, int axis,
                     ethd__sampled_loop *out);

/* The numbers of a loop that have a bound: gains, mass and delay, and the estimator's cutoff or window. */
typedef enum ethd__bounds_number {
  ETHD_LOOP_STIFFNESS,
  ETHD_LOOP_DAMPING,
  ETHD_LOOP_MASS,
  ETHD_LOOP_DELAY,
  ETHD_LOOP_VELOCITY,
  ETHD_LOOP_NUMBERS
} ethd__bounds_number;

typedef struct ethd__bounds_row {
  ethd__bounds_number number;
  double value, end; /* SI; end: the value at which the loop becomes unstable while the other numbers stay */
  bool least;        /* the value must stay above its end, not below it */
  double margin;     /* factor by which the value may change; NaN if it is 0 */
} ethd__bounds_row;

/* Fills the rows of a loop with damping, which ethd-check prints; returns their number. */
int ethd__bounds_rows(const ethd__sampled_loop *loop, ethd__bounds_row out[ETHD_LOOP_NUMBERS]);

/* The margin that every loop must have. */
typedef struct ethd__bounds_margin {
  double gain;  /* largest factor on its stiffness, on its damping, and on both at once */
  double delay; /* s: largest additional delay of a torque */
} ethd__bounds_margin;

/* Returns whether the loop has the margin. A loop without gains does. */
bool ethd__bounds_keeps(const ethd__sampled_loop *loop, const ethd__bounds_margin *margin);

/* The effect of friction on a loop that is unstable without it: it stops oscillations of the motor's side slower than
   `held`. If an encoder count makes the motor's side faster than that, a lasting oscillation begins. */
typedef struct ethd__bounds_hold {
  double needed; /* Ns/m that the loop lacks; 0: it is stable */
  double held;   /* m/s; INFINITY: friction stops every oscillation, NaN: friction isn't known */
  double kick;   /* m/s that one count causes; NaN: the count isn't known */
} ethd__bounds_hold;

ethd__bounds_hold ethd__bounds_holds(const ethd__sampled_loop *loop, const ethd__bounds_device *device);

#endif
