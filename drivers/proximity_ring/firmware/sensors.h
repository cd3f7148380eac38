/* The four sensors of this board. */
#ifndef SENSORS_H
#define SENSORS_H

#include <stdbool.h>
#include <stdint.h>

void sensors_open(void);

/* Sends the settings to the sensors that don't have them yet, or have lost them. */
void sensors_settle(void);

/* Lets one sensor begin to measure. */
void sensors_begin(uint8_t lane);

/* Reads all sensors: 0 = missing (no answer, not ready, no settings), 0xFFFF = saturated. Returns true if a lane was
   held low and has been clocked free. */
bool sensors_read(uint16_t counts[4]);

#endif
