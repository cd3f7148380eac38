#include "proximity_ring/port.h"

#include <errno.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "clock.h"
#include "serial/line.h"
#include "text/error_text.h"

#define BACK_OFF_LEAST 50000000 /* ns */
#define BACK_OFF_MOST 1600000000
#define WAIT_MS 20 /* longest wait of one call for bytes */
#define ROOM 4096  /* bytes of one read */

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

ethd_status ethd__ring_port_listen(ethd__ring_port *p, double patience, uint32_t frames,
                                   void (*each)(void *self, const ethd__ring_frame *frame), void *self,
                                   char message[ETHD_MESSAGE_MAX]) {
  ethd__decoder d = {0};
  ethd__ring_frame frame;
  uint8_t bytes[ROOM];
  uint64_t all = 0;
  const int64_t begin = ethd__clock_now(), end = begin + (int64_t)(1e9 * patience);
  ethd_status status = ethd__ring_port_open(p, begin, message);
  while (!status && d.counters.frames < frames && ethd__clock_now() < end) {
    int64_t got = ethd__ring_port_read(p, WAIT_MS, bytes, sizeof bytes);
    if (got < 0) return ethd__say(message, ETHD_E_DEVICE, "%s: the line is gone", p->path);
    const uint8_t *at = bytes;
    while (ethd__decoder_next(&d, &at, bytes + got, &frame)) each(self, &frame);
    all += (uint64_t)got;
  }
  if (status || d.counters.frames >= frames) return status;
  if (!all)
    return ethd__say(message, ETHD_E_DEVICE, "%s: nothing came in %g s: is the sensor connected and powered?", p->path,
                     patience);
  return ethd__say(message, ETHD_E_DEVICE, "%s: %llu bytes but %llu frames in %g s: is its baud rate %u?", p->path,
                   (unsigned long long)all, (unsigned long long)d.counters.frames, patience, p->baud);
}

/* Opens the port anew when that is due, and drops what came while nobody listened. */
static ethd_status be_there(ethd__ring_port *p, const ethd__ring_listener *to, int64_t now_ns) {
  char message[ETHD_MESSAGE_MAX];
  if (p->fd < 0) {
    if (now_ns < p->attempt_ns) return ETHD_STATUS_STALE;
    ethd_status status = ethd__ring_port_open(p, now_ns, message);
    if (status) return status;
    to->restart(to->self);
  }
  if (!ethd__clock_was_deaf(&p->heard_ns, now_ns)) return ETHD_OK;
  tcflush(p->fd, TCIFLUSH);
  to->restart(to->self);
  return ETHD_OK;
}

ethd_status ethd__ring_port_service(ethd__ring_port *p, const ethd__ring_listener *to, int64_t now_ns) {
  uint8_t bytes[ROOM];
  pthread_mutex_lock(to->lock);
  ethd_status status = be_there(p, to, now_ns);
  pthread_mutex_unlock(to->lock);
  if (status) return status;
  int64_t got = ethd__ring_port_read(p, to->is_virtual ? 0 : WAIT_MS, bytes, sizeof bytes);
  if (got <= 0) return got < 0 ? ETHD_E_DEVICE : ETHD_OK;
  int64_t arrival_ns = to->is_virtual ? now_ns : ethd__clock_now();
  pthread_mutex_lock(to->lock);
  to->take(to->self, bytes, (size_t)got, arrival_ns);
  pthread_mutex_unlock(to->lock);
  return ETHD_OK;
}
