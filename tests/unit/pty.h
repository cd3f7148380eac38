/* A pty pair: what stands at the far end of a serial line in a test. */
#ifndef ETHD_TESTS_PTY_H
#define ETHD_TESTS_PTY_H

#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

/* The master, raw, without waiting; its slave's path, as a link at `link` (replaced) when that isn't NULL. */
static inline int pty_open(const char *link, char path[64]) {
  struct termios t;
  int fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (fd < 0 || grantpt(fd) || unlockpt(fd) || ptsname_r(fd, path, 64)) return -1;
  if (tcgetattr(fd, &t) == 0) cfmakeraw(&t), tcsetattr(fd, TCSANOW, &t);
  if (link) unlink(link);
  if (link && symlink(path, link)) return -1;
  return fd;
}

#endif
