/* Stopping at a wall, in closed form: the ring meets it at v behind a finger that goes on at v.

        finger   ring        |//////     lag      finger ahead of the ring's centre
          ( o   )    --> v   |//////     gap      R_r - R_f: the pad touches when it is that far ahead
        |<-lag->|            |//////     a        (F_sat + f_c)/m: no ring stops quicker
   Ticks are left out, but for half a period until the contact is seen and half a period of hold. Pure
   functions. [any] */
#ifndef ETHD_CHECK_STOP_H
#define ETHD_CHECK_STOP_H

typedef struct ethd__bounds_stop {
  double mass;              /* kg at the ring, along one axis */
  double force;             /* F_sat, N: the torque limit / L */
  double friction, viscous; /* f_c N, b_v Ns/m */
  double stiffness;         /* K_x of tracking along the motion, N/m at the ring */
  double behind;            /* s by which the finger's estimate is behind the finger */
  double gap;               /* m */
} ethd__bounds_stop;

double ethd__stop_deceleration(const ethd__bounds_stop *stop);

/* Steady lag: (f_c + b_v v)/K_x, and what an estimate adds that is behind, m. */
double ethd__stop_lag(const ethd__bounds_stop *stop, double speed);

/* Rest at touch: the ring stands when the finger reaches it iff gap - lag - v^2/(2a) >= 0; this, m. */
double ethd__stop_margin(const ethd__bounds_stop *stop, double speed);

/* The highest speed with margin >= 0, m/s; 0: none. */
double ethd__stop_speed(const ethd__bounds_stop *stop);

/* Saturated braking from `speed` down to v_th with B_d, `delay` s late: Delta_s, s, and eps, m. */
typedef struct ethd__bounds_braking {
  double damping, v_th, period, delay;
} ethd__bounds_braking;

double ethd__braking_time(const ethd__bounds_stop *stop, const ethd__bounds_braking *braking, double speed);
double ethd__braking_depth(const ethd__bounds_stop *stop, const ethd__bounds_braking *braking, double speed);

#endif
