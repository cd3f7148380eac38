/* Computes the duration of an exchange on its wire from the map alone. */
#ifndef ETHD__SERVO_WIRE_H
#define ETHD__SERVO_WIRE_H

#include "servo/plan.h"

typedef struct ethd__servo_wire {
  uint32_t questions; /* in an exchange, without those about slow registers */
  uint32_t bytes;     /* of the questions and their answers */
  double usual;       /* s: their duration, with turnarounds and silences */
  double most;        /* s, with all questions about slow registers that may fall into one exchange */
} ethd__servo_wire;

/* Computes it from baud, format, bytes, silences and turnaround; for tcp from the turnarounds alone, as the
   network's rate isn't known. `turnaround` is the time from the end of a question to the beginning of its answer, s;
   NAN means the map's. [any] */
ethd__servo_wire ethd__servo_wire_of(const ethd__servo_map *map, double turnaround);

/* The smallest divisor at which an exchange of this length, s, with a tenth to spare, ends before the next begins.
   [any] */
uint32_t ethd__servo_divisor_for(double exchange, double period);

#endif
