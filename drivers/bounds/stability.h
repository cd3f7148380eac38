/* Stability of the sampled loop: a free mass under zero-order hold, pushed by stiffness and damping that
   see its position at the ticks and its speed through an estimator.

        F_k = -K x_k - B v^_k ,  delayed by n ticks        x: ring along one axis
             .------.     .------.
     F ----> | ZOH  |---->| 1/ms2|----+----> x             linear, so its spectral radius decides:
             '------'     '------'    | tick               < 1 settles, > 1 grows
         .---------------.  v^ .------+---.
     <---| -(K x + B v^) |<----| estimator|
         '---------------'     '----------'
   Friction is left out: it only helps. Pure functions. [any] */
#ifndef ETHD_CHECK_STABILITY_H
#define ETHD_CHECK_STABILITY_H

#include <stdbool.h>

#include "ethd/velocity.h"

#define ETHD_LOOP_DELAY_MAX 20

typedef struct ethd__sampled_loop {
  double mass;               /* m, kg */
  double period;             /* T, s */
  double stiffness, damping; /* K N/m, B Ns/m */
  int delay;                 /* n, whole ticks from measurement to force, 0 to ETHD_LOOP_DELAY_MAX */
  double late;               /* s on top of them, 0 <= late < T */
  /* The estimator with its parameters, as in a setup. foaw stands at its longest window, its worst. */
  ethd_velocity_method method;
  double p[ETHD_PARAMS_MAX];
  double link; /* m: joint angle to ring position; kalman's noise and inertia are the joint's */
} ethd__sampled_loop;

/* Spectral radius of one tick, exact to 1e-7. */
double ethd__sampled_radius(const ethd__sampled_loop *loop);
bool ethd__sampled_stable(const ethd__sampled_loop *loop);

/* Less than K (T (n + 1/2) + late) is unstable however large the mass is, Ns/m. */
double ethd__sampled_damping_needed(const ethd__sampled_loop *loop);

/* The smallest mass from which on the gains are stable; INFINITY: at none up to 1e4 kg. */
double ethd__sampled_mass_min(const ethd__sampled_loop *loop);

/* The largest stable value of one gain with the other as it is; 0: none. */
double ethd__sampled_stiffness_max(const ethd__sampled_loop *loop);
double ethd__sampled_damping_max(const ethd__sampled_loop *loop);

/* The longest delay with which it is stable, s; under one of 20 ticks; < 0: none. */
double ethd__sampled_delay_max(const ethd__sampled_loop *loop);

/* How far the estimator may go: the lowest cutoff of lowpass (1: the table's end), the longest window of
   lsq and foaw; NaN: it has neither, or the loop is unstable as it is. */
double ethd__sampled_velocity_end(const ethd__sampled_loop *loop);

/* Closed forms for the backward difference, whole ticks. The boundary, 0 < th <= pi / (2 (n + 1)):
     K T^2/m = 4 tan^2(th/2) cos((n+1) th),  B T/m = 2 tan(th/2) sin((n+1) th) - K T^2/(2m) */
void ethd__sampled_boundary(double mass, double period, int delay, double th, double *stiffness, double *damping);

/* Its end at K = 0: (2m/T) tan(pi / (4 (n+1))). */
double ethd__sampled_damping_free(double mass, double period, int delay);

/* A wall is passive with at least this much friction, K T/2 + B (Colgate and Schenkel 1997), Ns/m. */
double ethd__sampled_passive_friction(const ethd__sampled_loop *loop);

#endif
