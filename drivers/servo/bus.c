#include "servo/bus.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "servo/bus_parts.h"

#define DRAINS 10 /* draining gives up after this multiple of the quiet time */

static int64_t nanoseconds(double seconds) { return (int64_t)(1e9 * seconds); }

/* ---- opening ---- */

ethd_status ethd__servo_bus_open(const ethd__servo_map *map, ethd__servo_bus *bus, char message[ETHD_MESSAGE_MAX]) {
  *bus = (ethd__servo_bus){.map = map, .fd = -1};
  ethd_status status = ethd__servo_port_open(map, &bus->fd, &bus->at_once, message);
  bus->quiet_ns = ethd__clock_now();
  return status;
}

void ethd__servo_bus_close(ethd__servo_bus *bus) {
  if (bus->fd >= 0) close(bus->fd);
  bus->fd = -1;
}

/* ---- one question ---- */

/* The exceptions of the application protocol V1.1b3, section 7, by their codes. */
static const struct {
  ethd__servo_outcome outcome;
  const char *what;
} exceptions[] = {[1] = {ETHD__SERVO_REFUSED, "the drive doesn't know this function (exception 1)"},
                  [2] = {ETHD__SERVO_REFUSED, "the drive doesn't have this address (exception 2)"},
                  [3] = {ETHD__SERVO_REFUSED, "the drive doesn't take this value (exception 3)"},
                  [4] = {ETHD__SERVO_FAILED, "the drive failed (exception 4)"},
                  [5] = {ETHD__SERVO_BUSY, "the drive needs more time (exception 5)"},
                  [6] = {ETHD__SERVO_BUSY, "the drive is busy (exception 6)"},
                  [8] = {ETHD__SERVO_FAILED, "the drive's memory has a parity error (exception 8)"},
                  [10] = {ETHD__SERVO_MISSING, "the gateway has no path to the drive (exception 10)"},
                  [11] = {ETHD__SERVO_MISSING, "the drive behind the gateway doesn't answer (exception 11)"}};

/* The code of an exception with a meaning; 0: the error is another one. */
static int exception_of(int error) {
  const int code = error - ETHD__SERVO_EXCEPTION, count = (int)(sizeof exceptions / sizeof *exceptions);
  return code > 0 && code < count && exceptions[code].what ? code : 0;
}

static ethd__servo_outcome outcome(int error) {
  if (exception_of(error)) return exceptions[exception_of(error)].outcome;
  switch (error) {
  case 0: return ETHD__SERVO_DONE;
  case ETIMEDOUT:
  case EAGAIN: return ETHD__SERVO_MISSING;
  case EBADF:
  case EPIPE:
  case EIO:
  case ENXIO:
  case ENODEV:
  case ENOTCONN:
  case ECONNRESET:
  case ECONNREFUSED:
  case ECONNABORTED:
  case EHOSTUNREACH:
  case ENETUNREACH: return ETHD__SERVO_LOST;
  default: return ETHD__SERVO_GARBLED;
  }
}

/* Waits for the silence that ends the frame before on a serial line, and notes when the next one may go out. */
static void keep_silence(ethd__servo_bus *bus) {
  int64_t left = bus->quiet_ns + nanoseconds(bus->map->silence) - ethd__clock_now();
  struct timespec t = {left / 1000000000, left % 1000000000};
  if (left > 0) nanosleep(&t, NULL);
  bus->asked_ns = ethd__clock_now();
}

static ethd__servo_outcome gone(ethd__servo_bus *bus) {
  bus->error = ENOTCONN;
  return ETHD__SERVO_LOST;
}

static ethd__servo_outcome ask(ethd__servo_bus *bus, ethd__servo_frame *question, uint16_t *words) {
  if (bus->fd < 0) return gone(bus);
  keep_silence(bus);
  ethd__servo_frame_number(bus->map, ++bus->number, question);
  bus->error = ethd__servo_ask(bus, question, words);
  bus->quiet_ns = bus->map->silence > 0 ? ethd__clock_now() : 0;
  return outcome(bus->error);
}

ethd__servo_outcome ethd__servo_bus_read(ethd__servo_bus *bus, ethd__servo_span from, uint16_t *words) {
  ethd__servo_frame f;
  ethd__servo_frame_read(bus->map, from, &f);
  return ask(bus, &f, words);
}

ethd__servo_outcome ethd__servo_bus_write(ethd__servo_bus *bus, ethd__servo_span to, const uint16_t *words) {
  ethd__servo_frame f;
  ethd__servo_frame_write(bus->map, to, words, &f);
  return ask(bus, &f, NULL);
}

ethd__servo_outcome ethd__servo_bus_both(ethd__servo_bus *bus, ethd__servo_span to, const uint16_t *out,
                                         ethd__servo_span from, uint16_t *in) {
  ethd__servo_frame f;
  ethd__servo_frame_both(bus->map, to, out, from, &f);
  return ask(bus, &f, in);
}

/* ---- after an error ---- */

ethd__servo_outcome ethd__servo_bus_drain(ethd__servo_bus *bus) {
  unsigned char rest[512];
  int64_t quiet = nanoseconds(bus->map->drain), since = ethd__clock_now(), give_up = since + DRAINS * quiet;
  while (bus->fd >= 0) {
    int64_t at = ethd__clock_now(), left = since + quiet - at;
    struct pollfd wait = {bus->fd, POLLIN, 0};
    struct timespec t = {left / 1000000000, left % 1000000000};
    if (left <= 0) return ETHD__SERVO_DONE;
    if (at > give_up) return ETHD__SERVO_MISSING;
    int ready = ppoll(&wait, 1, &t, NULL);
    if (ready < 0 && errno != EINTR) break;
    if (ready < 1) continue;
    ssize_t n = read(bus->fd, rest, sizeof rest);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) break;
    if (n > 0) since = ethd__clock_now();
    /* a line that hung up stays readable for ever and gives no bytes */
    else if (wait.revents & (POLLHUP | POLLERR))
      break;
  }
  return gone(bus);
}

const char *ethd__servo_bus_error(const ethd__servo_bus *bus) {
  if (bus->error == ETHD__SERVO_BAD_CRC) return "an answer's checksum is wrong";
  if (bus->error == ETHD__SERVO_BAD_ANSWER) return "what came is no answer to the question";
  if (bus->error > ETHD__SERVO_EXCEPTION)
    return exception_of(bus->error) ? exceptions[exception_of(bus->error)].what : "an exception without a meaning";
  return strerror(bus->error);
}
