/* The servo's own memory, grouped by the thread to which it belongs. */
#ifndef ETHD__SERVO_DEVICE_H
#define ETHD__SERVO_DEVICE_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "ethd/cell.h"
#include "ethd/driver.h"
#include "ethd/loop.h"
#include "servo/feedback.h"
#include "servo/guardian.h"
#include "servo/homing.h"

#define ETHD__SERVO_OLD_MOST 50000000 /* ns: older feedback ends the torque, on a slow bus too */

typedef struct ethd__servo_command {
  int64_t stamp_ns;
  uint32_t epoch;
  double torque[2]; /* Nm at the map's axes */
} ethd__servo_command;

typedef struct ethd__servo_device {
  /* constant after opening */
  ethd__servo_map map;
  char map_name[96];     /* from the settings */
  char wire[300];        /* the remark about the duration of an exchange */
  char unconfirmed[128]; /* the remark about unconfirmed registers; empty: there are none */
  char coarse[160];      /* the remark about a torque whose first count is over the limit; empty: there is none */
  char inertia[2][192];  /* remarks about the inertia of the map's axes; empty: there is none */
  int64_t period_ns, exchange_ns;
  double speed;               /* m/s: the ring's largest allowed speed */
  bool is_virtual;            /* whether the clock is virtual */
  ethd__homing_def homing[2]; /* of the map's axes */
  double home[2];             /* rad: in the jig, at the stop or at the mark; NAN: not given */
  int32_t joint[2];           /* joint, from 0, of the map's axes; -1: none */
  ethd_cell *commands, *samples;

  /* any thread */
  atomic_int safe;   /* 1: zero torque until the next start */
  atomic_int clear;  /* 1: [clear] is to run */
  atomic_uint epoch; /* number of starts so far */

  /* [rt] */
  ethd__servo_sample newest;
  uint64_t seen_number, seen_readings;
  uint32_t seen_rows[ETHD_FAULT_COUNT], seen_worst[ETHD_FAULT_COUNT];
  uint32_t seen_epoch;
  int64_t grace_ns;
  ethd_histogram age;

  /* protected by the lock: the I/O thread, or [main] in start and stop, holds it */
  pthread_mutex_t lock;
  ethd__servo_link link;
  ethd__guardian guardian;        /* no process if the drive has a watchdog */
  char guarded[ETHD_MESSAGE_MAX]; /* the remark about it; empty: there is none */
  const char *unarmed;            /* reason not to enable the drive here: the guardian would end with us; NULL: none */
  ethd__servo_feedback feedback;
  ethd__servo_command command;
  int64_t due_ns;
  char why[ETHD_MESSAGE_MAX]; /* reason of the last start's failure; empty: none */
  ethd_histogram trip;
} ethd__servo_device;

enum {
  ETHD__SERVO_Q1,
  ETHD__SERVO_Q2,
  ETHD__SERVO_JOINT,
  ETHD__SERVO_SPEED,
  ETHD__SERVO_HOME,
  ETHD__SERVO_HOME_SPEED,
  ETHD__SERVO_HOME_TORQUE,
  ETHD__SERVO_HOME_WAY1,
  ETHD__SERVO_HOME_WAY2,
  ETHD__SERVO_UNGUARDED,
  ETHD__SERVO_PARAMS
};

extern const ethd_param ethd__servo_params[ETHD__SERVO_PARAMS];
extern const char *const ethd__servo_keys[];

/* The driver's functions. */
ethd_status ethd__servo_prepare(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]);
ethd_status ethd__servo_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]);
ethd_status ethd__servo_start(void *device);
ethd_status ethd__servo_stop(void *device);
void ethd__servo_close(void *device);
void ethd__servo_clear(void *device);
ethd_status ethd__servo_home(void *device, const double q[2]);
const char *ethd__servo_why(const void *device);
ethd_status ethd__servo_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT;
ethd_status ethd__servo_write(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT;
void ethd__servo_safe(void *device) ETHD_RT;
ethd_status ethd__servo_service(void *device, uint32_t unit, int64_t now_ns);

/* The age in ns at which feedback or a command is too old. [any] */
int64_t ethd__servo_old(const ethd__servo_device *d) ETHD_RT;

/* Enables: writes zero, reads it back from the drive, and runs [enable]. Disables from any state by [disable]. The
   link's message gives the reason of a failure. [main], locked */
ETHD_MUST_CHECK ethd_status ethd__servo_enable(ethd__servo_device *d);
ETHD_MUST_CHECK ethd_status ethd__servo_disable(ethd__servo_device *d);

/* Returns the number, from 1, of a joint whose angle isn't known; 0 when all are known. */
int32_t ethd__servo_lost(const ethd__servo_device *d);

/* Connects for the first time, and identifies the drive. [main] */
ETHD_MUST_CHECK ethd_status ethd__servo_meet(ethd__servo_device *d);

/* Runs one cycle of the link and publishes its result; locked. */
ethd_status ethd__servo_turn(ethd__servo_device *d, int64_t now_ns, const double torque[2]);

#endif
