/* Converts a drive's answers to joint angles, readings and rows of the fault table. */
#ifndef ETHD__SERVO_FEEDBACK_H
#define ETHD__SERVO_FEEDBACK_H

#include "encoder/unwrap.h"
#include "servo/link.h"

/* Shares of the largest torque, if a map has no torques of its own. The paper's arm: friction of 0.1 Nm, 1.2 to
   2 Nm at the drive's limit, so 4 to 6 times the friction, and 2 to 3 times. */
#define ETHD__SERVO_FREEZE 0.3
#define ETHD__SERVO_REVERSE 0.15
#define ETHD__SERVO_FOLLOW 0.020 /* s: a drive that doesn't follow its set-point for this time is a fault */

/* Bits of `has`; CUT: the sent torque differs from the commanded one. */
enum { ETHD__SERVO_HAS_SPEED = 1, ETHD__SERVO_HAS_READING = 2, ETHD__SERVO_HAS_CUT = 4 };

/* The I/O thread's data for the control thread, always complete; the control thread reads the newest. */
typedef struct ethd__servo_sample {
  int64_t stamp_ns; /* time of the joints' question: the joints were at `q` then or later */
  uint64_t number;  /* of good exchanges so far; unchanged if none is newer */
  int32_t has;
  uint32_t epoch;                   /* the start that this sample belongs to */
  double q[2], dq[2];               /* axes 1 and 2 of the map: rad, rad/s */
  int64_t later_ns[2];              /* delay of each axis's question after stamp_ns */
  double torque[2];                 /* Nm, as sent */
  double reading[2];                /* m: finger relative to the ring */
  int64_t reading_ns;               /* time of that reading */
  uint64_t readings;                /* number received */
  int64_t levels, grave;            /* rows of the fault table that hold at present, as bits */
  uint32_t rows[ETHD_FAULT_COUNT];  /* occurrences of each row */
  uint32_t worst[ETHD_FAULT_COUNT]; /* grave occurrences */
} ethd__servo_sample;

typedef struct ethd__servo_axis {
  bool referenced;      /* its angle is the joint's */
  bool jumped;          /* its last sample was dropped */
  bool started, counts; /* counts: its position is a counter, unwrapped and watched */
  ethd__encoder_def def;
  ethd__encoder encoder;
  double offset;    /* rad, added to the angle */
  int64_t since_ns; /* since this time the drive doesn't follow the torque; 0: it follows */
  double torque;    /* Nm, command of the exchange before */
} ethd__servo_axis;

typedef struct ethd__servo_feedback {
  ethd__servo_axis axes[2];
  bool absolute[2];                /* the position means the same angle after the drive lost its power */
  bool homing;                     /* a search runs; the encoders aren't watched against the torque then */
  double home[2];                  /* rad: the joints' angles at the first sample; NaN: from the register */
  double count;                    /* the last value of reading_count */
  uint32_t rows[ETHD_FAULT_COUNT]; /* occurrences of the encoders' rows */
  uint64_t connects;               /* the link's count of connections at the last sample */
  ethd__servo_sample sample;
} ethd__servo_feedback;

/* Prepares the counters of the map's positions, with the default watch on them. `torque`, Nm, is the largest torque
   that the controller may command a joint, INFINITY if it has no limit; `period` is an exchange's, s; `home` as above.
   The error names the field. [main] */
ETHD_MUST_CHECK ethd_status ethd__servo_feedback_make(ethd__servo_feedback *f, const ethd__servo_map *map,
                                                      double torque, double period, ethd_error *error);

/* Reads the answers of a successful cycle of the link. I/O side. */
void ethd__servo_feedback_take(ethd__servo_feedback *f, const ethd__servo_link *link, int64_t stamp_ns);

/* Sets the axis's angle at its last sample to q, rad. I/O side. */
void ethd__servo_feedback_place(ethd__servo_feedback *f, int axis, double q);

/* Updates the rows that hold at present; called after every cycle. I/O side. */
void ethd__servo_feedback_judge(ethd__servo_feedback *f, const ethd__servo_link *link);

#endif
