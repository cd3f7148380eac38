#include "proximity_ring/port.h"

#include <errno.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "clock.h"
#include "serial/line.h"

#define BACK_OFF_LEAST 50000000 /* ns */
#define BACK_OFF_MOST 1600000000

ethd_status ethd__ring_port_open(ethd__ring_port *p, int64_t now_ns, char message[ETHD_MESSAGE_MAX]) {
  p->back_off = p->back_off < BACK_OFF_LEAST / 2 ? BACK_OFF_LEAST : 2 * p->back_off;
  if (p->back_off > BACK_OFF_MOST) p->back_off = BACK_OFF_MOST;
  p->attempt_ns = now_ns + p->back_off;
  ethd_status status = ethd__line_open(p->path, ETHD__LINE_8N1, p->baud, &p->fd, message);
  if (status) return status;
  p->low_latency = ethd__line_low_latency(p->fd);
  p->back_off = 0;
  p->opened++;
  return ETHD_OK;
}

bool ethd__ring_port_was_deaf(ethd__ring_port *p, int64_t now_ns) {
  if (!ethd__clock_was_deaf(&p->heard_ns, now_ns)) return false;
  tcflush(p->fd, TCIFLUSH);
  return true;
}

int64_t ethd__ring_port_read(ethd__ring_port *p, int wait_ms, uint8_t *out, size_t room) {
  struct pollfd wait = {p->fd, POLLIN, 0};
  int ready = poll(&wait, 1, wait_ms);
  if (ready == 0 || (ready < 0 && errno == EINTR)) return 0;
  ssize_t got = ready < 0 ? -1 : read(p->fd, out, room);
  if (got > 0) return got;
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  ethd__ring_port_close(p); /* a line that is ready but has nothing to read has hung up */
  return -1;
}

void ethd__ring_port_close(ethd__ring_port *p) {
  if (p->fd >= 0) close(p->fd);
  p->fd = -1;
}
