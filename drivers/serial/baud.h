/* Any baud rate on a serial line, also one without a name of its own (250 k, 400 k, 2 M). */
#ifndef ETHD_COMMON_BAUD_H
#define ETHD_COMMON_BAUD_H

#include <stdint.h>

/* Sets both directions and reads back what the line then has: its output rate, or -1 with errno when it
   isn't a terminal. The caller refuses what differs from what it asked for. [main] */
int64_t ethd__baud_set(int fd, uint32_t baud);

#endif
