/* A script of a device's faults and their times. One line for each injection, and # begins a comment.

       TIME CHANNEL KIND [by=NUMBER] [for=SECONDS]

       0.500  q1       freeze          for=0.1      # an encoder that stands still
       0.500  q2       offset  by=0.2               # one sample: for= is one period by default
       612t   rays     nan             for=inf      # t: periods since the start
       0.700  reading  delay   by=0.02 for=0.2
       0.700  write    drop            for=0.005
       0.900  fault9   set                          # the drive reports a fault

   TIME counts from the first sample after the device's start. Without a number a channel means all of its numbers: q is
   q1 and q2. Two tables in script.c list the channels and kinds. A device in space has x1 to x3, v1 to v3, centre1 to
   centre3 (its reading) and finger1 to finger3. */
#ifndef ETHD__INJECT_SCRIPT_H
#define ETHD__INJECT_SCRIPT_H

#include <stdbool.h>

#include "ethd/driver.h"
#include "ethd/estimate.h"

#define ETHD_INJECT_LINES_MAX 1024
#define ETHD_INJECT_BYTES_MAX ((size_t)1 << 20)

typedef enum ethd__inject_channel {
  ETHD__INJECT_Q,
  ETHD__INJECT_DQ,
  ETHD__INJECT_CENTRE,
  ETHD__INJECT_FINGER,
  ETHD__INJECT_RING,
  ETHD__INJECT_RAY,
  ETHD__INJECT_X, /* of an effector in space */
  ETHD__INJECT_V,
  ETHD__INJECT_TIME,    /* of the joint sample */
  ETHD__INJECT_READING, /* of the finger, whole */
  ETHD__INJECT_READ,    /* the calls of a driver */
  ETHD__INJECT_WRITE,
  ETHD__INJECT_SERVICE,
  ETHD__INJECT_START,
  ETHD__INJECT_FAULT, /* rows of the table */
  ETHD__INJECT_CHANNELS
} ethd__inject_channel;

typedef enum ethd__inject_kind {
  ETHD__INJECT_FREEZE,  /* the number stays what it was when the injection began */
  ETHD__INJECT_OFFSET,  /* `by` is added */
  ETHD__INJECT_REVERSE, /* the angle moves backwards from where it was when the injection began */
  ETHD__INJECT_SCALE,   /* the number is multiplied with `by` */
  ETHD__INJECT_NOISE,   /* noise is added, uniform in [-by, by) */
  ETHD__INJECT_SET_TO,  /* the number becomes `by` */
  ETHD__INJECT_NAN,
  ETHD__INJECT_DROP,  /* it never arrives */
  ETHD__INJECT_DELAY, /* it arrives `by` seconds later */
  ETHD__INJECT_FAIL,  /* the call reports a failed device */
  ETHD__INJECT_STALE, /* the call reports no newer data */
  ETHD__INJECT_SET,   /* the row is seen */
  ETHD__INJECT_GRAVE, /* the row is seen, and is grave */
  ETHD__INJECT_KINDS
} ethd__inject_kind;

typedef struct ethd__injection {
  int64_t from_ns, until_ns; /* since the first sample; [from, until) */
  ethd__inject_channel channel;
  ethd__inject_kind kind;
  uint32_t first, count; /* numbers of the channel */
  double by;
  int line;
  bool begun; /* while it runs, `held` is known */
  double held[ETHD_RAYS];
} ethd__injection;

typedef struct ethd__script {
  uint32_t count;
  ethd__injection *at;
} ethd__script;

/* The device of a script. */
typedef struct ethd__script_of {
  double period; /* s */
  bool in_space; /* the device has the front of space.h */
} ethd__script_of;

/* Parses a script, which messages call `name`. text[length] is 0. On failure *out is empty. [main] */
ETHD_MUST_CHECK ethd_status ethd__script_parse(const char *text, size_t length, const char *name, ethd__script_of of,
                                               ethd__script *out, char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__script_load(const char *path, ethd__script_of of, ethd__script *out,
                                              char message[ETHD_MESSAGE_MAX]);
void ethd__script_free(ethd__script *script);

#endif
