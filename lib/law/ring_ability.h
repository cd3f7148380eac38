/* A ring's ability along a contact's normal: the facts that a law needs to brake it.

   Friction is Coulomb's, which changes its sign over STICTION as a plant's does, and viscous. It helps a ring to brake:
   with the guard's force limit F, the ring's deceleration is at most (F + f_c) / m. [rt] */
#ifndef ETHD__LAW_RING_ABILITY_H
#define ETHD__LAW_RING_ABILITY_H

#include <math.h>
#include <stdbool.h>

#include "ethd/law.h"
#include "law/brake_curve.h"

#define ETHD__STICTION 5e-3 /* m/s */

typedef struct ethd__ring_ability {
  double mass, force, friction, viscous; /* kg, N, N, Ns/m */
  ethd__brake_curve curve;               /* on which the law brakes it */
} ethd__ring_ability;

/* Returns a friction or delay, 0 if it isn't known. */
static inline double ethd__known(double x) ETHD_RT { return x >= 0 ? x : 0; }

/* Returns whether all facts that a plan needs are known. */
static inline bool ethd__ring_is_known(const ethd_facts *f) ETHD_RT {
  return f && f->mass > 0 && f->mass < (double)INFINITY && f->force > 0 && f->force < (double)INFINITY &&
         f->finger_age >= 0;
}

/* Returns the ability of a ring that decelerates k times as fast as the facts say: its mass is theirs / k. The caller
   fills the curve. */
static inline ethd__ring_ability ethd__ring_ability_of(const ethd_facts *f, double k) ETHD_RT {
  return (ethd__ring_ability){
      .mass = f->mass / k, .force = f->force, .friction = ethd__known(f->friction), .viscous = ethd__known(f->viscous)};
}

/* Returns the friction against the motion, N. */
static inline double ethd__ring_friction(const ethd__ring_ability *a, double v) ETHD_RT {
  double share = v * (1 / ETHD__STICTION);
  if (share > 1) share = 1;
  if (share < -1) share = -1;
  return a->friction * share + a->viscous * v;
}

#endif
