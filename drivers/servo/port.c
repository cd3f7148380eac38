/* Sockets and serial lines, opened by ourselves: libmodbus takes an unknown baud for 9600 without a word. */
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "common/baud.h"
#include "file/error_text.h"
#include "servo/bus.h"

static ethd_status refuse(const ethd__servo_map *map, int error, char *message) {
  return ethd__say(message, ETHD_E_DEVICE, "%s: %s", map->port, strerror(error));
}

/* ---- tcp ---- */

/* In time, or -1 with errno. */
static int connect_to(const struct addrinfo *to, double seconds) {
  int fd = socket(to->ai_family, to->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, to->ai_protocol);
  int error = 0, one = 1;
  socklen_t size = sizeof error;
  if (fd < 0) return -1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
  if (connect(fd, to->ai_addr, to->ai_addrlen)) {
    struct pollfd wait = {fd, POLLOUT, 0};
    if (errno != EINPROGRESS) error = errno;
    else if (poll(&wait, 1, (int)(1e3 * seconds) + 1) < 1) error = ETIMEDOUT;
    else if (getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size)) error = errno;
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

static int set_line(int fd, int32_t format) {
  struct termios t;
  if (tcgetattr(fd, &t)) return -1;
  cfmakeraw(&t);
  t.c_cflag &= ~(tcflag_t)(PARENB | PARODD | CSTOPB | CRTSCTS);
  t.c_cflag |= CLOCAL | CREAD;
  if (format == 1 || format == 2) t.c_cflag |= PARENB;
  if (format == 2) t.c_cflag |= PARODD;
  if (format == 3) t.c_cflag |= CSTOPB;
  t.c_cc[VMIN] = t.c_cc[VTIME] = 0;
  return tcsetattr(fd, TCSANOW, &t);
}

static ethd_status open_rtu(const ethd__servo_map *map, int *fd, char *message) {
  *fd = open(map->port, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (*fd < 0) return refuse(map, errno, message);
  if (ioctl(*fd, TIOCEXCL) || set_line(*fd, map->format)) return refuse(map, errno, message);
  int64_t baud = ethd__baud_set(*fd, (uint32_t)map->baud);
  if (baud != (int64_t)map->baud)
    return ethd__say(message, ETHD_E_DEVICE, "%s: asked for %.0f baud, the line has %lld; choose a rate that it can",
                     map->port, map->baud, (long long)baud);
  tcflush(*fd, TCIOFLUSH);
  return ETHD_OK;
}

/* libmodbus waits in select, which can't hold a higher descriptor and ends the process. */
static ethd_status check_number(const ethd__servo_map *map, int fd, char *message) {
  if (fd < FD_SETSIZE) return ETHD_OK;
  return ethd__say(message, ETHD_E_DEVICE, "%s: got descriptor %d, under %d is needed: open the bus before other files",
                   map->port, fd, FD_SETSIZE);
}

ethd_status ethd__servo_port_open(const ethd__servo_map *map, int *fd, char message[ETHD_MESSAGE_MAX]) {
  *fd = -1;
  ethd_status status = map->transport == ETHD__SERVO_TCP ? open_tcp(map, fd, message) : open_rtu(map, fd, message);
  if (!status) status = check_number(map, *fd, message);
  if (status && *fd >= 0) close(*fd);
  if (status) *fd = -1;
  return status;
}
