/* Stopping at a wall, in closed form: the ring meets the wall at v, and the finger ahead of it continues at v.

        finger   ring        |//////     lag      how far the finger is ahead of the ring's centre
          ( o   )    --> v   |//////     gap      R_r - R_f: the pad touches when the finger is that far ahead
        |<-lag->|            |//////     a        (F_sat + f_c)/m: the quickest stop
   Ticks are left out, except half a period until the contact is seen and half a period of hold. Pure
   functions. [any] */
#ifndef ETHD__BOUNDS_STOP_H
#define ETHD__BOUNDS_STOP_H

typedef struct ethd__bounds_stop {
  double mass;              /* kg at the ring, along one axis */
  double force;             /* F_sat, N: the torque limit / L */
  double friction, viscous; /* f_c N, b_v Ns/m */
  double stiffness;         /* K_x of tracking along the motion, N/m at the ring */
  double behind;            /* s: delay of the finger's estimate */
  double gap;               /* m */
} ethd__bounds_stop;

double ethd__stop_deceleration(const ethd__bounds_stop *stop);

/* Returns the steady lag, m: (f_c + b_v v)/K_x, plus the part of the estimate's delay. */
double ethd__stop_lag(const ethd__bounds_stop *stop, double speed);

/* Returns the margin gap - lag - v^2/(2a), m. If it is >= 0, the ring stands still when the finger touches it. */
double ethd__stop_margin(const ethd__bounds_stop *stop, double speed);

/* Returns the highest speed with margin >= 0, m/s, 0 if there is none. */
double ethd__stop_speed(const ethd__bounds_stop *stop);

/* Braking from `speed` down to v_th with B_d by motors that saturate, `delay` s late: Delta_s, s, and eps, m. */
typedef struct ethd__bounds_braking {
  double damping, v_th, period, delay;
} ethd__bounds_braking;

double ethd__braking_time(const ethd__bounds_stop *stop, const ethd__bounds_braking *braking, double speed);
double ethd__braking_depth(const ethd__bounds_stop *stop, const ethd__bounds_braking *braking, double speed);

#endif
