#include "servo/mock.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#define HEAD 7 /* bytes of a tcp frame before the function */

uint16_t mock_crc(const uint8_t *data, int length) {
  uint16_t crc = 0xFFFF;
  for (int i = 0; i < length; i++) {
    crc ^= data[i];
    for (int k = 0; k < 8; k++) crc = crc & 1 ? (uint16_t)(crc >> 1 ^ 0xA001) : (uint16_t)(crc >> 1);
  }
  return crc;
}

static uint16_t get(const uint8_t *p) { return (uint16_t)(p[0] << 8 | p[1]); }
static void put(uint8_t *p, uint32_t v) {
  p[0] = (uint8_t)(v >> 8);
  p[1] = (uint8_t)v;
}

/* ---- the drive ---- */

static void heed(const mock *m, _Atomic uint16_t *w) {
  if (m->stuck) w[MOCK_TORQUE1] = (uint16_t)m->stuck;
  if (w[MOCK_CONTROL] == 2) w[MOCK_STATUS] &= (uint16_t)~1;
  if (w[MOCK_CONTROL] == 1 && !(w[MOCK_STATUS] & 1)) w[MOCK_STATUS] |= 2;
  if (w[MOCK_CONTROL] == 0 || w[MOCK_STATUS] & 1) w[MOCK_STATUS] &= (uint16_t)~2;
  for (int i = 0; i < 2 && !m->frozen; i++) w[MOCK_MEASURED1 + i] = w[MOCK_STATUS] & 2 ? w[MOCK_TORQUE1 + i] : 0;
}

static void store(const mock *m, _Atomic uint16_t *words, const uint8_t *from, uint32_t at, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) words[(at + i) & 0xFFFF] = get(from + 2 * i);
  heed(m, words);
}

static int load(const _Atomic uint16_t *words, uint8_t *pdu, uint32_t at, uint32_t count) {
  pdu[1] = (uint8_t)(2 * count);
  for (uint32_t i = 0; i < count; i++) put(pdu + 2 + 2 * i, words[(at + i) & 0xFFFF]);
  return (int)(2 + 2 * count);
}

/* A unit's answer to a request, from its function on; its length. */
static int answer(mock *m, int unit, const uint8_t *q, uint8_t *a) {
  _Atomic uint16_t *words = unit == 2 ? m->second : m->words;
  a[0] = q[0];
  switch (q[0]) {
  case 3:
  case 4: return load(words, a, get(q + 1), get(q + 3));
  case 16:
    store(m, words, q + 6, get(q + 1), get(q + 3));
    memcpy(a + 1, q + 1, 4);
    return 5;
  case 23: store(m, words, q + 10, get(q + 5), get(q + 7)); return load(words, a, get(q + 1), get(q + 3));
  default:
    a[0] |= 0x80;
    a[1] = 1;
    return 2;
  }
}

/* ---- frames ---- */

static int read_all(const mock *m, uint8_t *to, int count) {
  for (int got = 0; got < count;) {
    struct pollfd wait = {m->line, POLLIN, 0};
    if (atomic_load(&m->stop)) return 0;
    if (poll(&wait, 1, 5) < 1) continue;
    ssize_t n = read(m->line, to + got, (size_t)(count - got));
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EIO)) return 0;
    if (n < 0) usleep(1000); /* nobody has opened the terminal */
    if (n > 0) got += (int)n;
  }
  return 1;
}

/* A request: its unit at q[0] behind the head, its function at q[1]; 0: the line is gone. */
static int read_request(const mock *m, uint8_t *head, uint8_t *q) {
  if (!m->is_rtu) return read_all(m, head, HEAD) && (q[0] = head[6], read_all(m, q + 1, get(head + 4) - 1));
  if (!read_all(m, q, 8)) return 0;
  int more = q[1] == 16 ? 7 + q[6] + 2 - 8 : 0;
  if (q[1] == 23) {
    if (!read_all(m, q + 8, 3)) return 0;
    return read_all(m, q + 11, q[10] + 2);
  }
  return !more || read_all(m, q + 8, more);
}

static int frame(const mock *m, const uint8_t *head, const uint8_t *q, const uint8_t *pdu, int length, uint8_t *out) {
  int at = m->is_rtu ? 1 : HEAD;
  if (!m->is_rtu) memcpy(out, head, 4), put(out + 4, (uint32_t)length + 1);
  out[at - 1] = (uint8_t)(q[0] + m->astray);
  memcpy(out + at, pdu, (size_t)length);
  if (!m->is_rtu) return at + length;
  uint16_t crc = mock_crc(out, 1 + length);
  out[1 + length + m->crc_high] = (uint8_t)crc;
  out[2 + length - m->crc_high] = (uint8_t)(crc >> 8);
  return 3 + length;
}

static void send_all(const mock *m, const uint8_t *out, int length) {
  for (int sent = 0; sent < length;) {
    ssize_t n = write(m->line, out + sent, (size_t)(length - sent));
    if (n < 0) return;
    sent += (int)n;
  }
}

static void reset_line(mock *m) {
  const struct linger now = {1, 0};
  if (m->line < 0) return;
  setsockopt(m->line, SOL_SOCKET, SO_LINGER, &now, sizeof now);
  close(m->line);
  m->line = -1;
}

static void hold(mock *m) {
  atomic_store(&m->holding, 1);
  while (!atomic_load(&m->released) && !atomic_load(&m->stop)) usleep(200);
  atomic_store(&m->released, 0);
  atomic_store(&m->holding, 0);
}

static void reply(mock *m, const uint8_t *head, const uint8_t *q, mock_act act) {
  uint8_t pdu[512], out[600], *last = m->last[q[0] == 2][q[1] == 16];
  int *last_length = &m->last_length[q[0] == 2][q[1] == 16];
  if (act.kind == MOCK_DROP || q[0] == m->mute) return;
  int length = answer(m, q[0], q + 1, pdu);
  if (act.kind == MOCK_HOLD) hold(m);
  if (act.kind == MOCK_LATE) usleep((useconds_t)act.wait);
  if (act.kind == MOCK_EXCEPTION) pdu[0] = q[1] | 0x80, pdu[1] = (uint8_t)act.code, length = 2;
  if (act.kind == MOCK_OLD && *last_length == length)
    memcpy(pdu, last, (size_t)length);
  else
    memcpy(last, pdu, (size_t)length), *last_length = length;
  int bytes = frame(m, head, q, pdu, length, out), first = bytes / 2;
  if (act.kind == MOCK_GARBLE) out[m->is_rtu ? 3 : 1] ^= 0x10;
  if (act.kind != MOCK_HALF && act.kind != MOCK_CUT) first = bytes;
  send_all(m, out, first);
  if (act.kind != MOCK_HALF) return;
  usleep((useconds_t)act.wait);
  send_all(m, out + first, bytes - first);
}

static int request_length(const uint8_t *q) { return q[1] == 16 ? 9 + q[6] : q[1] == 23 ? 13 + q[10] : 8; }

/* Whether its checksum is this drive's; what was sent comes back where it should. */
static int heard(const mock *m, const uint8_t *q) {
  int n = request_length(q);
  uint16_t crc = mock_crc(q, n - 2);
  if (!m->is_rtu) return 1;
  if (m->mirror) send_all(m, q, n);
  return q[n - 2 + m->crc_high] == (crc & 0xFF) && q[n - 1 - m->crc_high] == crc >> 8;
}

static void serve(mock *m) {
  uint8_t head[HEAD], q[600];
  while (!atomic_load(&m->stop) && read_request(m, head, q)) {
    if (!heard(m, q)) continue;
    uint64_t n = atomic_fetch_add(&m->requests, 1);
    mock_act act = {MOCK_ANSWER, 0, 0};
    mock_plan plan = m->act;
    if (plan) act = plan(m->user, n, q[1]);
    if (act.kind == MOCK_RESET) break;
    reply(m, head, q, act);
  }
}

/* ---- lines ---- */

static void *run_tcp(void *mock_) {
  mock *m = mock_;
  const int one = 1;
  while (!atomic_load(&m->stop)) {
    struct pollfd wait = {m->listener, POLLIN, 0};
    if (poll(&wait, 1, 5) < 1) continue;
    m->line = accept(m->listener, NULL, NULL);
    if (m->line < 0) continue;
    setsockopt(m->line, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    atomic_fetch_add(&m->connections, 1);
    serve(m);
    reset_line(m);
  }
  return NULL;
}

static void *run_rtu(void *mock_) {
  mock *m = mock_;
  while (!atomic_load(&m->stop)) serve(m);
  return NULL;
}

static void fail(const char *what) {
  perror(what);
  exit(1);
}

static void listen_tcp(mock *m, uint16_t port) {
  struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons(port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  socklen_t size = sizeof at;
  const int one = 1;
  m->listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  setsockopt(m->listener, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one);
  if (bind(m->listener, (struct sockaddr *)&at, size) || listen(m->listener, 4)) fail("mock: listen");
  getsockname(m->listener, (struct sockaddr *)&at, &size);
  snprintf(m->port, sizeof m->port, "127.0.0.1:%u", ntohs(at.sin_port));
}

static void open_terminal(mock *m) {
  struct termios t;
  m->line = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (m->line < 0 || grantpt(m->line) || unlockpt(m->line) || ptsname_r(m->line, m->port, sizeof m->port))
    fail("mock: pty");
  m->slave = open(m->port, O_RDWR | O_NOCTTY | O_CLOEXEC);
  tcgetattr(m->slave, &t);
  cfmakeraw(&t);
  tcsetattr(m->slave, TCSANOW, &t);
}

static void begin(mock *m) {
  atomic_store(&m->stop, 0);
  if (pthread_create(&m->thread, NULL, m->is_rtu ? run_rtu : run_tcp, m)) fail("mock: thread");
}

void mock_start(mock *m, int is_rtu) {
  memset(m, 0, sizeof *m);
  m->listener = m->line = m->slave = -1;
  m->is_rtu = is_rtu;
  m->words[MOCK_VOLTAGE] = m->second[MOCK_VOLTAGE] = 480;
  if (is_rtu)
    open_terminal(m);
  else
    listen_tcp(m, 0);
  begin(m);
}

static void end(mock *m) {
  atomic_store(&m->stop, 1);
  pthread_join(m->thread, NULL);
}

void mock_stop(mock *m) {
  if (m->thread) end(m);
  if (m->is_rtu) close(m->line);
  if (m->listener >= 0) close(m->listener);
  if (m->slave >= 0) close(m->slave);
}

void mock_unplug(mock *m) {
  end(m);
  close(m->listener);
  m->listener = -1;
}

void mock_plug(mock *m) {
  listen_tcp(m, (uint16_t)atoi(strchr(m->port, ':') + 1));
  begin(m);
}

void mock_release(mock *m) { atomic_store(&m->released, 1); }
