/* The core's view of a tick: positions of effector and finger, and the results of the contacts. */
#ifndef ETHD__CORE_TICK_H
#define ETHD__CORE_TICK_H

#include "core/state.h"

typedef struct ethd__core_tick ethd__core_tick;

/* The results of the contacts. */
typedef struct ethd__touched {
  int64_t contacts, overflow;  /* contacts that count; contacts without room */
  int32_t object, body, state; /* of the deepest contact; object -1: there is none */
  double eps, d_re, d_fe, v_n; /* of the deepest contact, as in a trace */
  double beta;                 /* the smallest over the contacts */
  ethd_vec3 fe, fd;            /* N: sums of the walls' forces (with feed) and of the braking forces */
  ethd_vec3 lead;              /* m: of the tracking's reference, from the contact with the smallest beta */
  int bounds;                  /* contacts whose ruling bounds the speed */
  struct ethd__bound {
    ethd_vec3 n;
    double speed; /* m/s along n, in R_0, that must not be exceeded */
    bool held;    /* the effector must have exactly this speed */
  } bound[ETHD_CONTACTS_MAX];
} ethd__touched;

struct ethd__core_tick {
  const ethd__core_plan *plan;
  ethd__core *state;
  bool soft;   /* a fault was acknowledged: the command starts from zero */
  bool keeps;  /* the old plan's run at a swap: contacts store the data that a new plan may adopt */
  double dt;   /* s since the last tick that had a measurement */
  double near; /* m: contacts with d_re below this count: d_beta, or as far as the law looks ahead */
  ethd_vec3 x, v, finger, finger_v; /* m, m/s, in R_0: the effector's point and the finger's centre */
  ethd__touched touched;
  /* Computes the facts about a contact for a law that looks ahead; `front` is the whole tick. */
  void (*facts)(const void *front, const ethd_contact *contact, ethd_facts *out) ETHD_RT;
  const void *front;
};

#endif
