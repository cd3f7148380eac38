/* Messages of both sides of the teleoperation, and their sockets: teleop.c is the ring's side, robot.c the remote one. */
#ifndef ETHD__APPS_EXAMPLES_TELEOP_H
#define ETHD__APPS_EXAMPLES_TELEOP_H

#include <arpa/inet.h>
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define VERSION 0x65746801u /* of what follows, first in each datagram */
#define LINK_DEAD 0.25      /* s without a word */
#define TELEOP_WAIT 10      /* s that one side waits for the other to be started */
#define LINE 64             /* datagrams under way, or read at a time */
#define TELEOP_GAP 1000     /* words that can be lost in a row */

typedef struct word { /* a message, with numbers in this machine's format */
  uint32_t version, number;
  double pose[3], shape; /* m, m, rad: of the robot's surface, or of the ring; 0 a plane, 1 a ball */
} word;

typedef struct ear {
  word last;          /* the latest message; its number grows from message to message */
  int nonsense, late; /* dropped datagrams: damaged ones; ones after a later message */
} ear;

static inline double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline int fail(const char *what, const char *why) { return fprintf(stderr, "%s: %s\n", what, why), 1; }

/* Reads an argument from min to max; returns 0 if it is none. */
static inline int number(const char *text, double min, double max, double *out) {
  char *end;
  locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0), own = uselocale(c); /* a program's own may have a comma */
  *out = strtod(text, &end);
  uselocale(own), freelocale(c);
  return end != text && !*end && *out >= min && *out <= max;
}

/* Returns whether a datagram is a valid message. Every comparison with NaN is false. */
static inline int is_word(const word *w, ssize_t size) {
  return size == sizeof *w && w->version == VERSION && fabs(w->pose[0]) < 1 && fabs(w->pose[1]) < 1 &&
         fabs(w->pose[2]) < 4 && (w->shape == 0 || w->shape == 1);
}

/* Receives what has come; returns 1 if there is a later message. */
static inline int hear(int fd, ear *e) {
  word w;
  ssize_t size;
  int news = 0;
  for (int i = 0; i < LINE && (size = recv(fd, &w, sizeof w, MSG_DONTWAIT | MSG_TRUNC)) >= 0; i++) {
    int32_t ahead = is_word(&w, size) ? (int32_t)(w.number - e->last.number) : INT32_MAX;
    if (ahead > TELEOP_GAP || ahead < -TELEOP_GAP)
      e->nonsense++;
    else if (ahead <= 0)
      e->late++;
    else
      e->last = w, news = 1;
  }
  return news;
}

/* Returns a socket that is bound to the port, or connected to it, on this machine alone; negative: errno says why. */
static inline int line_open(double port, int (*join)(int, const struct sockaddr *, socklen_t)) {
  struct sockaddr_in here = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  int fd = socket(AF_INET, SOCK_DGRAM, 0);
  here.sin_port = htons((uint16_t)port);
  return fd < 0 || join(fd, (struct sockaddr *)&here, sizeof here) ? -1 : fd;
}

#endif
