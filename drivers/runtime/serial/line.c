#include "serial/line.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include "serial/baud.h"
#include "text/error_text.h"

static int set_raw(int fd, ethd__line_format format) {
  struct termios t;
  if (tcgetattr(fd, &t)) return -1;
  cfmakeraw(&t);
  t.c_cflag &= ~(tcflag_t)(PARENB | PARODD | CSTOPB | CRTSCTS);
  t.c_cflag |= CLOCAL | CREAD;
  if (format == ETHD__LINE_8E1 || format == ETHD__LINE_8O1) t.c_cflag |= PARENB;
  if (format == ETHD__LINE_8O1) t.c_cflag |= PARODD;
  if (format == ETHD__LINE_8N2) t.c_cflag |= CSTOPB;
  t.c_cc[VMIN] = t.c_cc[VTIME] = 0;
  return tcsetattr(fd, TCSANOW, &t);
}

/* Linux gives these major numbers to pseudo-terminals. */
static bool is_pseudo(int fd) {
  struct stat s;
  return fstat(fd, &s) == 0 && major(s.st_rdev) >= 136 && major(s.st_rdev) <= 143;
}

/* The lock keeps out those whom TIOCEXCL doesn't: the administrator's programs, those that came before. A
   pseudo-terminal has the lock alone, since it would stay exclusive after this program's end, for as long as its
   other side is open. */
static ethd_status hold(int fd, const char *path, char *message) {
  if (!isatty(fd)) return ethd__say(message, ETHD_E_DEVICE, "%s: isn't a serial line", path);
  if (flock(fd, LOCK_EX | LOCK_NB) == 0 && (is_pseudo(fd) || ioctl(fd, TIOCEXCL) == 0)) return ETHD_OK;
  return ethd__say(message, ETHD_E_DEVICE, "%s: another program uses it (%s)", path, strerror(errno));
}

static ethd_status set(int fd, const char *path, ethd__line_format format, uint32_t baud, char *message) {
  if (set_raw(fd, format)) return ethd__say(message, ETHD_E_DEVICE, "%s: %s", path, strerror(errno));
  int64_t has = ethd__baud_set(fd, baud), off = has > baud ? has - baud : baud - has;
  if (has < 0) return ethd__say(message, ETHD_E_DEVICE, "%s: %s", path, strerror(errno));
  if (off * ETHD__LINE_RATE_SHARE > baud)
    return ethd__say(message, ETHD_E_DEVICE,
                     "%s: %u baud requested, the line has %lld, over 2 %% away; choose a rate that the line supports",
                     path, baud, (long long)has);
  tcflush(fd, TCIOFLUSH);
  return ETHD_OK;
}

ethd_status ethd__line_open(const char *path, ethd__line_format format, uint32_t baud, int *fd,
                            char message[ETHD_MESSAGE_MAX]) {
  *fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (*fd < 0)
    return ethd__say(message, ETHD_E_DEVICE, "%s: %s", path,
                     errno == EBUSY ? "another program uses it" : strerror(errno));
  ethd_status status = hold(*fd, path, message);
  if (!status) status = set(*fd, path, format, baud, message);
  if (status) close(*fd);
  if (status) *fd = -1;
  return status;
}

bool ethd__line_low_latency(int fd) {
  struct serial_struct line;
  if (ioctl(fd, TIOCGSERIAL, &line)) return false;
  line.flags |= ASYNC_LOW_LATENCY;
  return ioctl(fd, TIOCSSERIAL, &line) == 0;
}

bool ethd__line_rs485(int fd, bool high) {
  struct serial_rs485 line = {.flags = SER_RS485_ENABLED | (high ? SER_RS485_RTS_ON_SEND : SER_RS485_RTS_AFTER_SEND)};
  return ioctl(fd, TIOCSRS485, &line) == 0;
}
