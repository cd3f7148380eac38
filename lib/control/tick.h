/* A tick in the making, and its stages in their order:

     ethd__estimate    sense -> where ring and finger are             estimate.c, finger_watch.c
     ethd__contacts    what is near, who rules, force of the walls    candidates.c, contacts.c, passivity.c
     ethd__evaluate    both, then tracking -> torque of the laws      evaluate.c
     ethd__tick_run    all of it, with swap, guard and faults         tick.c, swap.c, rows.c */
#ifndef ETHD__CONTROL_TICK_H
#define ETHD__CONTROL_TICK_H

#include "control/rows.h"

typedef struct ethd__motion {
  ethd_vec x, v; /* m, m/s, in R_0 */
} ethd__motion;

typedef struct ethd__tick {
  /* what it starts from */
  const ethd__plan *plan; /* the one that rules */
  const ethd__plan *from; /* the one that was replaced at this tick, NULL: none */
  ethd__state *state;
  ethd__state *scratch; /* needed where `from` is set */
  const ethd_sense *sense;
  bool soft; /* a fault was acknowledged: the torque starts from zero */
  /* what it works out */
  int64_t periods; /* since the last tick, missed ones included */
  double dt;       /* s since the last tick that had a measurement */
  ethd_pose pose;  /* of the arm; unknown on a tick without measurement, where nothing needs it */
  ethd__motion ring, finger;
  ethd_vec shift; /* m, of the tracking's reference: the contact's that rules beta */
  ethd_trace *trace;
} ethd__tick;

/* A whole tick: changes the state, fills the trace. [rt] */
void ethd__tick_run(ethd__tick *t) ETHD_RT;

/* Joint speeds, pose, ring and finger. [rt] */
void ethd__estimate(ethd__tick *t) ETHD_RT;

/* What is touched: trace->beta, fe, fd and the row of the deepest contact; t->shift. False: a law failed, which is
   noted. [rt] */
bool ethd__contacts(ethd__tick *t) ETHD_RT;

/* Estimates, contacts and tracking: trace->tau_raw. False: a law failed, which is noted. [rt] */
bool ethd__evaluate(ethd__tick *t) ETHD_RT;

/* The old plan's torque into trace->tau_raw, and the difference to the new plan's begins to fade. [rt] */
void ethd__swap(ethd__tick *t) ETHD_RT;

/* The state of the old plan becomes one of the new: what stays keeps its state, what is new starts from zero. [rt] */
void ethd__swap_state(const ethd__plan *from, const ethd__plan *to, ethd__state *state) ETHD_RT;

/* `from` - `to`, Nm, fades from here on; adds what is left of it to trace->tau_raw. [rt] */
void ethd__fade_start(ethd__state *state, const double from[2], const double to[2]) ETHD_RT;
void ethd__fade(ethd__tick *t) ETHD_RT;

/* Forgets contacts, fade and fault; the estimators stay. [rt] */
void ethd__resume(const ethd__plan *plan, ethd__state *state) ETHD_RT;

/* The force along n that keeps a contact passive, N, to be added to the wall's force; brake: what else acts there,
   N. Once a tick and contact, only where limits.energy is set. [rt] */
double ethd__passivity(const ethd__tick *t, ethd__slot *slot, const ethd_contact *c, double wall, double brake) ETHD_RT;

/* Once a tick, where the finger is watched: notes how old the last used reading is. [rt] */
void ethd__finger_watch(const ethd__tick *t) ETHD_RT;

/* A reading has come, where the finger is watched; implausible ones aren't used. [rt] */
void ethd__finger_doubt(ethd__state *state, bool implausible) ETHD_RT;

#endif
