/* Four I2C buses that share SCL and are spoken to at once, bit by bit: reading four sensors takes the time of one.

   Every call takes a set of lanes (bit l = lane l) and returns the set of those that did all that was asked. A lane
   that doesn't acknowledge, or whose SDA is held low, drops out and the others go on; if SCL is held low, all drop out.
   No call takes longer than its bits and 20 us. */
#ifndef LANES_H
#define LANES_H

#include <stdint.h>

void lanes_open(void);

/* Writes one register. */
uint8_t lanes_put(uint8_t lanes, uint8_t address, uint8_t reg, uint8_t value);

/* Reads `count` registers from `reg` on, the n-th into out[n]: its eight bits, each with those of all lanes. */
uint8_t lanes_get(uint8_t lanes, uint8_t address, uint8_t reg, uint8_t count, uint8_t out[][8]);

/* Turns such bits into a byte of each lane. */
void lanes_split(const uint8_t bits[8], uint8_t out[4]);

/* Returns the lanes whose SDA is held low although the bus is idle. */
uint8_t lanes_held(void);

/* Gives held lanes up to nine clocks, so that an interrupted sensor can finish its byte, and then a stop. */
uint8_t lanes_free(uint8_t lanes);

#endif
