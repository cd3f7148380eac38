/* A serial line of a given speed between two pseudo terminals: what is written to one arrives at the other when its
   last bit has passed. wire BAUD says "A B", the two names, and ends with its stdin. */
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#include "clock.h"

#define BITS 10     /* of a byte, 8N1 */
#define SPIN 120000 /* ns: a sleep's own lateness, waited out awake */

static int open_terminal(char *name, size_t room) {
  struct termios t;
  int fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (fd < 0 || grantpt(fd) || unlockpt(fd) || ptsname_r(fd, name, room)) exit(1);
  int slave = open(name, O_RDWR | O_NOCTTY); /* stays: the terminal lives between openings */
  tcgetattr(slave, &t);
  cfmakeraw(&t);
  tcsetattr(slave, TCSANOW, &t);
  return fd;
}

/* What is under way in one direction. */
typedef struct lane {
  uint8_t bytes[4096];
  ssize_t count;
  int64_t due; /* when its last bit has passed */
} lane;

int main(int argc, char **argv) {
  char name[2][64];
  int fd[2];
  static lane lanes[2];
  double baud = argc == 2 ? atof(argv[1]) : 0;
  if (!(baud > 0)) return 2;
  for (int i = 0; i < 2; i++) fd[i] = open_terminal(name[i], sizeof name[i]);
  printf("%s %s\n", name[0], name[1]);
  fflush(stdout);
  for (;;) {
    struct pollfd wait[3] = {{fd[0], POLLIN, 0}, {fd[1], POLLIN, 0}, {0, POLLIN, 0}};
    int64_t left = INT64_MAX, t;
    for (int i = 0; i < 2; i++)
      if (lanes[i].count) {
        wait[i].fd = -1;
        t = lanes[i].due - ethd__clock_now() - SPIN;
        if (t < left) left = t;
      }
    struct timespec most = {left > 0 ? left / 1000000000 : 0, left > 0 ? left % 1000000000 : 0};
    if (ppoll(wait, 3, left == INT64_MAX ? NULL : &most, NULL) < 0 && errno != EINTR) return 1;
    if (wait[2].revents && read(0, &(char){0}, 1) <= 0) return 0;
    for (int i = 0; i < 2; i++) {
      lane *l = &lanes[i];
      if (!l->count && wait[i].revents & POLLIN) {
        l->count = read(fd[i], l->bytes, sizeof l->bytes);
        if (l->count < 0) l->count = 0;
        int64_t begin = ethd__clock_now() > l->due ? ethd__clock_now() : l->due;
        l->due = begin + (int64_t)((double)l->count * BITS * 1e9 / baud);
      } else if (l->count && ethd__clock_now() >= l->due) {
        if (write(fd[!i], l->bytes, (size_t)l->count) < 0 && errno != EAGAIN) return 1;
        l->count = 0;
      }
    }
  }
}
