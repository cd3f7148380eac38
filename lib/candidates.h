/* The touches that a tick looks at: what is newly near, and the live contacts wherever they are. */
#ifndef ETHD__CANDIDATES_H
#define ETHD__CANDIDATES_H

#include "control.h"

#define ETHD__TOUCHES (ETHD_CONTACTS_MAX + 8) /* looked at within reach; the deepest */
#define ETHD__CANDIDATES (ETHD__TOUCHES + ETHD_CONTACTS_MAX)

typedef struct ethd__candidate {
  ethd_touch touch;
  int slot; /* the contact that it continues, -1: none */
} ethd__candidate;

typedef struct ethd__candidates {
  ethd__candidate at[ETHD__CANDIDATES]; /* the deepest first; equal depths keep the scene's order */
  int count;
  int overflow; /* touches within reach that weren't looked at */
} ethd__candidates;

/* Ring and finger as in t->x, t->xf. [rt] */
void ethd__candidates_collect(const ethd__plan *plan, const ethd__state *state, const ethd_trace *t,
                              ethd__candidates *out) ETHD_RT;

#endif
