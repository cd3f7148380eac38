/* Candidates: the surface points that a tick examines. Some of them continue contacts. All [rt].

     front   appends the near points
     core    pairs them with the live contacts (ethd__candidates_match)
     front   appends points for the contacts that no near point continues, if it knows any
     core    sorts them, the deepest first */
#ifndef ETHD__CORE_CANDIDATES_H
#define ETHD__CORE_CANDIDATES_H

#include "core/tick.h"

#define ETHD__CANDIDATES 96

typedef struct ethd__candidate {
  double distance;         /* from the effector's point, m, signed */
  ethd_vec3 point, n;      /* in R_0 */
  ethd_vec3 v;             /* m/s of the surface there, in R_0 */
  ethd_vec3 local;         /* the point in the place's frame */
  const double *contact_p; /* the contact law's parameters there */
  int32_t place;           /* the place of `local`'s frame: the scene that stands still, or a body */
  int32_t object, feature; /* of the place; the part of the object */
  int32_t side;            /* of a thin wall, as in ethd_touch; solids: 0 */
  int32_t slot;            /* the contact that it continues, -1: none */
} ethd__candidate;

typedef struct ethd__candidates {
  ethd__candidate at[ETHD__CANDIDATES]; /* in the end the deepest first; equal depths keep their order */
  int count;
  unsigned live; /* slots in use as the tick began, as bits */
  int overflow;  /* points within range that weren't examined */
} ethd__candidates;

/* Points of one object whose normals differ by less than this angle are one contact, the deepest. A curve of short
   edges has several local minima around each of its corners, and each would push. */
#define ETHD__SAME_WAY 0.96592582628906829 /* cos 15 deg */

static inline void ethd__candidates_begin(ethd__candidates *c, const ethd__core *core) ETHD_RT {
  c->count = c->overflow = 0;
  c->live = core->live;
}

/* Returns the distance from the effector's point, m, within which all points that can count lie: d_re < near, or d_fr
   <= d_beta for a finger at any distance ahead. */
double ethd__candidates_range(const ethd__core_tick *t) ETHD_RT;

/* Pairs points with contacts of the same object, the closest first, at most R_r apart, so that a contact that ends
   doesn't pass its state on to another. Ends orphans whose surface the new scene doesn't have. Returns the slots of the
   contacts that no point continues, as bits. */
unsigned ethd__candidates_match(const ethd__core_plan *plan, ethd__core *core, ethd__candidates *c) ETHD_RT;

/* Keeps each contact on its side of a thin wall, and sorts. */
void ethd__candidates_sort(const ethd__core *core, ethd__candidates *c) ETHD_RT;

#endif
