/* A file of its own, because the kernel's termios and the C library's can't be included together. */
#include "serial/baud.h"

#include <asm/ioctls.h>
#include <asm/termbits.h>

int ioctl(int fd, unsigned long request, ...);

int64_t ethd__baud_set(int fd, uint32_t baud) {
  struct termios2 t;
  if (ioctl(fd, TCGETS2, &t)) return -1;
  t.c_cflag &= ~(tcflag_t)(CBAUD | CIBAUD);
  t.c_cflag |= BOTHER | BOTHER << IBSHIFT;
  t.c_ispeed = t.c_ospeed = baud;
  if (ioctl(fd, TCSETS2, &t) || ioctl(fd, TCGETS2, &t)) return -1;
  return t.c_ispeed == t.c_ospeed ? (int64_t)t.c_ospeed : 0;
}
