/* A device under a controller: opened, stepped by a loop, stopped in order. All [main]. */
#ifndef ETHD__APPS_RUN_SESSION_H
#define ETHD__APPS_RUN_SESSION_H

#include <stdbool.h>

#include "run/recorder.h"

typedef struct ethd__session {
  ethd_config *config;
  ethd_device *device;
  const ethd__session_front *front;
  const ethd__controller *controller; /* of that front */
  void *control;                      /* such a controller */
  ethd__setup_copy setup;             /* the last posted one */
  double period;                      /* s */
  ethd_loop *loop;
  ethd__recorder recorder;
  bool is_virtual, posted, started;
  bool left;     /* the loop's thread hangs, so no memory that it may use is freed */
  bool lost;     /* it hangs in the device */
  int64_t clock; /* of a virtual session, ns */
} ethd__session;

typedef struct ethd__session_options {
  const char *config, *record, *telemetry, *snapshot; /* NULL: none; a recording has a snapshot of its own */
  uint32_t keeps;                                     /* record each keeps-th tick; 0 or 1: each */
  bool replace;                                       /* an earlier recording is replaced */
  bool group;                                         /* telemetry may go to a multicast or broadcast address */
  const char *text;   /* text in place of the configuration's file; NULL: the file is read */
  const char *folder; /* where relative paths of [device] start; NULL: where the configuration is */
  ethd__sink sink;
  bool is_virtual;
  bool home;          /* the device finds its joints' angles before it is started */
  ethd_loop_def loop; /* the session fills in its device, controller, period and clock */
} ethd__session_options;

/* Opens and starts the device; then the loop runs, or on a virtual clock has made its first tick. A failure closes
   all. */
ETHD_MUST_CHECK ethd_status ethd__session_open(const ethd__session_options *options, ethd__session *s,
                                               char message[ETHD_MESSAGE_MAX]);

/* Returns whether a reading of the finger has come; waits a moment for the first one of a live session. */
bool ethd__session_sees_finger(ethd__session *s);

/* Brakes the ring until it stands still, then disables the device. `told`: a signal requested it. */
void ethd__session_halt(ethd__session *s, bool told);

/* Returns false if the loop's thread has ended or hangs. */
bool ethd__session_lives(const ethd__session *s);

/* Ends the loop and the device; figures can still be read afterwards. Returns ETHD_E_DEVICE if the clock had failed or
   the device hangs, ETHD_E_LAW if a law hangs. */
ETHD_MUST_CHECK ethd_status ethd__session_end(ethd__session *s, char message[ETHD_MESSAGE_MAX]);
void ethd__session_free(ethd__session *s);

/* Posts a changed setup; kind and detail as in events.csv. On a live session it is in force when this returns. */
ETHD_MUST_CHECK ethd_status ethd__session_post(ethd__session *s, const ethd__setup_copy *setup, const char *kind,
                                               const char *detail, char message[ETHD_MESSAGE_MAX]);

/* Returns for how long no row has called for a stop since a fault was latched, s, and in *needed the time that an
   acknowledgement requires. */
double ethd__session_clean_time(const ethd__session *s, double *needed);

/* Acknowledges a latched fault and waits for the step that clears it, so that the next query sees the result. Returns
   false if a fault is latched after that step: the old one, or another. */
bool ethd__session_acknowledge(ethd__session *s);

/* Starts the device again and resets the controller; the torque rises from zero. */
ETHD_MUST_CHECK ethd_status ethd__session_enable(ethd__session *s);

/* Takes the controller's events and sends the application's beat; call it more often than every heartbeat. */
void ethd__session_poll(ethd__session *s);

/* Waits until the loop has made a tick, but no longer than a second. */
void ethd__session_await_tick(ethd__session *s);

/* Makes one tick of a virtual session. */
void ethd__session_tick(ethd__session *s);

/* Returns the time since the start, s on the loop's clock, missed periods included. */
double ethd__session_time(const ethd__session *s);

#endif
