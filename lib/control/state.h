/* The controller's state: one flat block, so that a tick can run on a copy, and a reset is one memset. */
#ifndef ETHD__CONTROL_STATE_H
#define ETHD__CONTROL_STATE_H

#include <string.h>

#include "control/plan.h"

#define ETHD__FENCE 2 /* words */

/* A law's state block, fenced by fence.c if the law is foreign; for a built-in law only `at` is used. */
typedef struct ethd__law_block {
  const ethd_law *law; /* the foreign law whose state this is */
  int64_t running;     /* 1: its code runs; [any] reads this and the law */
  int64_t failed;      /* ethd_status of its reset */
  uint64_t before[ETHD__FENCE];
  double at[ETHD_STATE_MAX / sizeof(double)];
  uint64_t after[ETHD__FENCE];
} ethd__law_block;

/* A contact that counted at the last tick, if its slot is in use (ethd__state.live). */
typedef struct ethd__slot {
  bool leaving;                /* the branch of eq. 3, with v_hysteresis */
  int32_t place, object, side; /* of the surface; side of a thin wall on which the contact began, 0: none */
  int32_t state;               /* the transition law's */
  int64_t periods, changed;    /* age in periods; age at the last change of state */
  ethd_vec point;              /* touched, in the place's frame */
  struct {
    ethd_vec n;             /* in R_0 */
    double offset, d_re, v; /* as in ethd_past */
  } past;                   /* at the tick of a swap, under the old plan */
  ethd__law_block transition, contact;
  /* passivity observer, where limits.energy is set */
  bool watched;                          /* at its last tick too */
  bool giving;                           /* damping is added */
  double energy[2], force[2], depth_was; /* J, N along n, m */
} ethd__slot;

/* A body's frame in R_0 and how it moves, laid out as the sense's six numbers of a body. */
typedef struct ethd__body_pose {
  ethd_vec x;   /* origin, m */
  double angle; /* rad */
  ethd_vec v;   /* m/s */
  double rate;  /* rad/s */
} ethd__body_pose;

/* A place, and what is known of the ring's distance to it. */
typedef struct ethd__place {
  ethd__body_pose pose; /* zeros for what stands still */
  ethd_vec at;          /* the ring's centre in the place's frame when the clearance was last found */
  double clearance;     /* distance from there to the nearest object, m; negative: not known */
  ethd_scene_hint hint;
  bool there; /* false: a body that has no pose yet */
} ethd__place;

/* Rows of the fault table as bits, as a sense has them. */
typedef struct ethd__fault_rows {
  int64_t faults, grave;
} ethd__fault_rows;

/* What a tick has noted: rows, and the value of those that have one. */
typedef struct ethd__met {
  ethd__fault_rows rows;
  int64_t valued; /* bits: rows with a value below */
  double value[ETHD_FAULT_COUNT];
} ethd__met;

#define ETHD__HISTORY 32 /* ticks of ring positions, for readings that are late */

typedef struct ethd__state {
  ethd_counters counters;
  /* faults */
  int64_t fault;           /* the latched row; [any] reads it and the next */
  int64_t clean;           /* periods since the last tick that called for a stop */
  ethd__met met;           /* at this tick */
  ethd__fault_rows before; /* at the last */
  int64_t time_ns;         /* of the last tick */
  int64_t clock_ns;        /* of the tick at which the present window of the clock's check began */
  int64_t clock_periods;   /* since then */
  double clock_waits;      /* s for which the same sample has come again */
  int64_t blind;           /* periods since the last tick with a possible measurement */
  /* estimates */
  ethd_velocity_state velocity[2];
  int64_t velocity_ns; /* instant of their last sample */
  ethd_filter_state filter;
  int64_t reading_ns;   /* stamp of the reading that was used last */
  double reading_age;   /* s: how old it was when it was used */
  double finger_radius; /* of the last fit, NaN: none */
  double absent;        /* 0 to 1: how far tracking has faded because the finger isn't seen */
  int64_t implausible;  /* readings in a row */
  struct {
    int64_t time_ns;
    ethd_vec x;
  } history[ETHD__HISTORY];
  uint64_t remembered; /* how many positions were ever put there; a tick without measurement adds none */
  /* contacts */
  ethd__slot slots[ETHD_CONTACTS_MAX];
  ethd__place places[ETHD__PLACES];
  double memory[ETHD_MEMORY];      /* of the transition law */
  unsigned live;                   /* slots in use, as bits */
  unsigned orphans;                /* contacts whose scene was replaced at this tick */
  double given;                    /* J that the last contact gave away */
  uint64_t given_at;               /* tick */
  uint64_t excess_from, excess_at; /* first and last step after which it was far too much; 0: never */
  /* torque */
  ethd__law_block tracking;
  struct {
    double delta[2]; /* old - new torque at the swap, Nm */
    double from[2];  /* size of the old one, Nm */
    double elapsed;  /* s since then; INFINITY: no fade */
  } fade;
  double soft; /* s since a fault was acknowledged; INFINITY: the torque is whole again */
  bool fades;  /* one of the two goes on */
  ethd_guard_state guard;
} ethd__state;

static inline unsigned ethd__slot_bit(const ethd__state *state, const ethd__slot *slot) ETHD_RT {
  return 1u << (slot - state->slots);
}

static inline void ethd__slot_free(ethd__state *state, const ethd__slot *slot) ETHD_RT {
  state->live &= ~ethd__slot_bit(state, slot);
}

#endif
