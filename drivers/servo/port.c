/* Opens sockets and serial lines ourselves, because libmodbus silently takes an unknown baud for 9600. */
#include <errno.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <string.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>

#include "serial/line.h"
#include "servo/bus.h"
#include "text/error_text.h"

static ethd_status refuse(const ethd__servo_map *map, int error, char *message) {
  return ethd__say(message, ETHD_E_DEVICE, "%s: %s", map->port, strerror(error));
}

/* ---- tcp ---- */

/* Returns a descriptor that is connected in time, or -1 with errno. */
static int connect_to(const struct addrinfo *to, double seconds) {
  int fd = socket(to->ai_family, to->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, to->ai_protocol);
  int error = 0, one = 1;
  socklen_t size = sizeof error;
  if (fd < 0) return -1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
  if (connect(fd, to->ai_addr, to->ai_addrlen)) {
    struct pollfd wait = {fd, POLLOUT, 0};
    if (errno != EINPROGRESS)
      error = errno;
    else if (poll(&wait, 1, (int)(1e3 * seconds) + 1) < 1)
      error = ETIMEDOUT;
    else if (getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size))
      error = errno;
  }
  if (!error) return fd;
  close(fd);
  errno = error;
  return -1;
}

static ethd_status open_tcp(const ethd__servo_map *map, int *fd, char *message) {
  char host[ETHD__SERVO_PORT_MAX];
  const struct addrinfo hints = {.ai_socktype = SOCK_STREAM};
  struct addrinfo *found;
  strcpy(host, map->port);
  char *colon = strrchr(host, ':');
  if (!colon || colon == host || !colon[1])
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: HOST:PORT is allowed", map->port);
  *colon = 0;
  int failure = getaddrinfo(host, colon + 1, &hints, &found);
  if (failure) return ethd__say(message, ETHD_E_DEVICE, "%s: %s", map->port, gai_strerror(failure));
  for (const struct addrinfo *a = found; a && *fd < 0; a = a->ai_next) *fd = connect_to(a, map->connect);
  int error = errno;
  freeaddrinfo(found);
  return *fd < 0 ? refuse(map, error, message) : ETHD_OK;
}

/* ---- rtu ---- */

/* The map and the line number their formats alike. */
static ethd_status open_rtu(const ethd__servo_map *map, int *fd, char *message) {
  ethd_status status = ethd__line_open(map->port, (ethd__line_format)map->format, map->baud, fd, message);
  if (status || !map->rs485 || ethd__line_rs485(*fd, map->rs485 == 1)) return status;
  return ethd__say(message, ETHD_E_DEVICE,
                   "%s: RTS can't switch its direction (%s): use an adapter that switches it, and rs485 = adapter",
                   map->port, strerror(errno));
}

/* libmodbus waits in select, which ends the process when a descriptor is FD_SETSIZE or higher. */
static ethd_status check_number(const ethd__servo_map *map, int fd, char *message) {
  if (fd < FD_SETSIZE) return ETHD_OK;
  return ethd__say(message, ETHD_E_DEVICE, "%s: got descriptor %d, under %d is needed: open the bus before other files",
                   map->port, fd, FD_SETSIZE);
}

ethd_status ethd__servo_port_open(const ethd__servo_map *map, int *fd, bool *at_once, char message[ETHD_MESSAGE_MAX]) {
  *fd = -1;
  ethd_status status = map->transport == ETHD__SERVO_TCP ? open_tcp(map, fd, message) : open_rtu(map, fd, message);
  if (!status) status = check_number(map, *fd, message);
  if (status && *fd >= 0) close(*fd);
  if (status) *fd = -1;
  *at_once = map->transport == ETHD__SERVO_TCP || (*fd >= 0 && ethd__line_low_latency(*fd));
  return status;
}
