/* Inside the controller: a plan (a posted setup, worked out on [main]) and the state (one flat block).

     ethd__estimate   sense -> ring and finger            estimate.c
     ethd__contacts   ring, finger -> contacts, forces    contacts.c
     ethd__evaluate   both, then tracking -> torque       evaluate.c
     ethd__judge      rows of the fault table -> reaction  judge.c
    guard, swap, safe state around them                  tick.c
     posts, events, latching                              control.c   */
#ifndef ETHD__CONTROL_H
#define ETHD__CONTROL_H

#include <string.h>

#include "ethd/control.h"

/* Where objects are: 0 the scene that stands still, then the bodies. */
#define ETHD__PLACES (1 + ETHD_BODIES_MAX)

static inline const ethd_scene *ethd__place_scene(const ethd_setup *setup, int place) ETHD_RT {
  return place == 0 ? setup->scene : setup->bodies[place - 1];
}

typedef struct ethd__plan {
  ethd_setup setup;
  double d_beta;
  int places;        /* all from here on have no scene */
  int looks_further; /* a limit of clock, joints, reach or heat is set */
  ethd_velocity velocity;
  ethd_fit fit;
  double lag_least, lag_most; /* of setup.ray_lag and 0, s; equal: no ray lags */
  ethd_filter filter;
  /* the contact law's parameters, per place and material */
  double material_p[ETHD__PLACES][ETHD_MATERIALS_MAX][ETHD_PARAMS_MAX];
} ethd__plan;

/* Checks the setup and works the plan out; a failure leaves the plan undefined. [main] */
ethd_status ethd__plan_prepare(const ethd_setup *setup, ethd__plan *out, ethd_error *error);

/* A law's state block. */
typedef double ethd__block[ETHD_STATE_MAX / sizeof(double)];

/* A contact that counted at the last tick. */
typedef struct ethd__slot {
  int32_t used, object, side, state;
  int32_t leaving; /* branch of eq. 3, with v_hysteresis */
  int32_t place;
  int64_t periods; /* since it began to count */
  ethd_vec point;  /* in the place's frame */
  /* of the passivity observer, where there is one */
  double energy[2], force[2], depth_was; /* J, N along n, m */
  int64_t giving;                        /* 1: damping is added */
  ethd__block transition, contact;
} ethd__slot;

/* A scene as the ring meets it. */
typedef struct ethd__place {
  double pose[6];   /* as in the sense; zeros for what stands still */
  ethd_vec at;      /* ring's centre in the place's frame when it was last asked for clearance */
  double clearance; /* distance to the nearest object there, negative: not known */
  ethd_scene_hint hint;
  int32_t there; /* 0: a body that has no pose yet */
  int32_t reserved;
} ethd__place;

/* Rows of the fault table as bits, as a sense has them. */
typedef struct ethd__rows {
  int64_t faults, grave;
} ethd__rows;

#define ETHD__HISTORY 32 /* ticks of ring positions, for readings that are late */

typedef struct ethd__state {
  ethd_counters counters;
  int64_t fault;          /* latched first; [any] reads it and the next */
  int64_t clean;          /* periods since the last tick that called for a stop */
  ethd__rows met, before; /* at this tick, at the last */
  int64_t time_ns;        /* of the last tick */
  int64_t blind;          /* periods since the last tick that had a measurement */
  ethd_velocity_state velocity[2];
  ethd_filter_state filter;
  int64_t reading_ns;              /* stamp of the reading that was used last */
  double finger_radius;            /* of the last fit, NaN: none */
  double given;                    /* J that the last contact gave away */
  uint64_t given_at;               /* tick */
  uint64_t excess_from, excess_at; /* steps after which it was far too much: first, last; 0: never */
  double absent;                   /* share of the tracking torque that has faded, for the finger isn't seen */
  int64_t implausible;             /* readings in a row */
  struct {
    int64_t time_ns;
    ethd_vec x;
  } history[ETHD__HISTORY];
  uint64_t remembered; /* positions ever put there; a tick without measurement leaves none */
  ethd__block tracking;
  ethd__slot slots[ETHD_CONTACTS_MAX];
  ethd__place places[ETHD__PLACES];
  struct {
    double delta[2]; /* old - new torque at the swap, Nm */
    double elapsed;  /* s since then; INFINITY: no fade */
  } fade;
  ethd_guard_state guard;
} ethd__state;

/* What prevents a tick: a row of reaction ZERO with its value. */
typedef struct ethd__failure {
  ethd_fault fault;
  double value;
} ethd__failure;

/* Where ring and finger are, into out->x, v, xf, vf, rf, qd. [rt] */
void ethd__estimate(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt, ethd_pose *pose,
                    ethd_trace *out) ETHD_RT;

/* What is touched: out->beta, fe, fd and the deepest contact's row; *shift: of the contact that rules
   beta. False: a law failed. [rt] */
int ethd__contacts(const ethd__plan *plan, ethd__state *state, double dt, ethd_trace *out, ethd_vec *shift,
                   ethd__failure *failure) ETHD_RT;

/* A whole tick up to the torque before fade and guard, out->tau_raw. False: a law failed. [rt] */
int ethd__evaluate(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt, ethd_pose *pose,
                   ethd_trace *out, ethd__failure *failure) ETHD_RT;

/* How a tick begins. */
typedef struct ethd__entry {
  const ethd__plan *plan; /* rules */
  const ethd__plan *from; /* was replaced at this tick, NULL: none */
  int soft;               /* starts from zero torque */
} ethd__entry;

/* One tick with guard; scratch is needed at a swap. Returns what this tick failed with, which only names the
   value of its row's event: out->fault says what it ended with. [rt] */
ethd__failure ethd__tick(const ethd__entry *e, ethd__state *state, ethd__state *scratch, const ethd_sense *sense,
                         ethd_trace *out) ETHD_RT;

/* ---- rows of the fault table, all [rt] ---- */

/* What the sense says. */
void ethd__rows_take(ethd__rows *rows, const ethd_sense *sense) ETHD_RT;

/* The first that takes the torque away; ETHD_FAULT_NONE. */
ethd_fault ethd__rows_zero(const ethd__rows *rows) ETHD_RT;

/* Tells the guard to stop the ring or let it go, where a row calls for it. */
void ethd__rows_stop(const ethd__rows *rows, ethd_guard_state *guard) ETHD_RT;

/* A torque was cut. */
#define ETHD__CUT_MAX (0.1 + 1e-9) /* s, as a sum of periods */
static inline void ethd__rows_cut(ethd__rows *rows, const ethd_guard_state *guard) ETHD_RT {
  rows->faults |= ETHD_FAULT_BIT(ETHD_FAULT_TORQUE);
  if (guard->cut > ETHD__CUT_MAX) rows->grave |= ETHD_FAULT_BIT(ETHD_FAULT_TORQUE);
}

/* With what the guard did, all is met: latches. The fault that the tick ends with. */
ethd_fault ethd__judge(const ethd__plan *plan, ethd__state *state, int64_t guard_bits, int64_t periods) ETHD_RT;

/* Occurrences that begin at this tick; grave: that come to the worst at it. */
ethd__rows ethd__rows_begun(const ethd__plan *plan, const ethd__state *state) ETHD_RT;

static inline int ethd__rows_any(const ethd__rows *rows) ETHD_RT { return (rows->faults | rows->grave) != 0; }

/* The force along n that keeps a contact passive, to be added to the wall's; brake: what else acts there.
   Once a tick, only where limits.energy is set. [rt] */
double ethd__passivity(const ethd__plan *plan, ethd__state *state, ethd__slot *slot, const ethd_contact *c, double wall,
                       double brake) ETHD_RT;

/* ---- the finger's readings, all [rt] ---- */

static inline int ethd__is_watched(const ethd__plan *plan) ETHD_RT {
  return plan->setup.limits.finger_age < (double)INFINITY;
}

/* Once a tick, where it is watched: how old the last used reading is. */
void ethd__finger_watch(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt) ETHD_RT;

/* A reading has come; implausible ones aren't used. */
void ethd__finger_doubt(ethd__state *state, int implausible) ETHD_RT;

/* Forgets contacts, fade and fault; the estimators stay. [rt] */
void ethd__resume(const ethd__plan *plan, ethd__state *state) ETHD_RT;

/* Zeroed and reset blocks of laws. [rt] */
static inline void ethd__block_reset(const ethd_law *law, const double *p, double *block) ETHD_RT {
  memset(block, 0, sizeof(ethd__block));
  if (law->reset) law->reset(p, block);
}
void ethd__slot_start(const ethd__plan *plan, ethd__slot *slot) ETHD_RT;

/* The parameters of the contact law on a material, -1: none. [rt] */
static inline const double *ethd__contact_p(const ethd__plan *plan, int place, int32_t material) ETHD_RT {
  return material < 0 ? plan->setup.contact_p : plan->material_p[place][material];
}

#endif
