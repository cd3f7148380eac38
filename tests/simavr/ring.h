/* Four boards with their 16 sensors, their wires and the firmware in them, in simulated time. */
#ifndef SIMAVR_RING_H
#define SIMAVR_RING_H

#include <stdbool.h>
#include <stdint.h>

#include <sim_avr.h>

#include "sensor.h"
#include "two_wire.h"

#define RING_BOARDS 4
#define RING_LANES 4
#define RING_SENSORS 16
#define RING_FREQUENCY 16000000

typedef struct ring ring;

typedef struct ring_board {
  ring *ring;
  int number;
  avr_t *avr;
  avr_io_t io; /* notifies of resets */
  avr_run_t run;
  uint8_t ddr_b, ddr_c, ddr_d;
  bool scl_shorted;
  bool deaf; /* the start line is broken on its way here */
  sensor sensor[RING_LANES];
  uint64_t awake; /* cycles */
} ring_board;

typedef struct ring_range {
  uint64_t min, max, sum, count;
} ring_range;

struct ring {
  ring_board board[RING_BOARDS];
  two_wire link;
  bus_times times;
  uint64_t now; /* cycles */
  bool slow;
  bool started; /* level of the start line: low */
  uint64_t start;
  ring_range period, begin[RING_LANES], last_byte; /* begin: by slot */
  uint64_t faced; /* times that a sensor began while the one across the ring was shining */
  void (*sent)(void *context, uint8_t byte);
  void *context;
};

/* NULL and one line on stderr when the firmware can't be loaded. `slow` sets the strap of 400 kBd. It lives as long
   as the process: simavr can't take a core apart wholly. */
ring *ring_create(const char *firmware, bool slow);

void ring_run(ring *r, uint64_t until);

/* An external reset; a program that hangs with interrupts off. */
void ring_reset(ring *r, int board);
void ring_hang(ring *r, int board);

/* The speed that board 0's UART is set to, bits per second. */
double ring_baud(const ring *r);

/* After levels or faults of sensors have been changed from outside. */
void ring_touch(ring *r);

#endif
