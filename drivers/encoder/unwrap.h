/* One encoder: modular counts to a joint's angle and speed, and what is wrong with them.

        count   ceiling ..     /|    /|            a count past the ceiling begins at 0 again; the shorter
                          /   / |   / |            way round is the one that was taken
                0 .......     --+---  +--
        edge    ----|--|--|-|-|--|---|-----> time  1/T: counts between two edges over the time between them

        angle = offset + sign * 2 pi * (count - home) / (counts_per_turn * ratio)

   A driver gives each sample once, with the torque that its joint was under; the rows of the fault table
   that one encoder can show come back as bits. All [rt] but the check. */
#ifndef ETHD__ENCODER_UNWRAP_H
#define ETHD__ENCODER_UNWRAP_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/fault.h"
#include "ethd/status.h"

/* What a sample holds, as bits of `flags`. */
enum {
  ETHD__COUNT_INDEX = 1 /* an index mark has passed since the sample before, at `index` */
};

typedef struct ethd__count {
  int64_t time_ns; /* instant at which it was latched */
  int64_t edge_ns; /* instant of the last edge before that; 0: not known */
  uint64_t raw;    /* 0 to the ceiling */
  uint64_t index;  /* likewise */
  int32_t flags, reserved;
} ethd__count;

/* Of one encoder; every number must be set, there is no default. */
typedef struct ethd__encoder_def {
  uint64_t ceiling;        /* highest raw count: ethd__count_ceiling(width), or a counter's own; >= 1 */
  int64_t counts_per_turn; /* of the encoder's shaft, all edges counted: 4000 of 1000 lines; >= 1 */
  double ratio;            /* turns of that shaft in one of the joint, > 0 */
  double offset;           /* rad: the joint's angle at count 0, or at the home mark */
  double speed_max;        /* rad/s of the joint, > 0: what is faster is a jump */
  double freeze_torque;    /* Nm, > 0: a sound joint that stands while its torque changes by more soon moves:
                              over twice its friction; INFINITY: it needn't */
  double freeze_time;      /* s: how soon, > 0 */
  double reverse_torque;   /* Nm, over its friction: against more a joint gains no speed, but by a hand:
                              then most of the hand's work is lost against the torque; INFINITY: it may */
  double reverse_time;     /* s: how long it may all the same, > 0 */
  double inertia;          /* kg m^2 of the joint within a half, > 0: what energy its speed is */
  int32_t sign;            /* 1, or -1: counts rise while the angle falls */
  bool home;               /* 1: the first index mark that passes is the home mark, the whole number of
                              turns being the one nearest to what count and offset say; 0: no homing */
  bool stamps;             /* 1: speed from edge_ns where it is known */
  int32_t reserved;
} ethd__encoder_def;

/* Zeroed: ready. A driver reads the first part. */
typedef struct ethd__encoder {
  double q, dq;     /* rad, rad/s: of the last sample; a dropped one is replaced by going on as before */
  int64_t position; /* counts, unwrapped; at first the raw one, those over ceiling / 2 less ceiling + 1 */
  bool has_dq;      /* 1: dq comes from edges */
  bool homed;       /* 1: the home mark has passed */
  bool misindexed;  /* 1: index marks had a wrong distance; stays, and the next run is to be refused */

  int32_t started, paused, edges, marks;
  int32_t direction; /* of the last edge */
  bool moves;        /* 1: speed is known */
  uint64_t raw;
  int64_t home; /* count of the angle `offset` */
  int64_t mark, first_mark;
  int64_t time_ns; /* of the last good sample */
  int64_t step;    /* counts, of it, in step_ns */
  int64_t step_ns;
  int64_t edge_ns;
  double edge;     /* count at that edge: halfway between two */
  int64_t jump_ns; /* of the last dropped sample */
  int32_t jumped;
  double low, high;   /* Nm: torques since the last edge */
  double still;       /* s, since they differ by more than freeze_torque */
  double speed;       /* rad/s, smoothed */
  double wrong;       /* s, against reverse_torque */
  double wrong_speed; /* rad/s, at its begin */
  double work;        /* J, given to the joint since then */
} ethd__encoder;

/* 2^width - 1, of 1 to 64 bits. */
static inline uint64_t ethd__count_ceiling(uint32_t width) { return UINT64_MAX >> (64 - width); }

/* A definition against the period of its samples, s: ETHD_E_RANGE or ETHD_E_NOT_FINITE with the field's
   name. Refuses a ceiling that speed_max could pass half of in one period. [main] */
ETHD_MUST_CHECK ethd_status ethd__encoder_check(const ethd__encoder_def *def, double period, ethd_error *error);

/* Forgets where it was, but not that it was misindexed. */
void ethd__encoder_restart(ethd__encoder *encoder) ETHD_RT;

/* Time has passed unseen, or another clock counts: the next sample is no jump, wherever it is within half of the
   ceiling; position and home stay. */
void ethd__encoder_pause(ethd__encoder *encoder) ETHD_RT;

/* From now on the count that it has is this angle, rad. [main] while nobody steps it */
void ethd__encoder_place(const ethd__encoder_def *def, ethd__encoder *encoder, double q);

/* One sample, newer than the last. torque: Nm at the joint since that one, NAN if it isn't known.
   Returns ETHD_FAULT_BIT of ENCODER_JUMP, ENCODER_FROZEN, ENCODER_REVERSED, INDEX as they are seen in this
   sample, and ors rows that are at their worst into *grave: a second jump in 10 ms. */
int64_t ethd__encoder_step(const ethd__encoder_def *def, ethd__encoder *encoder, const ethd__count *sample,
                           double torque, int64_t *grave) ETHD_RT;

#endif
