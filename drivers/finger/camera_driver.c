/* The driver of a motion capture or a headset, beside a driver of the motors, in the plane or in space: the finger's
   centre in R_0 comes as datagrams of a bridge (camera.h).

   It listens only at the address `listen`. This is a loopback address (127.0.0.1, ::1) unless `from` names the one
   address whose datagrams count, because any sender of such datagrams moves the ring. */
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <netdb.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "clock.h"
#include "finger/camera.h"
#include "finger/inbox.h"
#include "finger/limits.h"
#include "no_joints.h"
#include "text/error_text.h"

#define WAIT_MS 20    /* wait for a datagram of one call of service */
#define AT_ONCE 64    /* datagrams that one call of service takes at most */
#define WAITING 65536 /* datagrams that a socket holds at most */

enum { RATE, DELAY, PATIENCE, CONFIDENCE, PARAMS };
enum { LISTEN, FROM, KEYS };

static const ethd_param params[PARAMS] = {
    [RATE] = {"rate", "Hz", 1, 10000, 90, "rate of the exposures"},
    [DELAY] = {"delay", "s", 0, 0.5, 0.0111, "time from an exposure to the earliest arrival of its datagram"},
    [PATIENCE] = {"patience", "s", 0.05, 60, 2, "longest wait for the first datagram"},
    [CONFIDENCE] = {"confidence", "1", 0, 1, 0.5, "a datagram with less says nothing about the finger"},
};

static const char *const keys[] = {[LISTEN] = "listen", [FROM] = "from", [KEYS] = NULL};

typedef struct camera {
  int fd;                            /* -1: not open */
  struct sockaddr_storage from, own; /* from with ss_family 0: anybody on this machine may send */
  socklen_t own_length;
  const char *where; /* the text of `own`, valid while the driver is being opened */
  double patience;   /* s to wait for the first datagram */
  double rate, confidence;
  uint32_t axes;    /* that a position needs: 2 in the plane, 3 in space */
  bool is_virtual;  /* whether the clock is virtual */
  int64_t heard_ns; /* instant of the last listening */
  ethd__camera_clock clock;
  ethd__inbox inbox;
  char why[ETHD_MESSAGE_MAX]; /* the last datagram was refused; "": none was */
} camera;

/* ---- addresses ---- */

static bool find_address(const char *host, const char *port, struct sockaddr_storage *out, socklen_t *length) {
  const struct addrinfo hints = {.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV, .ai_socktype = SOCK_DGRAM};
  struct addrinfo *found;
  if (getaddrinfo(host, port, &hints, &found)) return false;
  memcpy(out, found->ai_addr, found->ai_addrlen);
  *length = found->ai_addrlen;
  freeaddrinfo(found);
  return true;
}

/* Reads an address and a port, "127.0.0.1:9871" or "[::1]:9871". */
static bool parse_listen(const char *text, struct sockaddr_storage *out, socklen_t *length) {
  char host[80];
  const char *colon = strrchr(text, ':'), *begin = text, *end = colon;
  if (!colon || strspn(colon + 1, "0123456789") != strlen(colon + 1) || strlen(colon + 1) > 5) return false;
  if (atoi(colon + 1) < 1 || atoi(colon + 1) > 65535) return false;
  if (*begin == '[' && end > begin + 1 && end[-1] == ']') begin++, end--;
  if (end <= begin || (size_t)(end - begin) >= sizeof host) return false;
  memcpy(host, begin, (size_t)(end - begin));
  host[end - begin] = 0;
  return find_address(host, colon + 1, out, length);
}

static bool is_loopback(const struct sockaddr_storage *a) {
  if (a->ss_family == AF_INET)
    return ntohl(((const struct sockaddr_in *)(const void *)a)->sin_addr.s_addr) >> 24 == IN_LOOPBACKNET;
  return IN6_IS_ADDR_LOOPBACK(&((const struct sockaddr_in6 *)(const void *)a)->sin6_addr);
}

/* Compares two addresses without their ports. */
static bool is_host(const struct sockaddr_storage *a, const struct sockaddr_storage *b) {
  const struct sockaddr_in *a4 = (const void *)a, *b4 = (const void *)b;
  const struct sockaddr_in6 *a6 = (const void *)a, *b6 = (const void *)b;
  if (a->ss_family != b->ss_family) return false;
  if (a->ss_family == AF_INET) return a4->sin_addr.s_addr == b4->sin_addr.s_addr;
  return memcmp(&a6->sin6_addr, &b6->sin6_addr, sizeof a6->sin6_addr) == 0;
}

/* ---- I/O ---- */

static void take(camera *c, const char *bytes, size_t count, int64_t arrival_ns) {
  ethd__sighting *s = &c->inbox.newest;
  ethd__exposure e;
  int64_t sample_ns;
  if (!ethd__exposure_decode(bytes, count, &e, c->why)) {
    s->lost++;
    return;
  }
  uint64_t lost = c->clock.lost;
  bool newer = ethd__camera_clock_step(&c->clock, &e, arrival_ns, &sample_ns);
  s->lost += c->clock.lost - lost;
  s->jumps = c->clock.jumps;
  if (!newer || !e.axes || e.confidence < c->confidence) return;
  const bool is_good = e.axes >= c->axes;
  if (is_good) {
    s->have = ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD;
    ethd__inbox_stamp(&c->inbox, sample_ns, arrival_ns);
    s->centre = e.finger;
    s->noise = e.noise;
    s->v = e.v;
    s->v_noise = e.v_noise;
  } else {
    snprintf(c->why, sizeof c->why, "p: three numbers are needed in space");
  }
  ethd__inbox_judge(&c->inbox, is_good);
}

/* Receives one datagram; false: there is none. A datagram longer than any exposure is cut and then refused. */
static bool receive(camera *c, int64_t arrival_ns) {
  char bytes[ETHD__EXPOSURE_SIZE + 1];
  struct sockaddr_storage from = {.ss_family = 0};
  socklen_t length = sizeof from;
  ssize_t got = recvfrom(c->fd, bytes, sizeof bytes, MSG_DONTWAIT, (struct sockaddr *)&from, &length);
  if (got < 0) return false;
  if (c->from.ss_family && !is_host(&c->from, &from)) return true; /* not from the bridge */
  pthread_mutex_lock(&c->inbox.lock);
  take(c, bytes, (size_t)got, arrival_ns);
  pthread_mutex_unlock(&c->inbox.lock);
  return true;
}

/* Drops the waiting datagrams. */
static void drain(const camera *c) {
  char byte;
  for (int i = 0; i < WAITING && recv(c->fd, &byte, 1, MSG_DONTWAIT) >= 0; i++) continue;
}

static ethd_status service(void *device, uint32_t unit, int64_t now_ns) {
  camera *c = device;
  struct pollfd wait = {c->fd, POLLIN, 0};
  (void)unit;
  if (ethd__clock_was_deaf(&c->heard_ns, now_ns)) drain(c);
  if (poll(&wait, 1, c->is_virtual ? 0 : WAIT_MS) <= 0) return ETHD_OK;
  int64_t arrival_ns = c->is_virtual ? now_ns : ethd__clock_now();
  for (int i = 0; i < AT_ONCE && receive(c, arrival_ns); i++) continue;
  ethd__inbox_put(&c->inbox);
  return ETHD_OK;
}

/* ---- [rt] ---- */

static ethd_status camera_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  ethd__inbox_read(&((camera *)device)->inbox, now_ns, out);
  return ETHD_OK;
}

static ethd_status camera_read_space(void *device, int64_t now_ns, ethd_space_sense *out) ETHD_RT {
  ethd__inbox_read_space(&((camera *)device)->inbox, now_ns, out);
  return ETHD_OK;
}

/* ---- [main] ---- */

static ethd_status refuse(const ethd_device_def *def, const ethd_setting *s, const char *key, const char *allowed,
                          char *message) {
  char quote[ETHD_QUOTE_MAX];
  const char *file = def->file ? def->file : "the defaults";
  if (!s) return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.%s is missing: %s", file, key, allowed);
  return ethd__say(message, ETHD_E_SYNTAX, "%s:%d: device.%s: found %s, %s", file, s->line, key,
                   ethd__quote(s->value, strlen(s->value), quote), allowed);
}

static ethd_status find_addresses(camera *c, const ethd_device_def *def, const ethd_setting *texts[KEYS],
                                  char *message) {
  socklen_t other;
  if (!texts[LISTEN] || !parse_listen(texts[LISTEN]->value, &c->own, &c->own_length))
    return refuse(def, texts[LISTEN], keys[LISTEN], "an address and a port as 127.0.0.1:9871 is allowed", message);
  if (texts[FROM] && !find_address(texts[FROM]->value, NULL, &c->from, &other))
    return refuse(def, texts[FROM], keys[FROM], "the bridge's address as 192.168.1.7 is allowed", message);
  if (!texts[FROM] && !is_loopback(&c->own))
    return refuse(def, texts[LISTEN], keys[LISTEN],
                  "127.0.0.1 is allowed, and others with `from`: a sender to this address moves the ring", message);
  return ETHD_OK;
}

static ethd_status wait_first(camera *c, char *message) {
  struct pollfd wait = {c->fd, POLLIN, 0};
  int64_t end = ethd__clock_now() + (int64_t)(1e9 * c->patience);
  while (c->inbox.newest.readings == 0 && c->clock.started == false && ethd__clock_now() < end)
    if (poll(&wait, 1, WAIT_MS) > 0) (void)receive(c, ethd__clock_now());
  if (c->clock.started) return ETHD_OK;
  if (!*c->why)
    return ethd__say(message, ETHD_E_DEVICE, "%s: no datagram came in %g s: does the bridge run?", c->where,
                     c->patience);
  return ethd__say(message, ETHD_E_DEVICE, "%s: %llu datagrams were refused: %s", c->where,
                   (unsigned long long)c->inbox.newest.lost, c->why);
}

static ethd_status camera_prepare(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  const ethd_setting *texts[KEYS] = {NULL};
  double p[PARAMS];
  *device = NULL;
  ethd_params_default(params, PARAMS, p);
  ethd_status status = ethd_settings_read(&ethd_driver_camera, def, p, texts, message);
  if (status) return status;
  camera *c = *device = calloc(1, sizeof *c);
  if (!c) return ETHD_E_MEMORY;
  c->fd = -1;
  c->rate = p[RATE];
  c->confidence = p[CONFIDENCE];
  c->axes = def->space ? 3 : 2;
  c->is_virtual = def->is_virtual;
  c->clock.delay = (int64_t)(1e9 * p[DELAY]);
  if (ethd__inbox_open(&c->inbox, p[RATE])) return ethd__no_memory(message, NULL);
  c->patience = p[PATIENCE];
  c->where = texts[LISTEN] ? texts[LISTEN]->value : "";
  return find_addresses(c, def, texts, message);
}

static ethd_status camera_open(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = camera_prepare(def, device, message);
  if (status) return status;
  camera *c = *device;
  c->fd = socket(c->own.ss_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (c->fd < 0 || bind(c->fd, (const struct sockaddr *)&c->own, c->own_length))
    return ethd__say(message, ETHD_E_DEVICE, "%s: %s", c->where, strerror(errno));
  status = wait_first(c, message);
  /* the first datagrams came by the real clock; on a virtual one the clock's work begins with the run */
  c->clock = (ethd__camera_clock){.delay = c->clock.delay};
  c->inbox.newest = (ethd__sighting){0};
  return status;
}

static uint32_t units(const void *device) { return (void)device, 1; }

static ethd_limits limits(const void *device) {
  const camera *c = device;
  ethd_limits limits = ethd_limits_device();
  ethd__finger_limits(c->rate, 1e-9 * (double)c->clock.delay, &limits);
  limits.gap = (double)INFINITY; /* it takes no samples of the joints */
  return limits;
}

static uint32_t figures(const void *device, ethd_figure *out, uint32_t max) {
  return ethd__inbox_figures(&((camera *)device)->inbox, out, max);
}

static void camera_close(void *device) {
  camera *c = device;
  if (c->fd >= 0) close(c->fd);
  ethd__inbox_close(&c->inbox);
  free(c);
}

const ethd_driver ethd_driver_camera = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "camera",
    .brief = "a motion capture's or headset's positions in R_0, by UDP from a bridge, beside a driver that moves",
    .params = params,
    .param_count = PARAMS,
    .keys = keys,
    .open = camera_open,
    .read = camera_read,
    .units = units,
    .service = service,
    .close = camera_close,
    .limits = limits,
    .figures = figures,
    .joints = ethd__no_joints,
    .prepare = camera_prepare,
    .read_space = camera_read_space,
};
