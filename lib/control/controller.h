/* The controller's own memory: two plans, the state, a copy of it to run dry on, the event ring.

   Threads meet in three words, each with one writer at a time: `posted` ([main] sets, [rt] clears),
   `clear` ([any] sets, [rt] clears), the event ring's two ends. */
#ifndef ETHD__CONTROLLER_H
#define ETHD__CONTROLLER_H

#include <stdatomic.h>

#include "control/state.h"

#define ETHD__EVENTS 64

typedef struct ethd__events {
  _Alignas(64) atomic_uint head; /* next to write, [rt] */
  _Alignas(64) atomic_uint tail; /* next to read, [main] */
  ethd_event at[ETHD__EVENTS];
} ethd__events;

/* False when there is no room. [rt] */
bool ethd__events_push(ethd__events *events, const ethd_event *event) ETHD_RT;
unsigned ethd__events_room(ethd__events *events) ETHD_RT;

struct ethd_control {
  double period; /* of any plan */
  ethd__plan plans[2];
  int ruling; /* index of the plan that rules; written by [rt] before `posted` is cleared */
  atomic_int posted, clear;
  ethd__state state, scratch;
  ethd__events events;
};

#endif
