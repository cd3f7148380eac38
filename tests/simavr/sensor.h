/* A VCNL4000 as its bus sees it: SCL and SDA, level by level, and what its registers then do.

   Modelled: address 0x13, the register pointer and its counting on, command, product id, emitter current,
   timing, ambient and proximity results, the data-ready bit, a conversion time of its own for each sensor (170 to
   400 us), settings lost with the supply. Measured: the times that fast-mode I2C asks for. */
#ifndef SIMAVR_SENSOR_H
#define SIMAVR_SENSOR_H

#include <stdbool.h>
#include <stdint.h>

/* Cycles of 16 MHz that the bus must keep: SCL low 1.3 us, high 0.6 us, start and stop 0.6 us, free 1.3 us. */
enum { BUS_LOW = 21, BUS_HIGH = 10, BUS_HOLD = 10, BUS_FREE = 21 };

/* What the master did on the bus, in cycles. */
typedef struct bus_times {
  uint64_t low_min, high_min, bit_min; /* of SCL */
  uint64_t put_min, put_max;           /* a register written, start to stop */
  uint64_t get_min, get_max;           /* registers read, start to stop */
  uint64_t hurried;                    /* times that were shorter than they may be */
} bus_times;

typedef struct sensor {
  uint16_t level; /* what a measurement at 100 mA finds; set from outside */
  bool mute;      /* no supply */
  bool shorted;   /* SDA to ground, for ever */
  bool slow;      /* takes 2 ms to measure */
  int stuck;      /* clocks that SDA stays low */
  uint64_t began; /* the last conversion, cycles */
  bool begun;     /* and one has begun since this was last cleared */

  uint64_t convert; /* cycles */
  bool measuring, ready;
  uint8_t current, timing;
  uint16_t result, seen;
  uint8_t pointer;

  enum { SENSOR_IDLE, SENSOR_LISTEN, SENSOR_TALK, SENSOR_DEAF } mode;
  int byte, bit; /* of this transaction; bit 8 is the acknowledgement */
  uint8_t shift;
  bool reads, pulls, scl, sda;
  bus_times *times;
  uint64_t scl_rose, scl_fell, started, stopped;
} sensor;

void sensor_power(sensor *s, int number, bus_times *times);

/* The levels after a change on the bus at `now`; the sensor's own pull is not yet in `sda`. */
void sensor_lines(sensor *s, uint64_t now, bool scl, bool sda);

/* Whether the sensor holds SDA low. */
bool sensor_pulls(const sensor *s);

#endif
