/* Questions and answers on a Modbus, one at a time: through libmodbus, or in our own framing what that doesn't speak.
   All [main] or one I/O thread. */
#ifndef ETHD_SERVO_BUS_H
#define ETHD_SERVO_BUS_H

#include "servo/map.h"

typedef enum ethd__servo_outcome {
  ETHD__SERVO_DONE,
  ETHD__SERVO_MISSING, /* no answer in time */
  ETHD__SERVO_GARBLED, /* an answer that isn't one: checksum, length, of another question */
  ETHD__SERVO_BUSY,    /* the drive asks to come again */
  ETHD__SERVO_REFUSED, /* the drive knows no such function, address or value: the map is wrong */
  ETHD__SERVO_FAILED,  /* the drive says that it failed */
  ETHD__SERVO_LOST     /* the line or connection is gone */
} ethd__servo_outcome;

typedef struct ethd__servo_bus {
  const ethd__servo_map *map;
  void *modbus;     /* NULL: our own framing */
  int fd;           /* -1: closed */
  bool at_once;     /* the serial line hands bytes over at once; of tcp too */
  int error;        /* errno of the last failure, libmodbus's included */
  int64_t quiet_ns; /* CLOCK_MONOTONIC: when the line was left */
} ethd__servo_bus;

/* Opens map->port. Serial: the map's baud, whatever it is, read back. Blocks for map->connect at most. The message
   names the port. */
ETHD_MUST_CHECK ethd_status ethd__servo_bus_open(const ethd__servo_map *map, ethd__servo_bus *bus,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Closes; once more does nothing. */
void ethd__servo_bus_close(ethd__servo_bus *bus);

/* One question each. After any outcome but DONE and BUSY nothing may be sent before a drain. */
ethd__servo_outcome ethd__servo_bus_read(ethd__servo_bus *bus, int32_t space, uint32_t address, uint32_t count,
                                         uint16_t *words);
ethd__servo_outcome ethd__servo_bus_write(ethd__servo_bus *bus, uint32_t address, uint32_t count,
                                          const uint16_t *words);
ethd__servo_outcome ethd__servo_bus_both(ethd__servo_bus *bus, uint32_t to, uint32_t written, const uint16_t *out,
                                         uint32_t from, uint32_t count, uint16_t *in);

/* Throws away what comes until nothing came for map->drain: a late answer is never taken for the next one.
   MISSING: it didn't become quiet within ten times that; LOST: it is gone. */
ethd__servo_outcome ethd__servo_bus_drain(ethd__servo_bus *bus);

/* The last failure, for people. */
const char *ethd__servo_bus_error(const ethd__servo_bus *bus);

/* The descriptor of map->port, connected and set up; libmodbus would take an unknown baud for 9600. */
ETHD_MUST_CHECK ethd_status ethd__servo_port_open(const ethd__servo_map *map, int *fd, bool *at_once,
                                                  char message[ETHD_MESSAGE_MAX]);

#endif
