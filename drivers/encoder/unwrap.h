/* Converts an encoder's modular counts to a joint's angle and speed, and detects their faults.

        count   ceiling ..     /|    /|            a count past the ceiling begins at 0 again; the shorter
                          /   / |   / |            of the two differences is the right one
                0 .......     --+---  +--
        edge    ----|--|--|-|-|--|---|-----> time  1/T: counts between two edges over the time between them

        angle = offset + sign * 2 pi * (count - home) / (counts_per_turn * ratio)

   A driver passes each sample once, with its joint's torque; the rows of the fault table that one encoder can show are
   returned as bits. All [rt] except the check. */
#ifndef ETHD__ENCODER_UNWRAP_H
#define ETHD__ENCODER_UNWRAP_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/base.h"
#include "ethd/control.h"
#include "ethd/fault.h"

/* Contents of a sample, as bits of `flags`. */
enum {
  ETHD__COUNT_INDEX = 1 /* an index mark has passed since the sample before, at `index` */
};

typedef struct ethd__count {
  int64_t time_ns; /* instant at which it was latched */
  int64_t edge_ns; /* instant of the last edge before that; 0: not known */
  uint64_t raw;    /* 0 to the ceiling */
  uint64_t index;  /* 0 to the ceiling, too */
  int32_t flags, reserved;
} ethd__count;

/* The definition of one encoder. Every number must be set; there are no defaults. */
typedef struct ethd__encoder_def {
  uint64_t ceiling;        /* highest raw count: ethd__count_ceiling(width), or a counter's own; >= 1 */
  int64_t counts_per_turn; /* of the encoder's shaft, all edges counted: 4000 of 1000 lines; >= 1 */
  double ratio;            /* turns of that shaft in one of the joint, > 0 */
  double offset;           /* rad: the joint's angle at count 0, or at the home mark */
  double speed_max;        /* rad/s of the joint, > 0: a faster motion is a jump */
  double freeze_torque;    /* Nm, > 0: a joint that stands although its torque has changed by more counts as
                              frozen. Choose it over twice the joint's friction; INFINITY: no check */
  double freeze_time;      /* s, > 0: duration of standing */
  double reverse_torque;   /* Nm, > 0: a joint that gains speed against more torque has a reversed encoder. A hand
                              does it too, but the torque absorbs most of the hand's work. Choose it over the
                              joint's friction; INFINITY: no check */
  double reverse_time;     /* s, > 0: duration of gaining speed */
  double inertia;          /* kg m^2 of the joint, > 0, correct within a half: converts a speed to energy */
  int32_t sign;            /* 1, or -1: counts rise while the angle falls */
  bool home;               /* the first index mark that passes is the home mark; count and offset then decide the number
                              of whole turns, to the nearest */
  bool stamps;             /* speed comes from edge_ns where it is known */
  int32_t reserved;
} ethd__encoder_def;

/* Initially all zero. A driver reads the first part only. */
typedef struct ethd__encoder {
  double q, dq;     /* rad, rad/s: of the last sample; for a dropped one they are extrapolated */
  int64_t position; /* counts, unwrapped; the first is the raw one, minus ceiling + 1 if it is over ceiling / 2 */
  bool has_dq;      /* dq comes from edges */
  bool homed;       /* the home mark has passed */
  bool misindexed;  /* index marks had a wrong distance; this stays, and the driver must refuse the next run */

  int32_t started, paused, edges, marks;
  int32_t direction; /* of the last edge */
  bool moves;        /* `speed` is known */
  uint64_t raw;
  int64_t home; /* the count at the angle `offset` */
  int64_t mark, first_mark;
  int64_t time_ns; /* of the last good sample */
  int64_t step;    /* counts since the sample before it, in step_ns */
  int64_t step_ns;
  int64_t edge_ns;
  double edge;     /* position of that edge, halfway between two counts */
  int64_t jump_ns; /* of the last dropped sample */
  int32_t jumped;
  double low, high;   /* Nm: torques since the last edge */
  double still;       /* s for which they have differed by more than freeze_torque */
  double speed;       /* rad/s, smoothed */
  double wrong;       /* s for which the joint has gained speed against reverse_torque */
  double wrong_speed; /* rad/s, at its beginning */
  double work;        /* J: work of the torque on the joint since then */
} ethd__encoder;

/* Returns 2^width - 1, for a width of 1 to 64 bits. */
static inline uint64_t ethd__count_ceiling(uint32_t width) { return UINT64_MAX >> (64 - width); }

/* Checks a definition against the period of its samples, s: ETHD_E_RANGE or ETHD_E_NOT_FINITE with the field's name.
   Refuses a ceiling if a joint at speed_max passes half of it or more in one period. [main] */
ETHD_MUST_CHECK ethd_status ethd__encoder_check(const ethd__encoder_def *def, double period, ethd_error *error);

/* True when `inertia` and the setup's mass at the ring along the joint's axis (0, 1) differ by a factor of two or more;
   the sentence names the check that is lost. False if the mass isn't known. [main] */
bool ethd__encoder_doubt(const ethd__encoder_def *def, const ethd_setup *setup, int joint, char *sentence, size_t room);

/* Forgets the encoder's position, but keeps `misindexed`. */
void ethd__encoder_restart(ethd__encoder *encoder) ETHD_RT;

/* Marks a time without samples or a change of their clock, so that the next sample is no jump if it is within half of
   the ceiling. Position and home stay. */
void ethd__encoder_pause(ethd__encoder *encoder) ETHD_RT;

/* Assigns this angle, rad, to the present count. [main], while no other thread steps it */
void ethd__encoder_place(const ethd__encoder_def *def, ethd__encoder *encoder, double q);

/* Takes one sample, newer than the last. torque: Nm at the joint since the last one, NAN if it isn't known. Returns
   ETHD_FAULT_BIT of ENCODER_JUMP, ENCODER_FROZEN, ENCODER_REVERSED and INDEX as this sample shows them, and adds the
   bits of grave rows to *grave; a second jump within 10 ms is grave. */
int64_t ethd__encoder_step(const ethd__encoder_def *def, ethd__encoder *encoder, const ethd__count *sample,
                           double torque, int64_t *grave) ETHD_RT;

#endif
