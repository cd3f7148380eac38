/* Between the files that ask on a bus. */
#ifndef ETHD_SERVO_BUS_PARTS_H
#define ETHD_SERVO_BUS_PARTS_H

#include "servo/bus.h"
#include "servo/frame.h"

/* One question in our own framing, and its answer's words, NULL where none are awaited. 0 or an errno, libmodbus's
   among them. */
int ethd__servo_ask(const ethd__servo_bus *bus, const ethd__servo_frame *question, uint16_t *words);

#endif
