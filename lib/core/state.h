/* The core's state of faults, contacts, laws and fades, which both fronts keep from tick to tick. It is flat, so that a
   tick can run on a copy, and a reset is one memset. */
#ifndef ETHD__CORE_STATE_H
#define ETHD__CORE_STATE_H

#include <string.h>

#include "core/plan.h"

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

/* A contact that counted at the last tick, if its slot is in use (ethd__core.live). */
typedef struct ethd__slot {
  bool leaving;                /* the branch of eq. 3, with v_hysteresis */
  int32_t place, object, side; /* of the surface; side of a thin wall on which the contact began, 0: none */
  int32_t state;               /* the transition law's */
  int64_t periods, changed;    /* age in periods; age at the last change of state */
  ethd_vec3 point;             /* touched, in the place's frame */
  struct {
    ethd_vec3 n;            /* in R_0 */
    double offset, d_re, v; /* as in ethd_past, at the tick of a swap, under the old plan */
  } past;
  ethd__law_block transition, contact;
  /* passivity observer, where limits.energy is set */
  bool watched;                          /* at its last tick too */
  bool giving;                           /* damping is added */
  double energy[2], force[2], depth_was; /* J, N along n, m */
} ethd__slot;

/* Rows of the fault table as bits, as a sense has them. */
typedef struct ethd__fault_rows {
  int64_t faults, grave;
} ethd__fault_rows;

/* The noted rows of a tick, with their values. */
typedef struct ethd__met {
  ethd__fault_rows rows;
  int64_t valued; /* bits: rows with a value below */
  double value[ETHD_FAULT_COUNT];
} ethd__met;

/* The device's clock, if the gap between two steps is limited (clock.h). */
typedef struct ethd__clock {
  uint64_t begun;  /* tick at which the check began */
  uint64_t next;   /* tick at which it goes on */
  int64_t now_ns;  /* stamp of the last tick */
  int64_t from_ns; /* of the tick at which the present window began */
  int64_t periods; /* since then */
  double waits;    /* s for which the same sample has come again */
} ethd__clock;

/* The fades: of a swap's difference, and of the command after an acknowledged fault. */
typedef struct ethd__fade {
  double delta[3]; /* old - new command at the swap */
  double from[3];  /* size of the old command */
  double elapsed;  /* s since then; INFINITY: no fade */
  double soft;     /* s since a fault was acknowledged; INFINITY: the command is whole again */
  bool active;     /* one of the two fades goes on */
} ethd__fade;

typedef struct ethd__core {
  ethd_counters counters;
  /* faults */
  int64_t fault;           /* the latched row; [any] reads it and the next */
  int64_t clean;           /* periods since the last tick that called for a stop */
  ethd__met met;           /* at this tick */
  ethd__fault_rows before; /* at the last */
  ethd__clock clock;
  /* contacts */
  ethd__slot slots[ETHD_CONTACTS_MAX];
  double memory[ETHD_MEMORY];      /* of the transition law */
  unsigned live;                   /* slots in use, as bits */
  unsigned orphans;                /* contacts whose scene was replaced at this tick */
  double given;                    /* J that the last contact released */
  uint64_t given_at;               /* tick */
  uint64_t excess_from, excess_at; /* first and last step with far too much of it; 0: never */
  ethd__law_block tracking;
  ethd__fade fade;
} ethd__core;

static inline unsigned ethd__slot_bit(const ethd__core *core, const ethd__slot *slot) ETHD_RT {
  return 1u << (slot - core->slots);
}

static inline void ethd__slot_free(ethd__core *core, const ethd__slot *slot) ETHD_RT {
  core->live &= ~ethd__slot_bit(core, slot);
}

#endif
