/* The shared part of the drivers of sensors on the proximity ring's line. They receive the same frames
   (proximity_ring/frame.h) with the same CRC, sequence and clock; only the meaning of the 16 counts differs. */
#ifndef ETHD__FINGER_BUS_H
#define ETHD__FINGER_BUS_H

#include "finger/inbox.h"
#include "proximity_ring/board_clock.h"
#include "proximity_ring/port.h"

/* The common settings of such drivers come first in their tables. */
enum { ETHD__BUS_BAUD, ETHD__BUS_DELAY, ETHD__BUS_PATIENCE, ETHD__BUS_PARAMS };
#define ETHD__BUS_ROWS                                                                                          \
  [ETHD__BUS_BAUD] = {"baud", "1/s", 9600, 12e6, 500000, "baud rate of the line"},                              \
  [ETHD__BUS_DELAY] = {"delay", "s",    0,                                                                      \
                       0.1,     0.0012, "time from a frame's sample to the earliest arrival of its last byte"}, \
  [ETHD__BUS_PATIENCE] = {"patience", "s", 0.05, 60, 2, "longest wait for the first frames"}

/* Turns a frame's counts into a reading, which is centre and noise. False: no finger gives such counts. [I/O] */
typedef bool ethd__bus_means(const void *sensor, const uint16_t counts[ETHD__FRAME_SENSORS], ethd__sighting *out);

typedef struct ethd__finger_bus {
  ethd__bus_means *means;
  const void *sensor;
  bool is_virtual; /* whether the clock is virtual */
  double patience; /* s to wait for the first frames */
  ethd__ring_port port;
  ethd__decoder decoder;
  ethd__board_clock clock;
  ethd__inbox inbox;
} ethd__finger_bus;

/* Prepares everything but the port, whose path `port` is relative to def->folder. `bus` is zero except for `means` and
   `sensor`; the caller closes it, also after a failure. p: the driver's settings. [main] */
ETHD_MUST_CHECK ethd_status ethd__finger_bus_prepare(ethd__finger_bus *bus, const ethd_device_def *def,
                                                     const char *port, const double *p, char message[ETHD_MESSAGE_MAX]);

/* Opens the port of a prepared bus and waits for its first frames. [main] */
ETHD_MUST_CHECK ethd_status ethd__finger_bus_open(ethd__finger_bus *bus, char message[ETHD_MESSAGE_MAX]);

/* Members of such drivers' tables, whose devices are allocated and begin with the bus. close frees the device; the
   limits bound the finger's readings only, since the bus takes no samples of the joints. */
ethd_status ethd__finger_bus_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT;
uint32_t ethd__finger_bus_units(const void *device);
ethd_status ethd__finger_bus_service(void *device, uint32_t unit, int64_t now_ns);
void ethd__finger_bus_close(void *device);
ethd_limits ethd__finger_bus_limits(const void *device);
uint32_t ethd__finger_bus_figures(const void *device, ethd_figure *out, uint32_t max);

#endif
