/* The plugin ABI: laws of three kinds, each a const table; the controller owns their state. Links from libethd.

   Per tick, for every contact that counts:     transition  ruling: {beta, share, offset, damping}
                                                contact     (gap, speed) -> force along n
   and once:                                    tracking    finger relative to ring -> torque
   The controller composes them:  tau = beta tau_t + J^T sum (share F_e - damping v + feed) n.

   The controller calls a law for near surfaces. It calls a transition law that looks ahead (`range`) for farther ones
   too, with the device's abilities (`facts`), so that the law can act in time.

   A law is stateless code: numbers in, numbers out. It never allocates, never blocks, and keeps nothing of its own.
   Its state is a block of numbers (no pointers) that is zeroed before reset, copied, recorded, hashed.
   Parameters were checked against the table when the setup was posted: step trusts them.
   A law returns ETHD_OK also when there is no force; a contact law that doesn't push then sets *force to 0. A negative
   status, or a number that isn't finite, sends the controller to its safe state. So do two mistakes of laws that aren't
   built in: writing outside of the state block, which guard words around it detect (ETHD_E_FENCE), and changing the
   processor's rounding mode, flushing of small numbers or traps (ETHD_E_FENV). The controller restores both.

   The ABI may break until 1.0. Within an ABI ethd_param is frozen; a step's inputs (ethd_contact, ethd_tracking_in,
   ethd_facts) and the law structs grow at their end, and a law states the size of its struct: a law that was built
   against an older header runs as before. include/README.md has the policy. */
#ifndef ETHD_LAW_H
#define ETHD_LAW_H

#include <stddef.h>
#include <stdint.h>

#include "ethd/maths.h"
#include "ethd/param.h"

ETHD_BEGIN_DECLS

#define ETHD_ABI 1u
#define ETHD_STATE_MAX 512u /* bytes of a law's state block */

typedef enum ethd_kind { ETHD_TRACKING = 0, ETHD_CONTACT = 1, ETHD_TRANSITION = 2 } ethd_kind;

/* First member of each kind's struct. */
typedef struct ethd_law {
  uint32_t size;       /* sizeof the whole law struct as its author compiled it */
  uint32_t abi;        /* ETHD_ABI */
  uint32_t kind;       /* ethd_kind */
  uint32_t state_size; /* bytes, <= ETHD_STATE_MAX; contact and transition: one block per contact */
  const char *id;      /* a-z 0-9 - , 1 to 31 characters */
  const char *brief;   /* one line: 1 to ETHD_BRIEF_MAX printable ASCII characters */
  const ethd_param *params;
  uint32_t param_count;
  /* Checks relations between parameters that rows can't express; NULL: there are none. A negative status refuses the
     post. *error, never NULL, holds the law's id as its name and no numbers at the call. [main] */
  ethd_status (*check)(const double *p, ethd_error *error);
  /* Fills a zeroed state block; NULL: zeros are right. [rt] */
  void (*reset)(const double *p, void *state) ETHD_RT;
} ethd_law;

/* The names of the parameters that are the gains of a law's loop; NULL: the law has no such gain. Tracking: stiffness
   and damping of each joint (Nm/rad, Nms/rad); contact: those of the wall (N/m, Ns/m); transition: the damping of its
   braking (Ns/m). ethd-check judges the loop by them. */
typedef struct ethd_gains {
  const char *stiffness, *damping;
} ethd_gains;

/* ---- tracking: the finger's motion relative to the ring, to joint torques ---- */

typedef struct ethd_tracking_in {
  double eps_q[2];     /* J^-1 (X_f - X_r), rad (eq. 1) */
  double eps_q_dot[2]; /* J^-1 (V_f - V_r), rad/s */
  ethd_vec eps_x;      /* X_f - X_r, m, in R_0 */
  ethd_vec eps_v;      /* V_f - V_r, m/s */
  double period;       /* s since the last step */
  ethd_vec finger_v;   /* V_f, m/s, in R_0, for a law that leads the finger before a contact exists */
} ethd_tracking_in;

/* The same in space (ethd/space.h). */
typedef struct ethd_follow_in {
  ethd_vec3 eps_x;    /* X_f - X, m, in R_0, with the contacts' lead */
  ethd_vec3 eps_v;    /* V_f - V, m/s */
  ethd_vec3 finger_v; /* V_f, m/s */
  double period;      /* s since the last step */
} ethd_follow_in;

/* A law has a step, for the paper's device, or functions for space, or both. */
typedef struct ethd_tracking_law {
  ethd_law law;
  /* tau: joint torques before beta, Nm (eq. 2). NULL: ethd_control takes J^T of `force`. [rt] */
  ethd_status (*step)(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT;
  const ethd_gains *gains; /* NULL, or a struct that ends before it: unknown gains, so the loop isn't judged */
  /* Force, N, or velocity, m/s, of the end effector before beta, in R_0. NULL, or a struct that ends before it:
     ethd_space refuses the law for such commands. [rt] */
  ethd_status (*force)(const double *p, void *state, const ethd_follow_in *in, ethd_vec3 *out) ETHD_RT;
  ethd_status (*velocity)(const double *p, void *state, const ethd_follow_in *in, ethd_vec3 *out) ETHD_RT;
} ethd_tracking_law;

/* ---- a contact: a local minimum of the distance between the ring's centre and an object ----

        finger   ring                 |//////     n points into the object
          o    (      )    d_re       |//////     d_re = n.(P - X_r) - R_r       ring's inner circle to object
                     |<-------------->P--> n      d_fe = n.(P - X_f) - R_f       finger to object
                                      |//////     d_fr = n.(P - X_f) - R_r       finger grown to the ring
   Minima of one object whose normals differ by less than 15 deg are one contact, the deepest: a curve of short edges
   pushes once. Lengths in m, < 0: penetrating. v = n.(V_r - V of the surface) in m/s, > 0: entering.

   A contact *counts* while any of these holds: d_re < d_beta; d_fr <= d_beta before the call of its law, and
   ruling.argument <= d_beta after it; d_re < range, for a law that looks ahead; its state isn't ETHD_TRANSPARENT. Only
   contacts that count have calls of laws, a state block and a place in the trace: at most ETHD_CONTACTS_MAX, the
   deepest. A contact that stops counting is forgotten. */

/* Abilities of the device and its estimators along a contact's n, for a law that looks ahead. NaN: not known. The
   controller calculates it from the driver's data (ethd_dynamics), the limits and the arm. */
typedef struct ethd_facts {
  double mass;          /* kg: effective mass of the ring along n */
  double force;         /* N: the largest force against n that the guard lets through now (INFINITY: no limit is set) */
  double applied;       /* N along n: force of the last tick's torque, after the guard */
  double friction;      /* N: Coulomb friction along n */
  double viscous;       /* Ns/m */
  double delay;         /* s from the joint sample to the force; 0 if the position is the commanded one (space.h) */
  double lag;           /* s: delay of v (ethd_velocity_lag) */
  double ring_radius;   /* R_r, m */
  double finger_radius; /* R_f, m */
  double finger_age;    /* s: age of the finger's estimated position; NaN: the finger hasn't been seen */
  double finger_a;      /* m/s^2: acceleration of the finger's estimate along n */
  double *memory;       /* the law's own ETHD_MEMORY numbers, which outlive its contacts: zeroed by create, reset and a
                           change of the law, recorded and replayed */
  double acceleration;  /* m/s^2 that the device can give along n under velocity commands */
  double room; /* m between a centred finger and the inside of a ring or cap; INFINITY: a plate, which may go ahead */
} ethd_facts;
#define ETHD_MEMORY 4u

typedef struct ethd_contact {
  ethd_vec3 point, n; /* m, unit vector, in R_0; in the plane z is 0 */
  double d_re, d_fe, d_fr;
  double v;                /* of the ring along n, relative to the surface */
  double v_f;              /* of the finger along n, relative to the surface */
  double d_beta;           /* R_r - R_f,max, m */
  double period;           /* s since the last step */
  double age;              /* s since this contact began to count */
  int32_t object;          /* number in its scene */
  int32_t body;            /* 0: the scene that stands still, i: bodies[i - 1] of the setup */
  const ethd_facts *facts; /* NULL: the law doesn't look ahead */
} ethd_contact;

/* ---- contact: depth and speed to force ---- */

typedef struct ethd_contact_law {
  ethd_law law;
  /* gap: m, to the (offset) wall, < 0 inside; speed: ethd_contact.v, m/s, > 0 entering; entering: 1 on the branch of
     eq. 3 for a ring that moves in, 0 on the other, with v_hysteresis between them. force: N along n, which every call
     must set: < 0 pushes the ring out, 0: no push; the controller cuts an attractive force to 0. It is called in every
     tick in which the contact counts and its transition law's share is over 0, so not while offset brakes. It gets no
     period: a law with state counts its calls or needs no time. [rt] */
  ethd_status (*step)(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT;
  const ethd_gains *gains; /* as of tracking */
} ethd_contact_law;

/* ---- transition: shares of tracking and wall ---- */

/* The paper's states. A law may number states of its own from 3 up.
   A contact goes on as long as its state isn't ETHD_TRANSPARENT. */
enum { ETHD_TRANSPARENT = 0, ETHD_BRAKING = 1, ETHD_VO = 2 };

typedef struct ethd_ruling {
  double beta;     /* share of the tracking torque, 0 to 1; the smallest of all contacts counts */
  double share;    /* share of the contact law's force, 0 to 1 */
  double offset;   /* eps, m: how much deeper the wall lies */
  double damping;  /* bilateral along n, Ns/m (eq. 6): F = -damping v n */
  double feed;     /* feed-forward force along n, N, added to the contact law's */
  double argument; /* the distance on which beta depends, m (recorded as trace.d_fe) */
  int32_t state;
  int32_t reserved;
  double lead;  /* m along n, added to X_f - X_r; the lead of the contact with the smallest beta counts */
  double speed; /* m/s: limit of the effector's speed along n, relative to the surface; INFINITY: none. In state ETHD_VO
                   an effector under velocity commands has exactly this speed, so 0 holds it at the surface */
} ethd_ruling;

/* A contact as the replaced law leaves it, at the tick of the swap. */
typedef struct ethd_past {
  double offset;  /* eps of the last ruling, m */
  double d_re, v; /* of the contact, m and m/s */
  double age;     /* s since it began to count */
  double since;   /* s since its state last changed */
  int32_t state;  /* of the last ruling: ETHD_TRANSPARENT or another */
  int32_t reserved;
} ethd_past;

typedef struct ethd_transition_law {
  ethd_law law;
  /* At the call `out` is zero, except for beta = 1, argument = d_fe and speed = INFINITY. [rt] */
  ethd_status (*step)(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) ETHD_RT;

  /* The following fields are optional: NULL, or a struct that ends before it: the law doesn't have it. */

  /* Returns how far ahead the law looks, m of d_re, when the ring moves at this speed, m/s. A result that is less than
     d_beta or isn't finite counts as d_beta. Scenes are searched this far, so a long range costs time. ethd_setup_range
     calls it with an infinite speed. [rt] */
  double (*range)(const double *p, double speed) ETHD_RT;
  /* Takes over a contact at a swap of laws, into a state block that has been reset. NULL: the contact starts again.
     [rt] */
  void (*adopt)(const double *p, void *state, const ethd_past *past) ETHD_RT;
  const ethd_gains *gains; /* as of tracking */
} ethd_transition_law;

/* The smallest size of each kind in ABI 1: up to the end of its last field. */
#define ETHD_TRACKING_LAW_MIN (offsetof(ethd_tracking_law, step) + sizeof(void (*)(void)))
#define ETHD_CONTACT_LAW_MIN (offsetof(ethd_contact_law, step) + sizeof(void (*)(void)))
#define ETHD_TRANSITION_LAW_MIN (offsetof(ethd_transition_law, step) + sizeof(void (*)(void)))

/* True if a transition law, of any size, has this optional function. [any, rt-safe] */
#define ETHD_LAW_HAS(law_, field) \
  ((law_)->law.size >= offsetof(ethd_transition_law, field) + sizeof((law_)->field) && (law_)->field)

/* The same of a tracking law. [any, rt-safe] */
#define ETHD_TRACKING_HAS(law_, field) \
  ((law_)->law.size >= offsetof(ethd_tracking_law, field) + sizeof((law_)->field) && (law_)->field)

/* Checks ABI, size, kind, state, id, table and entry points of a law; each has a status of its own:
   ETHD_E_ABI, ETHD_E_SIZE, ETHD_E_STATE, ETHD_E_TABLE (also for gains that are no parameters), and ETHD_E_ARGUMENT for
   kind, id, brief and step. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_law_check(const ethd_law *law, ethd_error *error);

/* Returns the gains that a law of any kind names, NULL if it doesn't say. [any] */
ETHD_API const ethd_gains *ethd_law_gains(const ethd_law *law);

/* ---- built-in laws; they use the same interface as plugins ---- */

ETHD_API extern const ethd_tracking_law ethd_tracking_pd, ethd_tracking_follow;
ETHD_API extern const ethd_contact_law ethd_contact_kelvin_voigt, ethd_contact_spring, ethd_contact_hunt_crossley;
ETHD_API extern const ethd_transition_law ethd_transition_abrupt, ethd_transition_smooth, ethd_transition_offset,
    ethd_transition_predictive, ethd_transition_approach;

/* All of them, ordered by kind; the array ends with NULL. [any] */
ETHD_API extern const ethd_law *const ethd_laws[];

ETHD_END_DECLS

#endif
