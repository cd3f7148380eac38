/* The state of the front for space: one flat block, so that a tick can run on a copy, and a reset is one memset. */
#ifndef ETHD__SPACE_STATE_H
#define ETHD__SPACE_STATE_H

#include "core/mail.h"
#include "core/tick.h"
#include "space/plan.h"

typedef struct ethd__space_state {
  ethd__core core;
  int64_t blind; /* periods since the last tick with a possible measurement */
  /* finger */
  ethd_filter_state filter;
  int64_t reading_ns;  /* stamp of the reading that was used last */
  double reading_age;  /* s: how old it was when it was used */
  double absent;       /* 0 to 1: how far tracking has faded because the finger isn't seen */
  int64_t implausible; /* readings in a row */
  /* command */
  ethd_vec3 last;   /* N or m/s */
  ethd_vec3 facing; /* commanded normal of the plate; zero: none yet */
  double cut;       /* s for which the command has been cut without a break */
  ethd_guard_stop stop;
  int32_t stopping, stopped; /* as in ethd_guard_state */
} ethd__space_state;

struct ethd_space {
  ethd__space_plan plans[2];
  ethd__space_state state, scratch;
  ethd__mail mail;
  double period; /* s; period and kind never change */
  ethd_space_kind kind;
};

/* The context of one tick. */
typedef struct ethd__space_tick {
  const ethd__space_plan *plan; /* the plan in force */
  const ethd__space_plan *from; /* the plan replaced at this tick, NULL: none */
  ethd__space_state *state, *scratch;
  const ethd_space_sense *sense;
  const ethd_surface *surfaces;
  uint32_t count;
  const double *old;    /* at a swap, the old plan's command; NULL: no fade begins */
  int64_t periods;      /* since the last tick, missed ones included */
  double range;         /* m from X within which the trace has surfaces; at first its least value */
  ethd__core_tick core; /* soft, dt, X and the finger, and the results of the contacts */
  ethd_ability ability;
  ethd_space_trace *trace;
} ethd__space_tick;

/* Runs a tick. */
void ethd__space_tick_run(ethd__space_tick *t) ETHD_RT;

/* Estimates the finger: core.finger, finger_v. */
void ethd__space_finger(ethd__space_tick *t) ETHD_RT;

/* Computes contacts and the plate's normal from X, finger and surfaces. False: a law failed. */
bool ethd__space_touch(ethd__space_tick *t) ETHD_RT;

/* Makes the command, trace->command, from the laws' request, trace->asked, and sets trace->guard. */
void ethd__space_limit(ethd__space_tick *t) ETHD_RT;

/* Gives the velocity nearest to `asked` that satisfies all bounds: n.v <= speed, and n.v = speed for held ones. If
   bounds contradict each other, the first ones count. */
ethd_vec3 ethd__space_within(ethd_vec3 asked, const struct ethd__bound *bounds, int count) ETHD_RT;

#endif
