/* The period of 300 Hz: when it begins, instants within it, the board's clock.

   Timer 1 runs freely at 16 MHz. On board 0 it makes periods of 53333, 53333 and 53334 cycles, so that three last 10
   ms; at each start board 0 pulls the start line low. The other boards begin when they see that line fall. */
#ifndef PERIOD_H
#define PERIOD_H

#include <stdbool.h>
#include <stdint.h>

typedef struct period {
  uint16_t start; /* the timer then */
  uint32_t time;  /* us, board 0 only */
  bool late;      /* a period was lost before this one, board 0 only */
} period;

void period_open(bool leader);

/* Sleeps until a period begins. False: the timer has gone round and none began (boards 1..3 only). */
bool period_next(period *out);

/* Sleeps until the timer shows `instant`, less than 2 ms ahead; returns at once if that was before. */
void period_wait(uint16_t instant);

/* Board 0: releases the start line. */
void period_release(void);

#endif
