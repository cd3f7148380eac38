/* A device under a controller: opened, stepped by a loop, stopped in order. All [main]. */
#ifndef ETHD_APPS_RUN_SESSION_H
#define ETHD_APPS_RUN_SESSION_H

#include <stdbool.h>

#include "ethd/loop.h"
#include "run/recorder.h"

typedef struct ethd__session {
  ethd_config *config;
  const ethd_driver *driver;
  void *device;
  ethd_setup setup; /* posted last */
  ethd_control *control;
  ethd_loop *loop;
  ethd__recorder recorder;
  bool is_virtual, posted, started;
  bool left;     /* the loop's thread hangs: what it may touch stays */
  bool lost;     /* likewise, in the device */
  int64_t clock; /* of a virtual session, ns */
} ethd__session;

typedef struct ethd__session_options {
  const char *config, *record, *telemetry, *snapshot; /* NULL: none; a recording has a snapshot of its own */
  uint32_t keeps;                                     /* ticks from one that is recorded to the next; 0 or 1: each */
  bool replace;                                       /* an earlier recording */
  bool group;                                         /* telemetry may go to a multicast or broadcast address */
  const char *text;   /* stands for what the configuration's file holds; NULL: it is read */
  const char *folder; /* where relative paths of [device] start; NULL: where the configuration is */
  ethd__sink sink;
  bool is_virtual;
  bool home;          /* the device finds out where its joints stand, before it is started */
  ethd_loop_def loop; /* its device, controller, period and clock are filled in */
} ethd__session_options;

/* Opens and starts the device; the loop runs, or on a virtual clock has made its first tick. On failure
   all is closed. */
ETHD_MUST_CHECK ethd_status ethd__session_open(const ethd__session_options *options, ethd__session *s,
                                               char message[ETHD_MESSAGE_MAX]);

/* Whether a reading of the finger has come; a live session is given a moment for its first one. */
bool ethd__session_sees_finger(ethd__session *s);

/* Damps the ring until it is still, then disables. told: a signal asked for it. */
void ethd__session_halt(ethd__session *s, bool told);

/* False: the loop's thread has ended or hangs. */
bool ethd__session_lives(const ethd__session *s);

/* Ends the loop and the device: numbers can be read, nothing moves. ETHD_E_DEVICE: the clock had failed, or the device
   hangs; ETHD_E_LAW: a law hangs. */
ETHD_MUST_CHECK ethd_status ethd__session_end(ethd__session *s, char message[ETHD_MESSAGE_MAX]);
void ethd__session_free(ethd__session *s);

/* Posts a changed setup; kind and detail as in events.csv. On a live session it rules when this returns. */
ETHD_MUST_CHECK ethd_status ethd__session_post(ethd__session *s, const ethd_setup *setup, const char *kind,
                                               const char *detail, char message[ETHD_MESSAGE_MAX]);

/* Starts the device again and resets the controller; the torque rises from zero. */
ETHD_MUST_CHECK ethd_status ethd__session_enable(ethd__session *s);

/* Takes the controller's events and sends the application's beat; call it more often than every heartbeat. */
void ethd__session_poll(ethd__session *s);

/* A tick of a virtual session. */
void ethd__session_tick(ethd__session *s);

/* s on the loop's clock, missed periods included. */
double ethd__session_time(const ethd__session *s);

#endif
