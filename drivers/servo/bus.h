/* Questions and answers on a Modbus, one at a time: by libmodbus, or in our own framing if libmodbus doesn't support
   the map's. Called by [main] or by one I/O thread. */
#ifndef ETHD__SERVO_BUS_H
#define ETHD__SERVO_BUS_H

#include "servo/map.h"

typedef enum ethd__servo_outcome {
  ETHD__SERVO_DONE,
  ETHD__SERVO_MISSING, /* no answer in time */
  ETHD__SERVO_GARBLED, /* the received bytes are no answer to this question: checksum, length, number */
  ETHD__SERVO_BUSY,    /* the drive asks for the question again, later */
  ETHD__SERVO_REFUSED, /* the drive knows no such function, address or value: the map is wrong */
  ETHD__SERVO_FAILED,  /* the drive says that it failed */
  ETHD__SERVO_LOST     /* the line or connection is gone */
} ethd__servo_outcome;

typedef struct ethd__servo_bus {
  const ethd__servo_map *map;
  void *modbus;     /* NULL where our own framing is used */
  int fd;           /* -1: closed */
  uint16_t number;  /* of the last question in our own framing; tcp has it in the answer */
  bool at_once;     /* the line delivers each byte at once; true of every tcp connection */
  int error;        /* errno of the last failure, libmodbus's included */
  int64_t quiet_ns; /* CLOCK_MONOTONIC: end of the last use of the line */
  int64_t asked_ns; /* CLOCK_MONOTONIC: just before the last question went out */
} ethd__servo_bus;

/* Opens map->port. Serial: any baud, read back. Blocks for map->connect at most. The message
   names the port. */
ETHD_MUST_CHECK ethd_status ethd__servo_bus_open(const ethd__servo_map *map, ethd__servo_bus *bus,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Closes the line; does nothing when it is closed. */
void ethd__servo_bus_close(ethd__servo_bus *bus);

/* Each sends one question. After any outcome but DONE and BUSY the caller drains before it sends again. */
ethd__servo_outcome ethd__servo_bus_read(ethd__servo_bus *bus, ethd__servo_span from, uint16_t *words);
ethd__servo_outcome ethd__servo_bus_write(ethd__servo_bus *bus, ethd__servo_span to, const uint16_t *words);
ethd__servo_outcome ethd__servo_bus_both(ethd__servo_bus *bus, ethd__servo_span to, const uint16_t *out,
                                         ethd__servo_span from, uint16_t *in);

/* Discards received bytes until none has come for map->drain, so that a late answer is never mistaken for the next one.
   MISSING if the line isn't quiet within ten times that; LOST if it is gone. */
ethd__servo_outcome ethd__servo_bus_drain(ethd__servo_bus *bus);

/* The last failure as a sentence for people. */
const char *ethd__servo_bus_error(const ethd__servo_bus *bus);

/* Connects map->port, sets it up, and returns its descriptor; libmodbus would replace an unknown baud by 9600. */
ETHD_MUST_CHECK ethd_status ethd__servo_port_open(const ethd__servo_map *map, int *fd, bool *at_once,
                                                  char message[ETHD_MESSAGE_MAX]);

#endif
