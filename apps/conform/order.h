/* Finds a position's order of two words from its values: a joint stands within a turn and moves little from one reading
   to the next, while words that are exchanged make turns of it. */
#ifndef ETHD__APPS_CONFORM_ORDER_H
#define ETHD__APPS_CONFORM_ORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "servo/map.h"

/* Of a position; all zero before the first reading. Indices: ETHD__SERVO_HIGH_FIRST, ETHD__SERVO_LOW_FIRST. */
typedef struct ethd__position_seen {
  double angle[2]; /* rad at the joint, by the newest reading */
  double step[2];  /* rad, the largest from one reading to the next */
  double moved[2]; /* rad since the first reading, over the counter's end too */
  bool begun;
} ethd__position_seen;

/* Notes a reading's words. [main] */
void ethd__position_see(const ethd__servo_register *r, const uint16_t *words, ethd__position_seen *seen);

/* Returns the plausible order; ETHD__SERVO_NO_ORDER where both are, none is, or the position has one word. [any] */
int32_t ethd__position_order(const ethd__servo_register *r, const ethd__position_seen *seen);

/* Prints both angles, the plausible order, and what to change in the map. [main] */
void ethd__position_report(const ethd__servo_register *r, const ethd__position_seen *seen);

#endif
