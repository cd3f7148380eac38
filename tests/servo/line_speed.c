#include "servo/line_speed.h"

#include <asm/ioctls.h>
#include <asm/termbits.h>

int ioctl(int fd, unsigned long request, ...);

unsigned line_speed(int fd) {
  struct termios2 t;
  return ioctl(fd, TCGETS2, &t) ? 0 : t.c_ospeed;
}
