/* A serial line: raw, at any baud rate, for this program alone. A pty works too. */
#ifndef ETHD__SERIAL_LINE_H
#define ETHD__SERIAL_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/driver.h"

typedef enum ethd__line_format { ETHD__LINE_8N1 = 0, ETHD__LINE_8E1, ETHD__LINE_8O1, ETHD__LINE_8N2 } ethd__line_format;

#define ETHD__LINE_RATE_SHARE 50 /* a line's rate may be off by this part of it, 2 %: both ends together may by 4 % */

/* Opens without waiting for a carrier, and never blocks in read or write. Refuses a line that another program
   holds, what isn't a terminal, and a rate that the line doesn't then have: set through BOTHER, read back. An adapter
   divides its own clock, and some say what comes of it: 115384 for 115200. What was in the buffers is dropped. On
   failure *fd is -1. [main], or an I/O thread. */
ETHD_MUST_CHECK ethd_status ethd__line_open(const char *path, ethd__line_format format, uint32_t baud, int *fd,
                                            char message[ETHD_MESSAGE_MAX]);

/* Lets the kernel's driver switch an RS-485 transceiver's direction by RTS, which is high, or else low, while it sends.
   Returns false if it can't, and errno says why; most adapters switch by themselves. */
bool ethd__line_rs485(int fd, bool high);

/* Asks the kernel's driver to hand bytes over at once; returns false if it can't do so. */
bool ethd__line_low_latency(int fd);

#endif
