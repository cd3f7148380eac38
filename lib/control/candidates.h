/* The touches that a tick looks at: what is newly near, and the live contacts wherever they are. */
#ifndef ETHD__CONTROL_CANDIDATES_H
#define ETHD__CONTROL_CANDIDATES_H

#include "control/context.h"
#include "control/places.h"

#define ETHD__TOUCHES (ETHD_CONTACTS_MAX + 8) /* the most touches that are looked at in one place, the deepest */
#define ETHD__CANDIDATES (ETHD__PLACES * ETHD__TOUCHES + ETHD_CONTACTS_MAX)

typedef struct ethd__candidate {
  ethd_touch touch; /* in R_0 */
  ethd_vec local;   /* its point in the place's frame */
  ethd_vec v;       /* of the surface there, m/s in R_0 */
  int place;
  int slot; /* the contact that it continues, -1: none */
} ethd__candidate;

typedef struct ethd__candidates {
  ethd__candidate at[ETHD__CANDIDATES]; /* the deepest first; equal depths keep the scenes' order */
  int count;
  unsigned live; /* slots in use as the tick began, as bits */
  int overflow;  /* touches within range that weren't looked at */
  bool queried;  /* a scene was asked */
} ethd__candidates;

/* Collects the candidates for ring and finger as the tick has estimated them. [rt] */
void ethd__candidates_collect(const ethd__tick *t, ethd__candidates *out) ETHD_RT;

#endif
