/* The ring's serial port: opens it, waits for bytes and reads them, and reopens it after an unplug. */
#ifndef ETHD__PROXIMITY_RING_PORT_H
#define ETHD__PROXIMITY_RING_PORT_H

#include "proximity_ring/receiver.h"

typedef struct ethd__ring_port {
  char *path;
  uint32_t baud;
  int fd;             /* -1: not open */
  bool low_latency;   /* the kernel's driver delivers bytes at once */
  int64_t attempt_ns; /* time of the next attempt to open */
  int64_t back_off;   /* ns, doubled with each attempt up to 1.6 s */
  uint64_t opened;    /* how often it was opened */
  int64_t heard_ns;   /* time of the last read */
} ethd__ring_port;

/* Tries once to open it, now; the next attempt is due after the back-off. [main] or I/O */
ETHD_MUST_CHECK ethd_status ethd__ring_port_open(ethd__ring_port *port, int64_t now_ns, char message[ETHD_MESSAGE_MAX]);

/* Called before each read: returns whether the last read was long ago (ethd__clock_was_deaf), as between a device's
   open and its start. The waiting bytes are then dropped, and the caller starts again. I/O */
bool ethd__ring_port_was_deaf(ethd__ring_port *port, int64_t now_ns);

/* Reads the received bytes, at most `room`, and waits up to wait_ms for the first. -1: the line is gone and has
   been closed. */
int64_t ethd__ring_port_read(ethd__ring_port *port, int wait_ms, uint8_t *out, size_t room);

void ethd__ring_port_close(ethd__ring_port *port);

#endif
