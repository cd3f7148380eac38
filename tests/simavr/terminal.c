#include "terminal.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <asm/termbits.h>
#include <sys/ioctl.h>

enum { PATIENCE_MS = 30000 };

static uint8_t random_byte(terminal *t) { /* never 0 */
  t->random ^= t->random << 13, t->random ^= t->random >> 17, t->random ^= t->random << 5;
  return (uint8_t)(t->random % 255 + 1);
}

/* Raw, so that nothing is echoed to the board or translated before the host has opened it. */
static bool make_raw(int fd) {
  struct termios2 mode;
  if (ioctl(fd, TCGETS2, &mode)) return false;
  mode.c_iflag = mode.c_oflag = mode.c_lflag = 0;
  return !ioctl(fd, TCSETS2, &mode);
}

bool terminal_plug(terminal *t) {
  if (t->master >= 0) return true;
  t->filled = 0;
  t->master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  bool made = t->master >= 0 && !grantpt(t->master) && !unlockpt(t->master) &&
              !ptsname_r(t->master, t->name, sizeof t->name) &&
              (t->slave = open(t->name, O_RDWR | O_NOCTTY | O_CLOEXEC)) >= 0 && make_raw(t->slave);
  if (made && t->alias) {
    unlink(t->alias);
    made = !symlink(t->name, t->alias);
  }
  if (!made) fprintf(stderr, "ring_board: no pseudo-terminal: %s\n", strerror(errno));
  return made;
}

void terminal_unplug(terminal *t) {
  if (t->master < 0) return;
  close(t->slave);
  close(t->master);
  t->master = t->slave = -1;
  if (t->alias) unlink(t->alias);
}

static bool wrong_speed(const terminal *t) {
  struct termios2 mode;
  return t->baud_matters && !ioctl(t->slave, TCGETS2, &mode) && mode.c_ospeed != (unsigned)t->baud;
}

static void put(terminal *t, uint8_t byte) {
  if (t->filled < (int)sizeof t->buffer) t->buffer[t->filled++] = byte;
}

void terminal_byte(void *context, uint8_t byte) {
  terminal *t = context;
  t->sent++;
  if (t->lose) {
    t->lose--;
    return;
  }
  if (t->corrupt) {
    t->corrupt--;
    byte ^= random_byte(t);
  }
  put(t, byte);
}

/* Nobody reads: what a serial port would have lost too. */
static bool make_room(terminal *t) {
  struct pollfd reader = {.fd = t->master, .events = POLLOUT};
  if (t->patient && poll(&reader, 1, PATIENCE_MS) == 1) return true;
  int waiting = 0;
  ioctl(t->slave, FIONREAD, &waiting);
  t->lost += (uint64_t)waiting;
  ioctl(t->slave, TCFLSH, TCIFLUSH);
  return false;
}

void terminal_flush(terminal *t) {
  int done = 0;
  bool garbled = t->master >= 0 && wrong_speed(t);
  for (int n = 0; garbled && n < t->filled; n++) t->buffer[n] = random_byte(t);
  for (int turns = 0; t->master >= 0 && done < t->filled && turns < 1000; turns++) {
    ssize_t wrote = write(t->master, t->buffer + done, (size_t)(t->filled - done));
    if (wrote > 0)
      done += (int)wrote;
    else if (wrote < 0 && errno == EAGAIN && !make_room(t))
      break;
  }
  t->lost += (uint64_t)(t->filled - done);
  t->filled = 0;
}
