/* How long an exchange takes on its wire: what a map costs before any drive was asked. */
#ifndef ETHD_SERVO_WIRE_H
#define ETHD_SERVO_WIRE_H

#include "servo/plan.h"

typedef struct ethd__servo_wire {
  uint32_t questions; /* of an exchange, those about slow registers apart */
  uint32_t bytes;     /* of those questions and their answers */
  double usual;       /* s: of those, turnarounds and silences included */
  double most;        /* s: with every question about slow registers that falls into one exchange */
} ethd__servo_wire;

/* From baud, format, bytes, silences and the map's turnaround; of tcp the turnarounds alone, as the network's rate isn't
   known. `turnaround`, s: from the end of a question to the begin of its answer, NAN: the map's. [any] */
ethd__servo_wire ethd__servo_wire_of(const ethd__servo_map *map, double turnaround);

/* The least divisor at which `exchange` seconds, with a tenth to spare, end before the next begins. [any] */
uint32_t ethd__servo_divisor_for(double exchange, double period);

#endif
