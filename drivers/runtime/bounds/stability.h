/* Stability of the sampled loop: a free mass under zero-order hold, with feedback of its position at the ticks
   (stiffness) and of its estimated speed (damping).

        F_k = -K x_k - B v^_k ,  delayed by n ticks        x: ring along one axis
             .------.     .------.
     F ----> | ZOH  |---->| 1/ms2|----+----> x             linear, so its spectral radius decides:
             '------'     '------'    | tick               < 1 settles, > 1 grows
         .---------------.  v^ .------+---.
     <---| -(K x + B v^) |<----| estimator|
         '---------------'     '----------'
   With an elastic transmission, the force acts on the motor's side, where the position is measured, and the rest
   of the mass hangs on it by a spring and a damper; their motion over a tick is exact, too. Coulomb friction is left
   out, because it stops only small oscillations; ethd__sampled_held gives their size. Pure functions. [any] */
#ifndef ETHD__BOUNDS_STABILITY_H
#define ETHD__BOUNDS_STABILITY_H

#include <stdbool.h>

#include "ethd/estimate.h"

#define ETHD_LOOP_DELAY_MAX 20

typedef struct ethd__sampled_loop {
  double mass;               /* m, kg: all of it */
  double motor_mass;         /* kg, its part on the motor's side; 0, or not less than mass: the transmission is rigid */
  double spring, damper;     /* N/m, Ns/m of the transmission */
  double viscous;            /* Ns/m of friction on the motor's side, or on the whole mass if the device is rigid */
  double period;             /* T, s */
  double stiffness, damping; /* K N/m, B Ns/m */
  int delay;                 /* n, whole ticks from measurement to force, 0 to ETHD_LOOP_DELAY_MAX */
  double late;               /* s of delay beyond them, 0 <= late < T */
  /* The estimator with its parameters, as in a setup. foaw counts with its longest window, its worst case. */
  ethd_velocity_method method;
  double p[ETHD_PARAMS_MAX];
  double link; /* m: joint angle to ring position; kalman's noise and inertia are the joint's */
} ethd__sampled_loop;

/* Returns whether the transmission is elastic. */
static inline bool ethd__sampled_gives_way(const ethd__sampled_loop *loop) {
  return loop->motor_mass > 0 && loop->motor_mass < loop->mass;
}

/* Sets delay and late to a delay, s. */
void ethd__sampled_set_delay(ethd__sampled_loop *loop, double delay);

/* Returns the spectral radius of one tick, exact to 1e-7. */
double ethd__sampled_radius(const ethd__sampled_loop *loop);
bool ethd__sampled_stable(const ethd__sampled_loop *loop);

/* Returns K (T (n + 1/2) + late), Ns/m: with less damping the loop is unstable for any mass. */
double ethd__sampled_damping_needed(const ethd__sampled_loop *loop);

/* Returns the smallest mass above which the gains are stable, INFINITY if they aren't up to 1e4 kg. */
double ethd__sampled_mass_min(const ethd__sampled_loop *loop);

/* Return the largest stable value of one gain while the other stays as it is; 0: there is none. With an elastic
   transmission there may be several bands of stable values; then it is the end of the band with the gain's present
   value, if that is stable. */
double ethd__sampled_stiffness_max(const ethd__sampled_loop *loop);
double ethd__sampled_damping_max(const ethd__sampled_loop *loop);

/* Returns whether the loop is stable now and on the whole path to the given multiples of its stiffness and damping. */
bool ethd__sampled_stable_up_to(const ethd__sampled_loop *loop, double stiffness_times, double damping_times);

/* Returns whether the loop is stable with its delay and with each delay that is at most `more` s longer. */
bool ethd__sampled_stable_later(const ethd__sampled_loop *loop, double more);

/* Returns the longest stable delay, s, below 20 ticks: the end of the band with the loop's own delay, if that is
   stable; < 0: there is none. */
double ethd__sampled_delay_max(const ethd__sampled_loop *loop);

/* Returns the estimator's bound: the lowest stable cutoff of lowpass (1 is the table's end), or the longest stable
   window of lsq and foaw; NaN: it has neither, or the loop is unstable. */
double ethd__sampled_velocity_end(const ethd__sampled_loop *loop);

/* Returns the least viscous friction, Ns/m on the motor's side, with which the loop is stable; INFINITY: none, up to
   the friction that stops the motor's side within a hundredth of a tick. */
double ethd__sampled_viscous_needed(const ethd__sampled_loop *loop);

/* Returns the speed, m/s of the motor's side, up to which Coulomb friction `coulomb` N and the viscous friction
   together stop an oscillation of a loop that needs `needed` Ns/m: 4 coulomb / (pi (needed - viscous)), by the
   describing function of Coulomb friction; INFINITY: every oscillation. */
double ethd__sampled_held(double needed, double coulomb, double viscous);

/* Returns the speed, m/s, that one step of the encoder, m at the ring, gives the motor's side within a tick. */
double ethd__sampled_kick(const ethd__sampled_loop *loop, double count);

/* Returns the least friction with which a wall is passive, K T/2 + B (Colgate and Schenkel 1997), Ns/m. */
double ethd__sampled_passive_friction(const ethd__sampled_loop *loop);

#endif
