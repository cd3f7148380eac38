/* What the files that ask on a bus share. */
#ifndef ETHD__SERVO_BUS_PARTS_H
#define ETHD__SERVO_BUS_PARTS_H

#include "servo/bus.h"
#include "servo/frame.h"

/* Asks one question in our own framing and stores its answer's words; `words` is NULL where none are awaited. Returns
   0 or an errno, which may be one of libmodbus's. */
int ethd__servo_ask(const ethd__servo_bus *bus, const ethd__servo_frame *question, uint16_t *words);

#endif
