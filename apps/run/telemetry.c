#include "run/telemetry.h"

#include <arpa/inet.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <netdb.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "text/error_text.h"

#define HOST_MAX 256

/* ---- address ---- */

static bool split(const char *address, char host[HOST_MAX], const char **port) {
  const char *colon = strrchr(address, ':');
  if (!colon || colon == address || !colon[1] || colon[1 + strspn(colon + 1, "0123456789")]) return 0;
  size_t length = (size_t)(colon - address);
  if (address[0] == '[' && colon[-1] == ']') {
    address++;
    length -= 2;
  }
  if (!length || length >= HOST_MAX) return 0;
  memcpy(host, address, length);
  host[length] = 0;
  *port = colon + 1;
  return true;
}

static bool is_port(const char *digits) {
  return strlen(digits) <= 5 && strtoul(digits, NULL, 10) >= 1 && strtoul(digits, NULL, 10) <= 65535;
}

/* Only the kernel's refusal identifies a network's broadcast address. */
static bool is_group(const struct addrinfo *a) {
  const struct sockaddr_in *four = (const void *)a->ai_addr;
  const struct sockaddr_in6 *six = (const void *)a->ai_addr;
  if (a->ai_family == AF_INET6) return IN6_IS_ADDR_MULTICAST(&six->sin6_addr);
  in_addr_t address = ntohl(four->sin_addr.s_addr);
  return IN_MULTICAST(address) || address == INADDR_BROADCAST;
}

/* Returns -1 with errno set if there is no route to the address. */
static int connected(const struct addrinfo *a, bool group) {
  int s = socket(a->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0), on = group;
  if (s < 0) return -1;
  if (setsockopt(s, SOL_SOCKET, SO_BROADCAST, &on, sizeof on) == 0 && connect(s, a->ai_addr, a->ai_addrlen) == 0)
    return s;
  int reason = errno;
  close(s);
  errno = reason;
  return -1;
}

ethd_status ethd__telemetry_open(const char *what, const char *address, bool group, int *out,
                                 char message[ETHD_MESSAGE_MAX]) {
  char host[HOST_MAX], quote[ETHD_QUOTE_MAX];
  const char *port;
  struct addrinfo hints = {.ai_socktype = SOCK_DGRAM}, *found;
  *out = -1;
  if (!split(address, host, &port))
    return ethd__say(message, ETHD_E_SYNTAX, "%s: found %s, HOST:PORT is allowed", what,
                     ethd__quote(address, strlen(address), quote));
  if (!is_port(port))
    return ethd__say(message, ETHD_E_RANGE, "%s: found %s; a port from 1 to 65535 is allowed", what,
                     ethd__quote(address, strlen(address), quote));
  int failure = getaddrinfo(host, port, &hints, &found);
  if (failure) return ethd__say(message, ETHD_E_UNKNOWN, "%s: %s: %s", what, host, gai_strerror(failure));
  bool many = is_group(found);
  *out = many && !group ? -1 : connected(found, group);
  int reason = errno;
  freeaddrinfo(found);
  if (*out >= 0) return ETHD_OK;
  if (many || reason == EACCES)
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: %.200s: a group address; allow it with --telemetry-group", what,
                     address);
  return ethd__say(message, ETHD_E_FILE, "%s: %s: %s", what, address, strerror(reason));
}

/* ---- datagram ---- */

typedef struct telemetry_text {
  char at[2048];
  size_t length;
} telemetry_text;

static void put(telemetry_text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(telemetry_text *t, const char *format, ...) {
  va_list args;
  va_start(args, format);
  int n = vsnprintf(t->at + t->length, sizeof t->at - t->length, format, args);
  va_end(args);
  if (n > 0) t->length += (size_t)n;
  if (t->length >= sizeof t->at) t->length = sizeof t->at - 1;
}

/* JSON has neither NaN nor infinity. */
static void put_number(telemetry_text *t, double v) {
  if (isfinite(v))
    put(t, "%.9g", v);
  else
    put(t, "null");
}

static void put_column(telemetry_text *t, const ethd_column *column, const void *trace) {
  const char *at = (const char *)trace + column->offset;
  put(t, ",\"%s\":%s", column->name, column->count > 1 ? "[" : "");
  for (uint32_t i = 0; i < column->count; i++, at += 8) {
    double number;
    int64_t integer;
    memcpy(&number, at, sizeof number);
    memcpy(&integer, at, sizeof integer);
    if (i) put(t, ",");
    if (column->type == 'f')
      put_number(t, number);
    else
      put(t, "%" PRId64, integer);
  }
  if (column->count > 1) put(t, "]");
}

/* Sent if the front has them. */
static const char *const sent[] = {"tick", "state",   "fault", "contacts", "missed", "q",   "x",    "v",    "xf", "vf",
                                   "tau",  "command", "fe",    "fd",       "beta",   "eps", "d_re", "d_fe", "v_n"};

void ethd__telemetry_send(int socket, const ethd_column *columns, const ethd__row_head *row) {
  telemetry_text t = {.length = 0};
  put(&t, "{\"timestamp\":%.9f,\"armed\":%d,\"share\":", 1e-9 * (double)row->time_ns, (int)row->armed);
  put_number(&t, row->share);
  for (size_t i = 0; i < sizeof sent / sizeof *sent; i++)
    for (const ethd_column *c = columns; c->name; c++)
      if (!strcmp(c->name, sent[i])) put_column(&t, c, row->trace);
  put(&t, "}");
  (void)!send(socket, t.at, t.length, MSG_DONTWAIT | MSG_NOSIGNAL);
}
