/* Data between threads, without a lock.

   `posted`: [main] writes the plan that isn't in force and sets it; [rt] takes that plan and clears it only when it no
   longer needs the old plan and the old scenes. `clear`: [any] sets it, [rt] clears it. The event ring: `head` and
   `tail` count all events ever pushed and taken. Their difference is the fill; since 64 is a power of two, they may
   wrap round. [rt] writes an event and then `head`, with release; [main] reads `head` with acquire, so it sees the
   whole event, copies it and then writes `tail`, with release; [rt] reads `tail` with acquire before it uses that entry
   again. Each end has one writer; neither waits. */
#ifndef ETHD__CORE_MAIL_H
#define ETHD__CORE_MAIL_H

#include <stdatomic.h>

#include "core/state.h"

#define ETHD__EVENTS 64

typedef struct ethd__mail {
  int ruling; /* index of the plan in force, of two; [rt] writes it before it clears `posted` */
  atomic_int posted, clear;
  _Alignas(64) atomic_uint head; /* next event to write, [rt] */
  _Alignas(64) atomic_uint tail; /* next to read, [main] */
  ethd_event at[ETHD__EVENTS];
} ethd__mail;

/* Pushes an event; without room it is counted as dropped. [rt] */
void ethd__mail_push(ethd__mail *mail, ethd__core *core, const ethd_event *event) ETHD_RT;

/* Takes the next event, as ethd_control_poll does. [main] */
ethd_status ethd__mail_poll(ethd__mail *mail, ethd_event *out);

/* Puts a posted plan in force if there is one, and room for `events` events, so that no replaced scene is lost. Returns
   whether it did. [rt] */
bool ethd__mail_take(ethd__mail *mail, ethd__core *core, unsigned events) ETHD_RT;

/* Takes an acknowledgement, and returns whether it counts: a fault is latched, and no row has called for a stop for
   clean_time, s, in periods of `period` s. [rt] */
bool ethd__mail_clear(ethd__mail *mail, ethd__core *core, double period, double clean_time) ETHD_RT;

/* Returns for how long, s, no row has called for a stop; INFINITY: no fault is latched. [any] */
double ethd__core_clean_time(const ethd__core *core, double period) ETHD_RT;

/* Counts the occurrences that begin at this tick and makes their events. [rt] */
void ethd__mail_report(ethd__mail *mail, ethd__core *core, bool latches, int64_t tick) ETHD_RT;

#endif
