#include "servo/bus.h"

#include <errno.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "servo/bus_parts.h"
#include "text/error_text.h"

#define DRAINS 10 /* draining gives up after this multiple of the quiet time */

static int64_t nanoseconds(double seconds) { return (int64_t)(1e9 * seconds); }

/* ---- opening ---- */

/* True for frames unknown to libmodbus, and for several units, because it ignores an answer's unit over tcp. */
static bool is_own(const ethd__servo_map *map) {
  return map->crc == ETHD__SERVO_CRC_HIGH_FIRST || map->local_echo || ethd__servo_several(map);
}

/* libmodbus frames and checks. Lines and connections are ours, so its own recoveries are switched off. */
static modbus_t *context(const ethd__servo_map *map, int fd) {
  modbus_t *m =
      map->transport == ETHD__SERVO_TCP ? modbus_new_tcp("127.0.0.1", 502) : modbus_new_rtu(map->port, 9600, 'N', 8, 1);
  uint32_t response = (uint32_t)(1e6 * map->response);
  if (!m) return NULL;
  modbus_set_error_recovery(m, MODBUS_ERROR_RECOVERY_NONE);
  modbus_set_response_timeout(m, response / 1000000, response % 1000000);
  modbus_set_byte_timeout(m, 0, 0); /* otherwise it would replace the response time-out */
  modbus_set_socket(m, fd);
  if (modbus_set_slave(m, (int)map->unit) == 0) return m;
  modbus_free(m);
  return NULL;
}

ethd_status ethd__servo_bus_open(const ethd__servo_map *map, ethd__servo_bus *bus, char message[ETHD_MESSAGE_MAX]) {
  *bus = (ethd__servo_bus){.map = map, .fd = -1};
  ethd_status status = ethd__servo_port_open(map, &bus->fd, &bus->at_once, message);
  if (status) return status;
  bus->quiet_ns = ethd__clock_now();
  if (is_own(map)) return ETHD_OK;
  bus->modbus = context(map, bus->fd);
  if (bus->modbus) return ETHD_OK;
  ethd__servo_bus_close(bus);
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: unit %u isn't allowed here", map->port, map->unit);
}

void ethd__servo_bus_close(ethd__servo_bus *bus) {
  if (bus->modbus) modbus_free(bus->modbus);
  bus->modbus = NULL;
  if (bus->fd >= 0) close(bus->fd);
  bus->fd = -1;
}

/* ---- one question ---- */

static ethd__servo_outcome outcome(int error) {
  switch (error) {
  case ETIMEDOUT:
  case EAGAIN:
  case EMBXGPATH:
  case EMBXGTAR: return ETHD__SERVO_MISSING;
  case EMBXILFUN:
  case EMBXILADD:
  case EMBXILVAL: return ETHD__SERVO_REFUSED;
  case EMBXSBUSY:
  case EMBXACK: return ETHD__SERVO_BUSY;
  case EMBXSFAIL:
  case EMBXMEMPAR: return ETHD__SERVO_FAILED;
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

static ethd__servo_outcome end(ethd__servo_bus *bus, int got, uint32_t count) {
  ethd__servo_outcome result = ETHD__SERVO_DONE;
  if (got != (int)count) {
    bus->error = got < 0 ? errno : EMBBADDATA;
    result = outcome(bus->error);
  }
  bus->quiet_ns = bus->map->silence > 0 ? ethd__clock_now() : 0;
  return result;
}

/* Asks in our framing and returns what libmodbus would: the number of words, or -1 with errno. */
static int ask(ethd__servo_bus *bus, ethd__servo_frame *f, uint32_t count, uint16_t *words) {
  ethd__servo_frame_number(bus->map, ++bus->number, f);
  errno = ethd__servo_ask(bus, f, words);
  return errno ? -1 : (int)count;
}

static int own_read(ethd__servo_bus *bus, ethd__servo_span from, uint16_t *words) {
  ethd__servo_frame f;
  ethd__servo_frame_read(bus->map, from, &f);
  return ask(bus, &f, from.count, words);
}

static int own_write(ethd__servo_bus *bus, ethd__servo_span to, const uint16_t *words) {
  ethd__servo_frame f;
  ethd__servo_frame_write(bus->map, to, words, &f);
  return ask(bus, &f, to.count, NULL);
}

static ethd__servo_outcome gone(ethd__servo_bus *bus) {
  bus->error = ENOTCONN;
  return ETHD__SERVO_LOST;
}

ethd__servo_outcome ethd__servo_bus_read(ethd__servo_bus *bus, ethd__servo_span from, uint16_t *words) {
  if (bus->fd < 0) return gone(bus);
  keep_silence(bus);
  int at = (int)from.address, count = (int)from.count;
  int got = !bus->modbus                      ? own_read(bus, from, words)
            : from.space == ETHD__SERVO_INPUT ? modbus_read_input_registers(bus->modbus, at, count, words)
                                              : modbus_read_registers(bus->modbus, at, count, words);
  return end(bus, got, from.count);
}

ethd__servo_outcome ethd__servo_bus_write(ethd__servo_bus *bus, ethd__servo_span to, const uint16_t *words) {
  if (bus->fd < 0) return gone(bus);
  keep_silence(bus);
  int got = bus->modbus ? modbus_write_registers(bus->modbus, (int)to.address, (int)to.count, words)
                        : own_write(bus, to, words);
  return end(bus, got, to.count);
}

ethd__servo_outcome ethd__servo_bus_both(ethd__servo_bus *bus, ethd__servo_span to, const uint16_t *out,
                                         ethd__servo_span from, uint16_t *in) {
  if (bus->fd < 0) return gone(bus);
  keep_silence(bus);
  int got;
  if (bus->modbus) {
    got = modbus_write_and_read_registers(bus->modbus, (int)to.address, (int)to.count, out, (int)from.address,
                                          (int)from.count, in);
  } else {
    ethd__servo_frame f;
    ethd__servo_frame_both(bus->map, to, out, from, &f);
    got = ask(bus, &f, from.count, in);
  }
  return end(bus, got, from.count);
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

/* strerror doesn't know libmodbus's own error numbers. */
const char *ethd__servo_bus_error(const ethd__servo_bus *bus) {
  return bus->error >= MODBUS_ENOBASE ? modbus_strerror(bus->error) : strerror(bus->error);
}
