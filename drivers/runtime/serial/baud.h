/* Sets any baud rate on a serial line, also one for which termios has no name (250 k, 400 k, 2 M). */
#ifndef ETHD__SERIAL_BAUD_H
#define ETHD__SERIAL_BAUD_H

#include <stdint.h>

/* Sets both directions and reads back what the line then has. Returns its output rate, or -1 with errno if it
   isn't a terminal. The caller refuses a rate that is too far from the one it asked for. [main] */
int64_t ethd__baud_set(int fd, uint32_t baud);

#endif
