/* The serial port of the ring, or of another sensor that sends its frames: opens it, waits for bytes and reads them, and
   reopens it after an unplug. */
#ifndef ETHD__PROXIMITY_RING_PORT_H
#define ETHD__PROXIMITY_RING_PORT_H

#include <pthread.h>

#include "proximity_ring/decoder.h"

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

/* Opens the port and listens to its first frames, which show that the line is right: `each` gets them until `frames` are
   there. Fails after `patience`, s. [main] */
ETHD_MUST_CHECK ethd_status ethd__ring_port_listen(ethd__ring_port *port, double patience, uint32_t frames,
                                                   void (*each)(void *self, const ethd__ring_frame *frame), void *self,
                                                   char message[ETHD_MESSAGE_MAX]);

/* A driver whose I/O thread listens to a port. */
typedef struct ethd__ring_listener {
  void *self;
  pthread_mutex_t *lock; /* held during the calls */
  bool is_virtual;       /* nothing waits, and all bytes count as arrived at this instant */
  void (*take)(void *self, const uint8_t *bytes, size_t count, int64_t arrival_ns);
  /* Earlier bytes are lost: the port was opened anew, or nobody listened for long (ethd__clock_was_deaf), as between a
     device's open and its start. */
  void (*restart)(void *self);
} ethd__ring_listener;

/* Opens the port if it is due, else hands what has come to the driver, and waits a while for it. I/O */
ethd_status ethd__ring_port_service(ethd__ring_port *port, const ethd__ring_listener *to, int64_t now_ns);

/* Reads the received bytes, at most `room`, and waits up to wait_ms for the first. -1: the line is gone and has
   been closed. */
int64_t ethd__ring_port_read(ethd__ring_port *port, int wait_ms, uint8_t *out, size_t room);

void ethd__ring_port_close(ethd__ring_port *port);

#endif
