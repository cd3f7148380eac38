/* Turns a drive's answers into joint angles, readings and rows of the fault table. */
#ifndef ETHD__SERVO_FEEDBACK_H
#define ETHD__SERVO_FEEDBACK_H

#include "encoder/unwrap.h"
#include "servo/link.h"

/* Shares of the largest torque, where a map has no torques of its own. The paper's arm: friction of 0.1 Nm, 1.2 to
   2 Nm at the drive's limit, so 4 to 6 times the friction, and 2 to 3 times. */
#define ETHD__SERVO_FREEZE 0.3
#define ETHD__SERVO_REVERSE 0.15
#define ETHD__SERVO_FOLLOW 0.020 /* s: a drive that doesn't follow its set-point for so long is a fault */

/* Bits of `has`; CUT: the torque went out otherwise than it was asked for. */
enum { ETHD__SERVO_HAS_SPEED = 1, ETHD__SERVO_HAS_READING = 2, ETHD__SERVO_HAS_CUT = 4 };

/* What the I/O thread hands to the control thread, always whole; the control thread takes the newest. */
typedef struct ethd__servo_sample {
  int64_t stamp_ns; /* when the joints were asked for: they were where `q` says then, or later */
  uint64_t number;  /* of good exchanges so far; unchanged when nothing newer has come */
  int32_t has;
  uint32_t epoch;                   /* the start that this sample belongs to */
  double q[2], dq[2];               /* axes 1 and 2 of the map: rad, rad/s */
  int64_t later_ns[2];              /* by how much later than stamp_ns each axis was asked for */
  double torque[2];                 /* Nm, as it went out */
  double reading[2];                /* m: finger relative to the ring */
  int64_t reading_ns;               /* when it was taken */
  uint64_t readings;                /* how many have come */
  int64_t levels, grave;            /* rows of the fault table that hold at present, as bits */
  uint32_t rows[ETHD_FAULT_COUNT];  /* how often a row was seen */
  uint32_t worst[ETHD_FAULT_COUNT]; /* how often it was grave */
} ethd__servo_sample;

typedef struct ethd__servo_axis {
  bool referenced;      /* its angle is the joint's */
  bool jumped;          /* its last sample was dropped */
  bool started, counts; /* counts: its position is a counter, unwrapped and watched */
  ethd__encoder_def def;
  ethd__encoder encoder;
  double offset;    /* rad, added to the angle */
  int64_t since_ns; /* since when the torque isn't followed; 0 while it is */
  double torque;    /* Nm, which the exchange before asked for */
} ethd__servo_axis;

typedef struct ethd__servo_feedback {
  ethd__servo_axis axes[2];
  bool absolute[2];                /* the position means the same angle after the drive lost its power */
  bool homing;                     /* a search runs; the encoders aren't watched against the torque then */
  double home[2];                  /* rad: where the joints stand at the first sample; NaN: as the register says */
  double count;                    /* the last value of reading_count */
  uint32_t rows[ETHD_FAULT_COUNT]; /* how often the encoders' rows were seen */
  uint64_t connects;               /* the link's count of connections at the last sample */
  ethd__servo_sample sample;
} ethd__servo_feedback;

/* Prepares the counters of the map's positions, with the default watch on them. `torque`, Nm, is the most that the
   controller may ask of a joint, INFINITY if it has no limit; `period` is an exchange's, s; `home` as above. The error
   names the field. [main] */
ETHD_MUST_CHECK ethd_status ethd__servo_feedback_make(ethd__servo_feedback *f, const ethd__servo_map *map,
                                                      double torque, double period, ethd_error *error);

/* Takes the answers of a turn of the link that went well. I/O side. */
void ethd__servo_feedback_take(ethd__servo_feedback *f, const ethd__servo_link *link, int64_t stamp_ns);

/* Says that the axis was at q, rad, at its last sample. I/O side. */
void ethd__servo_feedback_place(ethd__servo_feedback *f, int axis, double q);

/* Updates the rows that hold at present; called after every turn. I/O side. */
void ethd__servo_feedback_judge(ethd__servo_feedback *f, const ethd__servo_link *link);

#endif
