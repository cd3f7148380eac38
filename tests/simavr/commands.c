#include "commands.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char commands_help[] =
    "Lines on stdin, or datagrams with --udp:\n"
    "  C0 C1 .. C15            what the 16 sensors see from now on, 0 to 65535\n"
    "  step, pace              time stands still but for run (as with --step); goes on by itself\n"
    "  run SECONDS             after step: let that much time pass\n"
    "  mute K, unmute K        sensor K loses its supply, has it again\n"
    "  short K, unshort K      sensor K's SDA lies at ground\n"
    "  slow K, unslow K        sensor K takes 2 ms to measure\n"
    "  stick K N               sensor K holds SDA low for N clocks\n"
    "  scl B, unscl B          SCL of board B's sensors lies at ground\n"
    "  deaf B, undeaf B        the start line doesn't reach board B\n"
    "  link-short, link-free   SDA between the boards lies at ground\n"
    "  link-corrupt N          the next N bytes between the boards go over wrongly\n"
    "  reset B, hang B         board B's reset; its program hangs\n"
    "  corrupt N, lose N             the next N bytes on the wire to the host\n"
    "  unplug, plug            the pseudo-terminal goes; a new one comes (its name is printed)\n"
    "  stats                   what was measured since the last time\n"
    "  quit\n";

static bool counts(session *s, const char *line) {
  uint16_t level[RING_SENSORS];
  char *end;
  for (int k = 0; k < RING_SENSORS; k++, line = end) {
    unsigned long value = strtoul(line, &end, 10);
    if (end == line || value > 0xFFFF) return false;
    level[k] = (uint16_t)value;
  }
  if (line[strspn(line, " \t\r")]) return false;
  for (int k = 0; k < RING_SENSORS; k++) s->ring->board[k / RING_LANES].sensor[k % RING_LANES].level = level[k];
  return true;
}

/* ---- stats ---- */

static void show(const char *name, const ring_range *range, double scale) {
  double mean = range->count ? (double)range->sum / (double)range->count : 0;
  printf("%s %.4f %.4f %.4f %llu\n", name, (double)range->min * scale, (double)range->max * scale, mean * scale,
         (unsigned long long)range->count);
}

static void stats(session *s) {
  ring *r = s->ring;
  const bus_times *t = &r->times;
  const double us = 1e6 / RING_FREQUENCY, ns = 1e9 / RING_FREQUENCY;
  double time = (double)r->now / RING_FREQUENCY;
  printf("time_s %.6f\nspeed %.2f\nbaud %.0f\n", time, s->wall > 0 ? time / s->wall : 0, ring_baud(r));
  show("period_cycles", &r->period, 1);
  for (int lane = 0; lane < RING_LANES; lane++) {
    char name[16];
    snprintf(name, sizeof name, "begin%d_us", lane);
    show(name, &r->begin[lane], us);
  }
  show("last_byte_us", &r->last_byte, us);
  printf("put_us %.3f %.3f\nget_us %.3f %.3f\n", (double)t->put_min * us, (double)t->put_max * us,
         (double)t->get_min * us, (double)t->get_max * us);
  printf("scl_low_ns %.0f\nscl_high_ns %.0f\nscl_bit_ns %.0f\nhurried %llu\n", (double)t->low_min * ns,
         (double)t->high_min * ns, (double)t->bit_min * ns, (unsigned long long)t->hurried);
  for (int n = 0; n < RING_BOARDS; n++) printf("awake%d %.4f\n", n, (double)r->board[n].awake / (double)r->now);
  printf("faced %llu\n", (unsigned long long)r->faced);
  printf("link_bytes %llu\nlink_recoveries %llu\nsent_bytes %llu\nlost_bytes %llu\nend\n",
         (unsigned long long)r->link.bytes, (unsigned long long)r->link.recoveries,
         (unsigned long long)s->terminal.sent, (unsigned long long)s->terminal.lost);
  r->period = r->last_byte = (ring_range){0};
  memset(r->begin, 0, sizeof r->begin);
  r->times = (bus_times){0};
}

/* ---- commands with and without a number ---- */

static sensor *sensor_of(session *s, int k) { return &s->ring->board[k / RING_LANES].sensor[k % RING_LANES]; }

static void mute(session *s, int k) { sensor_of(s, k)->mute = true; }
static void unmute(session *s, int k) {
  sensor_of(s, k)->mute = false;
  sensor_power(sensor_of(s, k), k, &s->ring->times);
}
static void shorten(session *s, int k) { sensor_of(s, k)->shorted = true; }
static void unshorten(session *s, int k) { sensor_of(s, k)->shorted = false; }
static void slow(session *s, int k) { sensor_of(s, k)->slow = true; }
static void unslow(session *s, int k) { sensor_of(s, k)->slow = false; }
static void deaf(session *s, int b) { s->ring->board[b].deaf = true; }
static void undeaf(session *s, int b) { s->ring->board[b].deaf = false; }
static void link_corrupt(session *s, int n) { s->ring->link.corrupt = n; }
static void scl(session *s, int b) { s->ring->board[b].scl_shorted = true; }
static void unscl(session *s, int b) { s->ring->board[b].scl_shorted = false; }
static void reset(session *s, int b) { ring_reset(s->ring, b); }
static void hang(session *s, int b) { ring_hang(s->ring, b); }
static void corrupt(session *s, int n) { s->terminal.corrupt = n; }
static void lose(session *s, int n) { s->terminal.lose = n; }
static void link_short(session *s, int n) { s->ring->link.shorted = n == 0; }
static void link_free(session *s, int n) { s->ring->link.shorted = n != 0; }
static void show_stats(session *s, int n) { (void)n, stats(s); }
static void step(session *s, int n) { (void)n, s->step = s->terminal.patient = true; }
static void pace(session *s, int n) { (void)n, s->step = s->terminal.patient = false; }
static void quit(session *s, int n) { (void)n, s->quit = true; }
static void unplug(session *s, int n) { (void)n, terminal_unplug(&s->terminal); }
static void plug(session *s, int n) {
  (void)n;
  if (terminal_plug(&s->terminal)) printf("port %s\n", s->terminal.name);
}

static const struct {
  const char *name;
  int end; /* its number is below that; 0: it has none */
  void (*act)(session *s, int number);
} table[] = {
    {"mute", RING_SENSORS, mute},
    {"unmute", RING_SENSORS, unmute},
    {"short", RING_SENSORS, shorten},
    {"unshort", RING_SENSORS, unshorten},
    {"slow", RING_SENSORS, slow},
    {"unslow", RING_SENSORS, unslow},
    {"deaf", RING_BOARDS, deaf},
    {"undeaf", RING_BOARDS, undeaf},
    {"link-corrupt", 1000000000, link_corrupt},
    {"scl", RING_BOARDS, scl},
    {"unscl", RING_BOARDS, unscl},
    {"reset", RING_BOARDS, reset},
    {"hang", RING_BOARDS, hang},
    {"corrupt", 1000000000, corrupt},
    {"lose", 1000000000, lose},
    {"link-short", 0, link_short},
    {"link-free", 0, link_free},
    {"unplug", 0, unplug},
    {"plug", 0, plug},
    {"stats", 0, show_stats},
    {"step", 0, step},
    {"pace", 0, pace},
    {"quit", 0, quit},
};

static bool stick(session *s, const char *line) {
  int k, clocks;
  if (sscanf(line, "stick %d %d", &k, &clocks) != 2 || k < 0 || k >= RING_SENSORS) return false;
  sensor_of(s, k)->stuck = clocks;
  return true;
}

static bool named(session *s, const char *line) {
  char name[16];
  int number = 0;
  int fields = sscanf(line, "%15s %d", name, &number);
  for (size_t n = 0; n < sizeof table / sizeof *table; n++) {
    if (fields < 1 || strcmp(name, table[n].name)) continue;
    if (table[n].end && (fields < 2 || number < 0 || number >= table[n].end)) return false;
    table[n].act(s, number);
    return true;
  }
  return false;
}

bool command(session *s, const char *line, const char **why) {
  *why = "see --help for the commands";
  if (!strncmp(line, "run ", 4)) {
    *why = "run SECONDS needs step and 0 to 3600 s";
    double seconds = strtod(line + 4, NULL);
    if (!s->step || !(seconds >= 0 && seconds <= 3600)) return false;
    s->run = seconds;
    return true;
  }
  bool done;
  if (line[0] >= '0' && line[0] <= '9') {
    *why = "16 counts, each 0 to 65535, belong on a line";
    done = counts(s, line);
  } else {
    done = stick(s, line) || named(s, line);
  }
  ring_touch(s->ring);
  return done;
}
