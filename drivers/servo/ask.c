/* Asks in our own framing over the bus's line. As in libmodbus, one deadline covers the whole answer. */
#include <errno.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "servo/bus_parts.h"

/* Waits until the line is ready; returns 0 or an errno. */
static int await(int fd, short events, int64_t until) {
  for (;;) {
    int64_t left = until - ethd__clock_now();
    struct timespec t = {left / 1000000000, left % 1000000000};
    struct pollfd wait = {fd, events, 0};
    if (left <= 0) return ETIMEDOUT;
    int ready = ppoll(&wait, 1, &t, NULL);
    if (ready > 0) return wait.revents & (POLLHUP | POLLERR | POLLNVAL) ? EIO : 0;
    if (ready < 0 && errno != EINTR) return errno;
  }
}

static bool is_socket(const ethd__servo_bus *bus) { return bus->map->transport == ETHD__SERVO_TCP; }

/* A connection that was reset raises no signal. */
static int send_all(const ethd__servo_bus *bus, const uint8_t *bytes, int length, int64_t until) {
  for (int sent = 0; sent < length;) {
    const size_t left = (size_t)(length - sent);
    ssize_t n = is_socket(bus) ? send(bus->fd, bytes + sent, left, MSG_NOSIGNAL) : write(bus->fd, bytes + sent, left);
    if (n > 0) sent += (int)n;
    if (n < 0 && errno != EAGAIN && errno != EINTR) return errno;
    int failure = n > 0 ? 0 : await(bus->fd, POLLOUT, until);
    if (failure) return failure;
  }
  return 0;
}

/* Reads until `*got` bytes have become `length`; returns 0 or an errno. A connection that gives no byte has ended. */
static int receive(const ethd__servo_bus *bus, uint8_t *bytes, int *got, int length, int64_t until) {
  while (*got < length) {
    ssize_t n = read(bus->fd, bytes + *got, (size_t)(length - *got));
    if (n > 0) *got += (int)n;
    if (n == 0 && is_socket(bus)) return ECONNRESET;
    if (n < 0 && errno != EAGAIN && errno != EINTR) return errno;
    int failure = n > 0 ? 0 : await(bus->fd, POLLIN, until);
    if (failure) return failure;
  }
  return 0;
}

/* On two wires the receiver hears the transmitter: the first received bytes must be the sent ones. */
static int hear_itself(const ethd__servo_bus *bus, const ethd__servo_frame *f, int64_t until) {
  uint8_t back[ETHD__SERVO_FRAME_MAX];
  int got = 0, failure = receive(bus, back, &got, f->length, until);
  if (failure) return failure;
  return memcmp(back, f->bytes, (size_t)f->length) == 0 ? 0 : EMBBADDATA;
}

int ethd__servo_ask(const ethd__servo_bus *bus, const ethd__servo_frame *f, uint16_t *words) {
  uint8_t answer[ETHD__SERVO_FRAME_MAX];
  int64_t until = ethd__clock_now() + (int64_t)(1e9 * bus->map->response);
  int got = 0, whole = 0;
  int failure = send_all(bus, f->bytes, f->length, until);
  if (!failure && bus->map->local_echo) failure = hear_itself(bus, f, until);
  while (!failure && !(whole && got == whole)) {
    failure = receive(bus, answer, &got, whole ? whole : got + 1, until);
    if (!failure && !ethd__servo_frame_begins(bus->map, f, answer, got)) failure = EMBBADDATA;
    if (!failure && !whole) whole = ethd__servo_frame_whole(bus->map, f, answer, got);
  }
  return failure ? failure : ethd__servo_frame_take(bus->map, f, answer, got, words);
}
