/* Your own driver, for a robot arm that takes velocities over TCP and reports at its own rate, such as 125 to 500 Hz. The
   messages are a model's, little endian; put your controller's into `exchange`. As a shared object it is a driver for
   every program: [device] driver = file:tcp_arm.so, and its key at = HOST:PORT.
     cc -shared -fPIC tcp_arm.c $(pkg-config --cflags ethd-drivers) -o tcp_arm.so */
#include <errno.h>
#include <ethd/cell.h>
#include <ethd/driver.h>
#include <math.h>
#include <netdb.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { RUNNING = 1, PROTECTIVE_STOP = 2 };
typedef struct state {
  uint32_t seq, mode;
  double t, x[3], v[3]; /* s in its own clock; m, m/s: the tool's point as commanded, in R_0 */
} state;

typedef struct order {
  uint32_t seq, run; /* of the state that it answers; 0: stop and close the brakes */
  double v[3];       /* m/s */
} order;

typedef struct arm {
  int line;
  ethd_cell *orders, *states;
  _Atomic int32_t safe, gone, bad; /* no order until the next start; the line is broken; a state was lost or damaged */
  struct {
    state state;
    int64_t at;
  } seen, new; /* the control thread's; the I/O thread's, as all that follows */
  ethd_space_command taken;
  size_t got;         /* bytes of a state that has begun */
  int64_t difference; /* ns: this machine's clock less the controller's */
  char bytes[sizeof(state)];
} arm;

static int64_t now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static int is_possible(const state *s) {
  int good = fabs(s->t) < 1e9;
  for (int i = 0; i < 3; i++) good &= fabs(s->x[i]) < 10 && fabs(s->v[i]) < 10;
  return good;
}

/* Takes a state, if it is newer than all before, and answers it. A late one doesn't move the clock, whose rate may be off
   by 1e-4. */
static ethd_status exchange(arm *a, int64_t arrival) {
  state s;
  memcpy(&s, a->bytes, sizeof s);
  const int32_t step = a->new.at ? (int32_t)(s.seq - a->new.state.seq) : 1;
  if (!is_possible(&s) || step != 1) a->bad = 1;
  if (!is_possible(&s) || step < 1) return ETHD_OK;
  const int64_t least = arrival - (int64_t)(1e9 * s.t),
                drifted = a->difference + (int64_t)(1e5 * (s.t - a->new.state.t));
  a->difference = a->new.at &&drifted < least ? drifted : least;
  a->new.state = s, a->new.at = (int64_t)(1e9 * s.t) + a->difference;
  ethd_cell_put(a->states, &a->new);
  (void)!ethd_cell_take(a->orders, &a->taken);
  order out = {.seq = s.seq, .run = !a->safe && !a->taken.safe};
  if (out.run) memcpy(out.v, a->taken.value, sizeof out.v);
  return send(a->line, &out, sizeof out, MSG_NOSIGNAL) == sizeof out ? ETHD_OK : ETHD_E_DEVICE;
}

static ethd_status service(void *device, uint32_t unit, int64_t now_ns) {
  arm *a = device;
  const ssize_t n = recv(a->line, a->bytes + a->got, sizeof a->bytes - a->got, 0);
  (void)unit, (void)now_ns;
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return ETHD_OK;
  if (n <= 0) a->gone = 1;
  if (n <= 0) return ETHD_E_DEVICE;
  a->got = (a->got + (size_t)n) % sizeof a->bytes;
  return a->got ? ETHD_OK : exchange(a, now());
}

static ethd_status open_arm(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  arm *a = *device = calloc(1, sizeof *a);
  const ethd_setting *at = NULL;
  const struct addrinfo hints = {.ai_socktype = SOCK_STREAM};
  struct addrinfo *found = NULL;
  if (!a) return ETHD_E_MEMORY;
  ethd_status status = ethd_settings_read(&ethd_driver_plugin, def, NULL, &at, message);
  if (!status) status = ethd_cell_create(sizeof a->taken, &a->orders, NULL);
  if (!status) status = ethd_cell_create(sizeof a->seen, &a->states, NULL);
  if (status) return a->line = -1, status;
  char *host = strdup(at ? at->value : ""), *colon = strrchr(host, ':');
  if (colon) *colon = 0;
  a->line = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  setsockopt(a->line, SOL_SOCKET, SO_RCVTIMEO, &(struct timeval){.tv_usec = 20000}, sizeof(struct timeval));
  if (!colon || getaddrinfo(host, colon + 1, &hints, &found) || connect(a->line, found->ai_addr, found->ai_addrlen)) {
    snprintf(message, ETHD_MESSAGE_MAX, "at = %s: no arm answers there; HOST:PORT is needed", at ? at->value : "");
    status = ETHD_E_DEVICE;
  }
  if (found) freeaddrinfo(found);
  free(host);
  return status;
}

static ethd_status start(void *device) {
  arm *a = device;
  ethd_cell_put(a->orders, &(ethd_space_command){.kind = ETHD_SPACE_VELOCITY});
  a->safe = a->bad = 0;
  return a->gone ? ETHD_E_DEVICE : ETHD_OK;
}

static uint32_t units(const void *device) { return (void)device, 1; }

static ethd_status read_arm(void *device, int64_t now_ns, ethd_space_sense *out) ETHD_RT {
  arm *a = device;
  ethd_status status = ethd_cell_take(a->states, &a->seen);
  out->time_ns = a->seen.at;
  for (int i = 0; i < 3; i++) out->x[i] = a->seen.state.x[i], out->v[i] = a->seen.state.v[i];
  if (atomic_exchange(&a->bad, 0)) out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_REPLY_BAD);
  if (a->gone) out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_LINK_LOST);
  if (a->seen.state.mode == PROTECTIVE_STOP) out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_DRIVE);
  return (void)now_ns, status; /* ETHD_STATUS_STALE: the loop waits for the next one */
}

static ethd_status write_arm(void *device, int64_t now_ns, const ethd_space_command *command) ETHD_RT {
  ethd_cell_put(((arm *)device)->orders, command);
  return (void)now_ns, ETHD_OK;
}

static ethd_ability able(const void *device, const double n[3]) ETHD_RT {
  return (void)device, (void)n, (ethd_ability){1, 8, 0.02, (double)NAN, (double)NAN, (double)NAN};
}

static void safe(void *device) ETHD_RT { ((arm *)device)->safe = 1; }

static ethd_limits limits(const void *device) {
  ethd_limits limits = ethd_limits_none();
  return (void)device, limits.gap = 0.02, limits; /* s between two states at most */
}

static void close_arm(void *device) {
  arm *a = device;
  if (a->line >= 0) close(a->line);
  ethd_cell_destroy(a->orders), ethd_cell_destroy(a->states);
  free(a);
}

static const char *const keys[] = {"at", NULL};
const ethd_driver ethd_driver_plugin = {.size = sizeof(ethd_driver),
                                        .abi = ETHD_DRIVER_ABI,
                                        .id = "tcp_arm",
                                        .brief = "an arm that takes velocities over TCP",
                                        .keys = keys,
                                        .open = open_arm,
                                        .start = start,
                                        .units = units,
                                        .service = service,
                                        .safe = safe,
                                        .close = close_arm,
                                        .limits = limits,
                                        .read_space = read_arm,
                                        .write_space = write_arm,
                                        .able = able,
                                        .safe_is = ETHD_SAFE_BRAKES};
