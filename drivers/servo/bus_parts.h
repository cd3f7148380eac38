/* Shared by the files that send questions on a bus. */
#ifndef ETHD__SERVO_BUS_PARTS_H
#define ETHD__SERVO_BUS_PARTS_H

#include "servo/bus.h"
#include "servo/frame.h"

/* Sends one question in our own framing and stores its answer's words; `words` is NULL if none are expected. Returns
   0 or an errno, which may be one of libmodbus's. */
int ethd__servo_ask(const ethd__servo_bus *bus, const ethd__servo_frame *question, uint16_t *words);

#endif
