/* The proximity ring on a desk: its firmware in four simulated chips, 16 simulated sensors, its UART on a
   pseudo-terminal. */
#include <argp.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <arpa/inet.h>
#include <sys/socket.h>

#include "commands.h"

enum { CHUNK = RING_FREQUENCY / 4000 }; /* 250 us: so often bytes leave and commands are read */

typedef struct options {
  const char *firmware, *alias;
  bool slow, step, baud_matters;
  double speed, duration;
  int udp;
} options;

static volatile sig_atomic_t stopped;
static void stop(int signal) { (void)signal, stopped = 1; }

static double clock_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

/* A line on stderr is for what is wrong; simavr's own chatter isn't. */
static void quiet(struct avr_t *avr, const int level, const char *format, va_list arguments) {
  (void)avr;
  if (level <= LOG_ERROR) vfprintf(stderr, format, arguments);
}

static void advance(session *s, uint64_t until) {
  double began = clock_now();
  ring_run(s->ring, until);
  s->wall += clock_now() - began;
  s->terminal.baud = ring_baud(s->ring);
  terminal_flush(&s->terminal);
}

/* ---- lines ---- */

static void take(session *s, const char *line) {
  const char *why;
  if (!*line) return;
  if (!command(s, line, &why)) {
    printf("error: found \"%s\"; %s\n", line, why);
    return;
  }
  uint64_t until = s->ring->now + (uint64_t)(s->run * RING_FREQUENCY + 0.5);
  s->run = 0;
  while (s->ring->now < until && !stopped) {
    uint64_t next = s->ring->now + CHUNK;
    advance(s, next < until ? next : until);
  }
  if (s->step) printf("ok %.6f\n", (double)s->ring->now / RING_FREQUENCY);
}

/* Splits what came into lines; false at the end of the input. */
static bool read_lines(session *s, int fd) {
  static char text[8192];
  static size_t filled;
  ssize_t more = read(fd, text + filled, sizeof text - 1 - filled);
  if (more <= 0) return more < 0 && (errno == EAGAIN || errno == EINTR);
  filled += (size_t)more;
  text[filled] = 0;
  char *line = text;
  for (char *end; (end = strchr(line, '\n')) && !s->quit; line = end + 1) {
    *end = 0;
    take(s, line);
  }
  filled -= (size_t)(line - text);
  memmove(text, line, filled);
  if (filled == sizeof text - 1) filled = 0;
  return true;
}

static void read_datagrams(session *s, int fd) {
  char text[1024];
  for (ssize_t size; fd >= 0 && (size = recv(fd, text, sizeof text - 1, MSG_DONTWAIT)) > 0;) {
    text[size] = 0;
    text[strcspn(text, "\n")] = 0;
    take(s, text);
  }
}

static int open_udp(int port) {
  struct sockaddr_in here = {
      .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
  int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd >= 0 && !bind(fd, (struct sockaddr *)&here, sizeof here)) return fd;
  fprintf(stderr, "ring_board: --udp %d: %s\n", port, strerror(errno));
  exit(1);
}

/* ---- time ---- */

static void listen_for(session *s, int *input, int udp, int wait_ms) {
  struct pollfd from[2] = {{.fd = *input, .events = POLLIN}, {.fd = udp, .events = POLLIN}};
  if (poll(from, 2, wait_ms) <= 0) return;
  if (from[0].revents && !read_lines(s, *input)) *input = -1;
  read_datagrams(s, udp);
  fflush(stdout);
}

/* Keeps simulated time `speed` times real time; after a long interruption it goes on from where it is. */
static void pace(const session *s, double speed, double *origin) {
  double ahead = (double)s->ring->now / RING_FREQUENCY / speed + *origin - clock_now();
  if (ahead < -0.1) *origin -= ahead;
  if (ahead <= 0) return;
  struct timespec rest = {.tv_sec = (time_t)ahead, .tv_nsec = (long)((ahead - (double)(time_t)ahead) * 1e9)};
  nanosleep(&rest, NULL);
}

static void serve(session *s, const options *o) {
  int input = STDIN_FILENO, udp = o->udp ? open_udp(o->udp) : -1;
  double origin = clock_now();
  while (!stopped && !s->quit) {
    listen_for(s, &input, udp, s->step ? -1 : 0);
    if (s->step) {
      if (input < 0) return;
      continue;
    }
    advance(s, s->ring->now + CHUNK);
    if (o->duration > 0 && (double)s->ring->now >= o->duration * RING_FREQUENCY) return;
    if (o->speed > 0) pace(s, o->speed, &origin);
  }
}

/* ---- options ---- */

enum { SLOW = 256, SPEED, STEP, DURATION, ALIAS, UDP, BAUD };

static const struct argp_option known[] = {
    {"slow", SLOW, NULL, 0, "the UART's strap is set: 400 kBd instead of 500", 0},
    {"speed", SPEED, "X", 0, "simulated time runs X times as fast as real time (default 1; 0: as fast as it can)", 0},
    {"step", STEP, NULL, 0, "time stands still but for the command run", 0},
    {"duration", DURATION, "S", 0, "end after S simulated seconds", 0},
    {"link", ALIAS, "PATH", 0, "make PATH a symbolic link to the pseudo-terminal", 0},
    {"udp", UDP, "PORT", 0, "take commands from datagrams to 127.0.0.1:PORT too", 0},
    {"baud-matters", BAUD, NULL, 0, "send rubbish unless the host has set the UART's speed", 0},
    {0},
};

static double number(const char *text, double max, struct argp_state *state, const char *name) {
  char *end;
  double value = strtod(text, &end);
  if (end == text || *end || !(value >= 0 && value <= max))
    argp_error(state, "%s: found %s, allowed is 0 to %g", name, text, max);
  return value;
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  options *o = state->input;
  switch (key) {
  case SLOW: o->slow = true; return 0;
  case STEP: o->step = true; return 0;
  case BAUD: o->baud_matters = true; return 0;
  case ALIAS: o->alias = arg; return 0;
  case SPEED: o->speed = number(arg, 1000, state, "--speed"); return 0;
  case DURATION: o->duration = number(arg, 1e6, state, "--duration"); return 0;
  case UDP: o->udp = (int)number(arg, 65535, state, "--udp"); return 0;
  case ARGP_KEY_ARG:
    if (o->firmware) argp_error(state, "one firmware is enough");
    o->firmware = arg;
    return 0;
  case ARGP_KEY_END:
    if (!o->firmware) argp_error(state, "FIRMWARE.elf is missing");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

int main(int argc, char **argv) {
  options o = {.speed = 1};
  static char text[4096];
  snprintf(text, sizeof text,
           "Runs the proximity ring's firmware in four simulated boards and prints the name of the pseudo-terminal "
           "that is board 0's UART.\vExample:  ring_board --link /tmp/ring build/firmware/proximity_ring.elf\n\n%s",
           commands_help);
  argp_err_exit_status = 2;
  argp_parse(&(struct argp){known, parse, "FIRMWARE.elf", text, NULL, NULL, NULL}, argc, argv, 0, NULL, &o);
  struct sigaction action = {.sa_handler = stop};
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  sigaction(SIGHUP, &action, NULL);
  static session s;
  s = (session){.step = o.step,
                .terminal = {.master = -1,
                             .slave = -1,
                             .alias = o.alias,
                             .patient = o.step || o.speed == 0,
                             .baud_matters = o.baud_matters,
                             .random = 2463534242u}};
  avr_global_logger_set(quiet);
  s.ring = ring_create(o.firmware, o.slow);
  if (!s.ring || !terminal_plug(&s.terminal)) return 1;
  s.ring->sent = terminal_byte;
  s.ring->context = &s.terminal;
  printf("port %s\n", s.terminal.name);
  fflush(stdout);
  serve(&s, &o);
  terminal_unplug(&s.terminal);
  return 0;
}
