/* The guard: the last stage that changes a torque before the device gets it. Links from libethd.

   How it stops a ring. With p = M dq the links' momentum and

     reaction = t_d + T + lag     from a joint sample to the end of its torque's hold; t_d: dynamics.delay,
                                  T: period, lag: of the estimated joint speeds, 0 where they are measured

   the stop commands the torque -p / (e reaction), within the torque limits. A mass m under the damping
   b = m / (e reaction) that acts `reaction` late slows down without overshoot: m v'(t) = -b v(t - r) doesn't
   oscillate up to b r / m = 1/e, and is stable up to pi/2, 4.3 times as much (Hale and Verduyn Lunel, Introduction to
   Functional Differential Equations, 1993, 5.2). ethd-check prints the margin of the sampled loop.

   The stop checks whether the device brakes. During a stop the commanded change of speed is at most 1.2 times
   the measured decrease of speed plus a tenth of the speed at the start. So a device with a reversed encoder, or with more delay than stated,
   becomes faster by a tenth at most, and by three tenths if its mass is a third of the stated mass. The stop has no
   measurable effect until t_d + lag have passed, so the fall counts from the highest speed until then. A torque counts
   as held for as long as the last one was. A fall by friction counts, too: with a reversed encoder, a mass stated three
   times too large and a friction that stops the ring by itself, the ring can reach twice the speed at the start.

   A stop ends with zero torque: when the links are slower than 20 mm/s (the paper's v_th, eq. 11), when for longer than
   reaction + T it may command almost nothing because the speed doesn't fall, and at limits.stop_time. An unknown mass
   is assumed to be ETHD_MASS_ASSUMED; a heavier device isn't braked: its torque is removed. An unknown delay is assumed
   to be limits.gap or, without one, ETHD_DELAY_ASSUMED.

   The wall of limits.margin has the gains with which a mass under a force that is `2 reaction` late comes to rest
   quickest without overshoot, a triple root of s^2 + (B s + K) e^(-2 r s) = 0:
   K = 0.0791 m / (2 r)^2, B = 0.461 m / (2 r). A ring that meets it at v goes at most 3.5 v r deep, and comes out again
   at 0.55 v at most, since the wall never pulls. */
#ifndef ETHD_GUARD_H
#define ETHD_GUARD_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/arm.h"

ETHD_BEGIN_DECLS

/* INFINITY, or -INFINITY as a lower bound, means that there is no limit; for margin and clean_time 0 means so.
   Elsewhere 0 is a limit of 0. A limit that isn't set costs no time. */
typedef struct ethd_limits {
  uint32_t size;         /* sizeof(ethd_limits) as compiled, set by ethd_limits_none */
  int32_t latch;         /* 1: faults latch until cleared; 0: each tick is judged alone (replay) */
  double torque;         /* Nm, each joint, >= 0 */
  double torque_rate;    /* Nm/s, each joint, >= 0 */
  double speed;          /* m/s of the ring, >= 0 */
  double workspace[4];   /* m: x_min, x_max, y_min, y_max of the ring's centre */
  double reach[2];       /* m: least and most distance of the ring's centre from the base */
  double joints[4];      /* rad: q1_min, q1_max, q2_min, q2_max */
  double margin;         /* m: within this of the bounds of workspace and reach a wall pushes back, >= 0 */
  double energy;         /* J: energy that a contact may release within half a second before damping is added, > 0 */
  double nominal_torque; /* Nm: continuous torque of each motor, > 0; limits nothing without heat_time */
  double heat_time;      /* s: time constant of a motor's heat, > 0; shorter is stricter */
  double step_time;      /* s: time budget of one step, > 0 */
  double gap;            /* s: longest time between two steps, and the most that a clock may jump, > 0 */
  double finger_age;     /* s: when the finger's reading is older, tracking fades out */
  double finger_lost;    /* s: when it is older, the ring is stopped; the age isn't checked if neither is set */
  double clean_time;     /* s without a reason to stop before an acknowledgement counts, >= 0, finite;
                          longer is stricter */
  double stop_time;      /* s: a stop that lasts longer ends without torque, > 0; INFINITY: ETHD_STOP_TIME */
} ethd_limits;

/* A row for each limit: readers, writers and comparisons use it. */
typedef enum ethd_limit_kind {
  ETHD_LIMIT_MOST,  /* a smaller number is stricter; INFINITY is no limit */
  ETHD_LIMIT_LEAST, /* a larger number is stricter; the row's min is no limit */
  ETHD_LIMIT_RANGES /* pairs of a least and a most */
} ethd_limit_kind;

typedef struct ethd_limit {
  const char *name, *unit;
  uint32_t offset, count; /* in ethd_limits, bytes; doubles */
  ethd_limit_kind kind;
  double min, max; /* of the value */
  const char *brief;
} ethd_limit;

#define ETHD_LIMITS 16
#define ETHD_STOP_TIME 0.1 /* s */
ETHD_API extern const ethd_limit ethd_limit_rows[ETHD_LIMITS];

/* Returns where the first of the row's numbers is in these limits, in the row's unit. [any, rt-safe] */
static inline double *ethd_limit_of(ethd_limits *limits, const ethd_limit *row) ETHD_RT {
  return (double *)(void *)((char *)limits + row->offset);
}

/* Fill `out`, of `size` bytes, with no limits, and make `limits` the stricter of two, for the functions below. Limits
   made with another version's headers become zero, or keep their `size`: ethd_limits_check refuses them. [any] */
ETHD_API void ethd_limits_fill(ethd_limits *out, uint32_t size);
ETHD_API void ethd_limits_narrow(ethd_limits *limits, const ethd_limits *other);

/* Returns no limits, but with `latch` set. [any] */
static inline ethd_limits ethd_limits_none(void) {
  ethd_limits limits;
  ethd_limits_fill(&limits, (uint32_t)sizeof limits);
  return limits;
}

/* Returns ethd_limits_none with a limit of the torque, Nm. [any] */
static inline ethd_limits ethd_limits_torque(double torque) {
  ethd_limits limits = ethd_limits_none();
  limits.torque = torque;
  return limits;
}

/* Returns initial limits for a driver of a real device: gap 5 ms, clean_time 1 s, finger_age 10 ms, finger_lost 30 ms,
   and no other limit. [any] */
static inline ethd_limits ethd_limits_device(void) {
  ethd_limits limits = ethd_limits_none();
  limits.gap = 0.005;
  limits.clean_time = 1;
  limits.finger_age = 0.010;
  limits.finger_lost = 0.030;
  return limits;
}

/* Checks each number against its row: ETHD_E_RANGE or ETHD_E_NOT_FINITE with the limit's name; ETHD_E_SIZE if they
   weren't made by this version's ethd_limits_none. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_limits_check(const ethd_limits *limits, ethd_error *error);

/* Returns the stricter of two, limit by limit; it latches if either does. [any] */
static inline ethd_limits ethd_limits_narrower(const ethd_limits *a, const ethd_limits *b) {
  ethd_limits limits = *a;
  ethd_limits_narrow(&limits, b);
  return limits;
}

/* The guard's actions, as bits; the counters count ticks. */
enum {
  ETHD_GUARD_FINITE = 1,     /* torque not finite: zero torque in this tick; the controller latches it */
  ETHD_GUARD_TORQUE = 2,     /* clamped */
  ETHD_GUARD_RATE = 4,       /* slope limited */
  ETHD_GUARD_SPEED = 8,      /* ring too fast: stopped as said above, then zero torque, latched */
  ETHD_GUARD_WORKSPACE = 16, /* ring out of its workspace: stopped as for speed */
  ETHD_GUARD_FAULT = 32,     /* a row of the fault table stops the ring, as for speed */
  ETHD_GUARD_MARGIN = 64,    /* the workspace's wall pushed */
  ETHD_GUARD_HEAT = 128,     /* clamped to the limit of a hot motor */
  ETHD_GUARD_STEEP = 256     /* the requested torque changed faster than the rate for ETHD_STEEP_MAX ticks in a row,
                                and limits latch: stopped as for speed */
};
#define ETHD_GUARD_COUNT 9
#define ETHD_STEEP_MAX 20

/* The progress of a stop. */
typedef struct ethd_guard_stop {
  int64_t begun;   /* 1: a stop goes on, which the members below describe */
  double start;    /* speed of the links when it began, m/s */
  double highest;  /* highest speed until its first torque can show, m/s */
  double given;    /* change of speed commanded so far, m/s */
  double time;     /* s since it began */
  double mark;     /* `given` when it last rose by a hundredth of `start`, m/s */
  double helpless; /* s since then */
} ethd_guard_stop;

typedef struct ethd_guard_state {
  double last[2];  /* torque of the last tick, Nm */
  double asked[2]; /* the same before the limits, Nm */
  double heat[2];  /* of each motor; 1: the final value under its nominal torque */
  double cut;      /* s for which the torque has been clamped without a break */
  int64_t steep;   /* ticks in a row with too steep a torque */
  ethd_guard_stop stop;
  uint64_t counts[ETHD_GUARD_COUNT];
  int32_t stopping; /* ETHD_GUARD_* bits of the reasons to stop the ring, 0: none; callers may set it */
  int32_t stopped;  /* 1: the ring stands still or the stop has failed, so the torque is zero until this is cleared */
} ethd_guard_state;

#define ETHD_MASS_ASSUMED 0.06   /* kg: of a device whose mass isn't known */
#define ETHD_DELAY_ASSUMED 0.020 /* s: of a device whose delay isn't known, without limits.gap */

/* The guard's model of the device. */
typedef struct ethd_guard_device {
  double link[2];    /* m */
  double mass;       /* kg: the lighter of the two at the ring */
  double inertia[2]; /* kg m^2, of the links' absolute angles */
  double serial;     /* 1: joint 2 is relative to link 1; 0: parallel */
  double period;     /* T, s */
  double delay;      /* t_d, s */
  double lag;        /* s, of joint speeds that are estimated */
  double stiffness;  /* N/m, of the margin's wall */
  double damping;    /* Ns/m, of the margin's wall */
} ethd_guard_device;

/* Returns the device of a setup's numbers; lag: s, see ethd_velocity_lag. Numbers that the dynamics don't know are
   assumed as said above. [any] */
ETHD_API ethd_guard_device ethd_guard_device_of(const ethd_arm *arm, const ethd_dynamics *dynamics, double gap,
                                                double period, double lag);

/* Returns the damping with which a stop brakes a mass, m / (e reaction), Ns/m; estimated: joint speeds are estimated.
   [any, rt-safe] */
ETHD_API double ethd_guard_damping(const ethd_guard_device *device, double mass, bool estimated) ETHD_RT;

/* Returns the time, s, in which limits.torque brakes the device from limits.speed, m v / F: the least possible
   stop_time. 0 without a limit of the speed, and if no torque is allowed. [any] */
ETHD_API double ethd_guard_brake_time(const ethd_guard_device *device, const ethd_limits *limits);

/* Returns a stop_time, s, in which a stop from limits.speed ends at rest: brake time, reaction and decay, and a quarter
   more; 0 as above. [any] */
ETHD_API double ethd_guard_stop_time(const ethd_guard_device *device, const ethd_limits *limits);

/* The ring's motion at a tick. */
typedef struct ethd_guard_motion {
  const ethd_pose *pose;
  ethd_vec v;     /* m/s, of the ring in R_0 */
  double qd[2];   /* rad/s */
  bool estimated; /* qd was estimated, not measured */
  double dt;      /* s since the last step */
} ethd_guard_motion;

/* Adds the heat of the last torque, held for dt s, and returns that of the hotter motor. Only to be called where
   nominal_torque is a limit. [rt] */
ETHD_API double ethd_guard_heat(const ethd_limits *limits, ethd_guard_state *state, double dt) ETHD_RT;

/* Limits `torque`, Nm of each joint, in place and returns the bits of its actions. In this order: if the ring is being
   stopped (speed, workspace, a fault), the stop's torque replaces it, else the margin's wall pushes; a torque that
   isn't finite becomes zero; heat and torque bound each joint; unless the ring is being stopped, the rate bounds the
   change, and heat and torque bound the result again. [rt] */
ETHD_API int32_t ethd_guard_step(const ethd_limits *limits, const ethd_guard_device *device, ethd_guard_state *state,
                                 const ethd_guard_motion *motion, double torque[2]) ETHD_RT;

/* ---- joints: keep the commands of an arm's driver within each joint's limits ----

   A joint gets a commanded speed v for each period T, which may fall by a T in one period. Until it stands it travels

     D(v) = v T + (v - a T) T + (v - 2 a T) T + ...  = (k + 1) v T - k (k + 1) a T^2 / 2,   k a T <= v < (k + 1) a T

   This is v^2 / (2 a) + v T / 2 or, between the multiples of a T, up to a T^2 / 8 more. At the distance d from its
   bound the largest allowed v solves D(v) = d: with k the whole part of (sqrt(1 + 8 d / (a T^2)) - 1) / 2,

     v = (d / T + k (k + 1) a T / 2) / (k + 1)

   Then v - a T is allowed in the next period, since D(v - a T) = D(v) - v T, and so on until it stands at the bound: a
   joint within its limits can always stay within them. This holds for the *commanded* q and v: v of the last period,
   and q the sum of the commanded motion, q += v T. A servo that follows late without overshoot, by a delay or a lag of
   first order, moves by averages of its commands, so it stays within the same bounds.

   A torque is a change of speed by torque T / inertia, in which the joint moves by the mean of its speeds before and
   after. The position q + v T / 2 then moves as q does above, and the same bounds hold for it; q, v: measured. The
   torque limit also bounds the fall a T. `inertia` is the joint's own, as if nothing coupled it. */
#define ETHD_JOINTS_MAX 7

typedef enum ethd_joints_kind { ETHD_JOINTS_SPEED, ETHD_JOINTS_TORQUE } ethd_joints_kind;

/* INFINITY, for `least` -INFINITY, is no limit. */
typedef struct ethd_joint_limit {
  double least, most;  /* rad */
  double speed;        /* rad/s, >= 0 */
  double acceleration; /* rad/s^2, >= 1e-6 */
  double torque;       /* Nm, >= 0; only of torques */
  double inertia;      /* kg m^2, >= 0; 0: not known, then a torque is bounded by `torque` alone */
} ethd_joint_limit;

typedef struct ethd_joint_limits {
  uint32_t count; /* of joints, 1 to ETHD_JOINTS_MAX */
  ethd_joints_kind kind;
  double period; /* T, s: for which a command holds, 1e-5 to 1 */
  ethd_joint_limit joint[ETHD_JOINTS_MAX];
} ethd_joint_limits;

/* The limit that bound a command. */
typedef enum ethd_joints_bound {
  ETHD_JOINTS_FREE,
  ETHD_JOINTS_POSITION,
  ETHD_JOINTS_FAST,
  ETHD_JOINTS_ACCELERATION,
  ETHD_JOINTS_STRONG, /* its torque */
  ETHD_JOINTS_FINITE  /* a number wasn't finite: a request of 0 for every joint took its place */
} ethd_joints_bound;

typedef struct ethd_joints_ruling {
  double share;            /* of the requested vector, 0 to 1 */
  int32_t joint;           /* from 0, the joint that bound it; -1: none */
  ethd_joints_bound bound; /* by what */
  int32_t turned;          /* 1: the direction isn't the requested one */
} ethd_joints_ruling;

/* Checks each number against the ranges above: ETHD_E_RANGE, ETHD_E_NOT_FINITE with its name. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_joint_limits_check(const ethd_joint_limits *limits, ethd_error *error);

/* Bounds a command, rad/s or Nm by limits->kind, in place and returns the limit that bound it. q, rad, and v, rad/s: as
   said above. The vector is scaled as a whole, to the largest share that every joint's position and speed (or torque)
   allow. A speed then goes from v towards that, again as a whole, by the largest share that every acceleration allows:
   so the arm's velocity is always between v and the request, and never has a third direction. A joint is bounded alone
   if it must brake for its position, or if it exceeds its bound by less than a millionth of the largest requested
   number. So an arm with a joint at its bound stands still under a command beyond
   it, and obeys a command away from it. Beyond its limits, for example after a person moved it, a joint brakes with its
   acceleration and then may only return. If limits contradict, the torque's come first, then the acceleration's. Limits
   that weren't checked, or q or v that aren't finite: zero for every joint, ETHD_JOINTS_FINITE. [rt] */
ETHD_API ethd_joints_ruling ethd_guard_joints(const ethd_joint_limits *limits, const double *q, const double *v,
                                              double *command) ETHD_RT;

ETHD_END_DECLS

#endif
