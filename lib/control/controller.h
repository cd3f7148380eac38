/* The controller's own memory: two plans, the state, a copy of it for rehearsals and swaps, and the event ring.

   Threads share three things without a lock. `posted`: [main] writes the plan that doesn't rule and sets it; [rt] takes
   that plan and clears it only when it needs neither the old plan nor the old scenes any more. `clear`: [any] sets it,
   [rt] clears it. The event ring: `head` and `tail` count events that were ever pushed and taken, so their difference
   is the fill and 64, a power of two, makes them wrap round without harm. [rt] writes an event and then `head`, with
   release; [main] reads `head` with acquire, so it sees the whole event, copies it and then writes `tail`, with
   release; [rt] reads `tail` with acquire before it uses that entry again. Each end has one writer; neither waits. */
#ifndef ETHD__CONTROL_CONTROLLER_H
#define ETHD__CONTROL_CONTROLLER_H

#include <stdatomic.h>

#include "control/state.h"

#define ETHD__EVENTS 64

typedef struct ethd__events {
  _Alignas(64) atomic_uint head; /* next to write, [rt] */
  _Alignas(64) atomic_uint tail; /* next to read, [main] */
  ethd_event at[ETHD__EVENTS];
} ethd__events;

/* Pushes an event; returns false if there is no room. [rt] */
bool ethd__events_push(ethd__events *events, const ethd_event *event) ETHD_RT;

/* Returns for how many events there is room. [rt] */
unsigned ethd__events_room(ethd__events *events) ETHD_RT;

struct ethd_control {
  double period; /* of any plan */
  ethd__plan plans[2];
  int ruling; /* index of the plan that rules; [rt] writes it before it clears `posted` */
  atomic_int posted, clear;
  ethd__state state, scratch;
  ethd__events events;
};

#endif
