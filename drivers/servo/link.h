/* The link to a drive is a state machine over exchanges. It never enables by itself.

          open, quiet        steps of [identify]
     DOWN ----------> UP -------------------> IDENTIFIED --- steps of [enable] ---> ENABLED
      ^                                           ^                                   |
      '--- the line is lost, or silent for long   '--- steps of [disable]: asked, ----'
           (then a back-off before it opens)           or the device is made safe

   After any error nothing is sent until the line has been quiet; the state stays, and set-points continue after that.
   The loss of the line ends ENABLED, and the first set-point of every connection is zero torque. */
#ifndef ETHD__SERVO_LINK_H
#define ETHD__SERVO_LINK_H

#include "ethd/fault.h"
#include "servo/plan.h"

typedef enum ethd__servo_state {
  ETHD__SERVO_DOWN,
  ETHD__SERVO_UP,
  ETHD__SERVO_IDENTIFIED,
  ETHD__SERVO_ENABLED
} ethd__servo_state;

typedef struct ethd__servo_counts {
  uint64_t exchanges, missing, stale, garbled, busy, refused, failed, lost, connects;
} ethd__servo_counts;

typedef struct ethd__servo_link {
  const ethd__servo_map *map;
  ethd__servo_plan plan;
  ethd__servo_bus bus;
  ethd__servo_state state;
  bool draining, echo_failed; /* echo_failed: the last exchange's echo differed from the written value */
  bool set_point_stays;       /* a start was refused because the drive still shows an old set-point */
  uint16_t counter;
  int32_t sequence;                      /* the sequence that runs; -1: none */
  uint32_t step;                         /* its present step */
  bool skipped;                          /* [disable] has continued without a unit that didn't answer */
  int64_t step_ns;                       /* its beginning */
  ethd_status result;                    /* of the last sequence */
  int32_t bucket;                        /* a leaky bucket: rises with bad answers, falls with good ones */
  int64_t heard_ns;                      /* time of the last good exchange, or of the connection */
  int64_t attempt_ns;                    /* time of the next attempt to connect */
  double back_off;                       /* s */
  double raw[ETHD__SERVO_REGISTERS_MAX]; /* values last read; of torques, last written */
  uint32_t rows[ETHD_FAULT_COUNT];       /* occurrences of each row of the fault table */
  ethd__servo_counts counts;
  char message[ETHD_MESSAGE_MAX]; /* of the last failure */
} ethd__servo_link;

#define ETHD__SERVO_BUCKET_LIMIT 50

/* Makes a link that is DOWN and hasn't tried yet. The map outlives the link. */
void ethd__servo_link_make(const ethd__servo_map *map, ethd__servo_link *out);

/* Tries once to connect, now. On failure the next attempt is due after the back-off. [main] or I/O */
ETHD_MUST_CHECK ethd_status ethd__servo_link_connect(ethd__servo_link *link, int64_t now_ns);

/* Runs one cycle: connects when due, or drains, or makes an exchange with this torque (Nm at the joints; zero is sent
   unless ENABLED) and a step of the running sequence. ETHD_OK: raw has fresh values; ETHD_STATUS_STALE: nothing was
   due; ETHD_E_DEVICE: no answer or a bad one. */
ETHD_MUST_CHECK ethd_status ethd__servo_link_turn(ethd__servo_link *link, int64_t now_ns, const double torque[2]);

/* Begins a sequence; the next cycles run its steps. [enable] ends in ENABLED; [disable] leaves that state at once. */
void ethd__servo_link_begin(ethd__servo_link *link, int32_t sequence, int64_t now_ns);

/* Closes a line that is gone, for the reason `why`; it is opened again after the back-off. */
void ethd__servo_link_lose(ethd__servo_link *link, const char *why, int64_t now_ns);

/* Closes the line. */
void ethd__servo_link_close(ethd__servo_link *link);

/* Runs one step of the present sequence. Internal to the link. */
ethd__servo_outcome ethd__servo_sequence_turn(ethd__servo_link *link, int64_t now_ns);

#endif
