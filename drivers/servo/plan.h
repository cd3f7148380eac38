/* The questions of one exchange. Adjacent registers of one unit with the same reading rate share a question; questions
   about slow registers are spread over the exchanges. */
#ifndef ETHD__SERVO_PLAN_H
#define ETHD__SERVO_PLAN_H

#include "servo/bus.h"

#define ETHD__SERVO_READ_MAX 125u /* words of one question */
#define ETHD__SERVO_WRITE_MAX 121u

#define ETHD__SERVO_WRITES_MAX 4u /* torque1, torque2, counter and counter2, each alone */

typedef struct ethd__servo_block {
  ethd__servo_span span;
  int32_t with;          /* the other half of a question that writes and reads; -1: none */
  uint32_t every, phase; /* asked when the exchange's number modulo every is phase */
  bool fresh;            /* asked in the last exchange */
  int64_t asked_ns;      /* CLOCK_MONOTONIC: before the question was last sent; its answer isn't older */
  uint16_t words[ETHD__SERVO_READ_MAX];
} ethd__servo_block;

typedef struct ethd__servo_plan {
  ethd__servo_block writes[ETHD__SERVO_WRITES_MAX], reads[ETHD__SERVO_REGISTERS_MAX];
  uint32_t write_count, read_count;
  uint32_t first;                             /* the write that begins the next exchange */
  int32_t block[ETHD__SERVO_REGISTERS_MAX];   /* of a cyclic register; -1: none */
  uint32_t offset[ETHD__SERVO_REGISTERS_MAX]; /* its first word there */
  uint32_t turn;                              /* exchanges so far */
  bool all;                                   /* the next exchange reads all registers: none is known yet */
} ethd__servo_plan;

/* Makes the plan of a map. [main] */
void ethd__servo_plan_make(const ethd__servo_map *map, ethd__servo_plan *out);

/* Returns the place of a cyclic register's words. [any] */
uint16_t *ethd__servo_plan_words(ethd__servo_plan *plan, const ethd__servo_map *map, int32_t r);

/* True when the register was read in the last exchange. [any] */
bool ethd__servo_plan_fresh(const ethd__servo_plan *plan, int32_t r);

/* Time of the register's last question: its value is not older. [any] */
int64_t ethd__servo_plan_asked(const ethd__servo_plan *plan, int32_t r);

/* Sends the questions in order, writes first, and stops at the first that isn't DONE. After a failed write the next
   exchange begins with the unit after it, so that a missing unit never keeps a set-point from the others. */
ethd__servo_outcome ethd__servo_plan_ask(ethd__servo_plan *plan, ethd__servo_bus *bus);

#endif
