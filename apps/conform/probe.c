#include "conform/probe.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "clock.h"
#include "conform/order.h"
#include "ethd/loop.h"
#include "servo/link.h"
#include "servo/wire.h"
#include "servo/words.h"
#include "text/text.h"

#define ASKS 3 /* questions, before a drive is said not to answer */

static ethd__probe_def arg;
static ethd__servo_map map;
static ethd__servo_link drive;
static ethd_histogram trip;

static void load(void) {
  char message[ETHD_MESSAGE_MAX];
  ethd__need(ethd__servo_map_load(arg.map, arg.map, &map, message), message);
  if (arg.port && strlen(arg.port) >= sizeof map.port) ethd__fail(ETHD_EXIT_INPUT, "--port: too long");
  if (arg.port) strcpy(map.port, arg.port);
}

static const char *const orders[] = {"low-first", "high-first"};

/* Returns whether the drive answers in this order of the checksum. */
static bool answers(int32_t crc) {
  static ethd__servo_map other;
  static ethd__servo_plan plan;
  char message[ETHD_MESSAGE_MAX];
  ethd__servo_bus bus;
  other = map;
  other.crc = crc;
  ethd__servo_plan_make(&other, &plan);
  ethd__must(ethd__servo_bus_open(&other, &bus, message), message);
  ethd__servo_outcome got = ETHD__SERVO_MISSING;
  for (int i = 0; i < ASKS && (got == ETHD__SERVO_MISSING || got == ETHD__SERVO_GARBLED); i++) {
    (void)!ethd__servo_bus_drain(&bus);
    got = ethd__servo_bus_read(&bus, plan.reads[0].span, plan.reads[0].words);
  }
  ethd__servo_bus_close(&bus);
  return got != ETHD__SERVO_MISSING && got != ETHD__SERVO_GARBLED && got != ETHD__SERVO_LOST;
}

/* A serial drive that answers only in the other order is measured in that one, and the map's is named. */
static void find_order(void) {
  bool heard[2];
  if (map.transport != ETHD__SERVO_RTU) return;
  for (int32_t crc = 0; crc < 2; crc++) heard[crc] = answers(crc);
  printf("%-10s low-first: %s, high-first: %s\n", "checksum", heard[0] ? "it answers" : "no answer",
         heard[1] ? "it answers" : "no answer");
  if (heard[map.crc] || !heard[!map.crc]) return;
  printf("%-10s crc = %s is needed, the map says %s; measured so\n", "mend", orders[!map.crc], orders[map.crc]);
  map.crc = !map.crc;
}

/* Connects and identifies, or gives the reason why not. */
static void reach(void) {
  const double zero[2] = {0, 0};
  ethd__servo_link_make(&map, &drive);
  ethd_status status = ethd__servo_link_connect(&drive, ethd__clock_now());
  if (status) ethd__fail(ethd__exit_code(status), "%s", drive.message);
  int64_t end = ethd__clock_now() + (int64_t)(1e9 * (map.connect + 1));
  while (drive.state == ETHD__SERVO_UP && drive.sequence >= 0 && ethd__clock_now() < end)
    (void)!ethd__servo_link_turn(&drive, ethd__clock_now(), zero);
  if (drive.state < ETHD__SERVO_IDENTIFIED) ethd__fail(ETHD_EXIT_FAILED, "%s", drive.message);
}

static ethd__position_seen seen[2];

/* Notes the joint angles just read. */
static void see(void) {
  for (int i = 0; i < 2; i++) {
    int32_t r = map.roles[ETHD__SERVO_POSITION1 + i];
    if (r >= 0) ethd__position_see(&map.registers[r], ethd__servo_plan_words(&drive.plan, &map, r), &seen[i]);
  }
}

static double measure(void) {
  const double zero[2] = {0, 0};
  int64_t begin = ethd__clock_now(), at = begin, end = begin + (int64_t)(1e9 * arg.duration);
  for (; at < end && !ethd__stop; ethd__progress((uint64_t)(at - begin), (uint64_t)(end - begin), "exchanges")) {
    ethd_status status = ethd__servo_link_turn(&drive, at, zero);
    int64_t after = ethd__clock_now();
    if (!status) ethd_histogram_add(&trip, after - at);
    if (!status) see();
    at = after;
  }
  ethd__progress(1, 1, "exchanges");
  return 1e-9 * (double)(at - begin);
}

/* ---- whether it has a watchdog ---- */

#define SILENCE 1.0 /* s, or three times what the map says */

static bool is_enabled(void) {
  for (uint32_t i = 0; i < map.count; i++) {
    const ethd__servo_register *r = &map.registers[i];
    if (r->enabled_mask && ((uint32_t)(int64_t)drive.raw[i] & r->enabled_mask) != r->enabled) return false;
  }
  return true;
}

static void turns(int32_t sequence, double seconds) {
  const double zero[2] = {0, 0};
  int64_t end = ethd__clock_now() + (int64_t)(1e9 * seconds);
  if (sequence >= 0) ethd__servo_link_begin(&drive, sequence, ethd__clock_now());
  while ((drive.sequence >= 0 || sequence < 0) && ethd__clock_now() < end)
    (void)!ethd__servo_link_turn(&drive, ethd__clock_now(), zero);
}

/* Enables at zero torque, writes nothing for a while, then reads the drive's state. */
static void try_watchdog(void) {
  double silence = fmax(SILENCE, 3 * map.watchdog_time);
  bool shows = false;
  for (uint32_t i = 0; i < map.count; i++) shows |= map.registers[i].enabled_mask != 0;
  if (!shows) ethd__fail(ETHD_EXIT_INPUT, "%s: no enabled_mask, so the drive's state can't be read", arg.map);
  turns(ETHD__SERVO_ENABLE, 30);
  if (drive.state != ETHD__SERVO_ENABLED) ethd__fail(ETHD_EXIT_FAILED, "it can't be enabled: %s", drive.message);
  turns(-1, 0.2);
  if (!is_enabled()) ethd__fail(ETHD_EXIT_FAILED, "the drive disables itself although the bus is active");
  nanosleep(&(struct timespec){(time_t)silence, (long)(1e9 * (silence - floor(silence)))}, NULL);
  drive.plan.all = true; /* slow registers, too, as they are now */
  (void)!ethd__servo_link_turn(&drive, ethd__clock_now(), (const double[2]){0, 0});
  bool let_go = !is_enabled();
  printf("%-10s %s after %g s of silence: %s; the map says %s\n", "watchdog",
         let_go ? "it is disabled" : "it is enabled still", silence, let_go ? "it has one" : "it has none",
         map.watchdog == ETHD__SERVO_WATCH_NONE ? "none" : "it has one");
  turns(ETHD__SERVO_DISABLE, 30);
}

/* ---- signs ---- */

/* Motion of the joint, in the plausible order. */
static double moved(int i) {
  const ethd__servo_register *r = &map.registers[map.roles[ETHD__SERVO_POSITION1 + i]];
  int32_t order = ethd__position_order(r, &seen[i]);
  return seen[i].moved[order != ETHD__SERVO_NO_ORDER ? order : r->order == ETHD__SERVO_LOW_FIRST];
}

static void watch_hands(void) {
  const double zero[2] = {0, 0};
  for (int i = 0; i < 2; i++) seen[i].moved[0] = seen[i].moved[1] = 0;
  printf("%-10s turn joint 1, then joint 2, so that their angles rise; %g s\n", "by hand", arg.by_hand);
  fflush(stdout);
  int64_t begin = ethd__clock_now(), end = begin + (int64_t)(1e9 * arg.by_hand), now = begin;
  for (; now < end && !ethd__stop; now = ethd__clock_now())
    if (!ethd__servo_link_turn(&drive, now, zero)) see();
  for (int i = 0; i < 2; i++)
    if (map.roles[ETHD__SERVO_POSITION1 + i] >= 0)
      printf("%-10s position%d went %+.4f rad: its sign is %s\n", "", i + 1, moved(i),
             moved(i) == 0  ? "not known, it didn't move"
             : moved(i) > 0 ? "right if its angle rose"
                            : "wrong, change it in the map, if its angle rose");
}

/* ---- the report ---- */

static void print_rate(double seconds) {
  const ethd__servo_counts *c = &drive.counts;
  double slow = 1e-9 * (double)ethd_histogram_at(&trip, 0.99);
  uint32_t reads = drive.plan.read_count;
  for (uint32_t i = 0; i < drive.plan.read_count; i++) reads -= drive.plan.reads[i].with >= 0;
  printf("%-10s %s, %u + %u question%s an exchange\n", "bus", map.port, drive.plan.write_count, reads, ethd__s(reads));
  printf("%-10s p50 %.3f  p99 %.3f  max %.3f ms, %" PRIu64 " exchange%s in %.3g s\n", "round trip",
         1e-6 * (double)ethd_histogram_at(&trip, 0.5), 1e3 * slow, 1e-6 * (double)trip.max, trip.count,
         ethd__s(trip.count), seconds);
  printf("%-10s %" PRIu64 " missing, %" PRIu64 " stale, %" PRIu64 " damaged or refused, %" PRIu64 " link%s lost\n",
         "answers", c->missing, c->stale, c->garbled + c->busy + c->refused + c->failed, c->lost, ethd__s(c->lost));
  if (!trip.count) ethd__fail(ETHD_EXIT_FAILED, "no exchange went well: %s", drive.message);
  printf("%-10s this bus can do %.0f Hz (99 %% of the exchanges; %.0f a second back to back)\n", "rate",
         floor(1 / slow), (double)trip.count / seconds);
}

/* Time on the wire by rate and bytes; the rest of the measured time is the drive's and the line driver's. */
static void print_wire(void) {
  ethd__servo_wire wire = ethd__servo_wire_of(&map, 0);
  double usual = 1e-9 * (double)ethd_histogram_at(&trip, 0.5);
  if (map.transport != ETHD__SERVO_RTU) return;
  double turnaround = fmax(0, usual - wire.usual) / wire.questions;
  printf("%-10s %u bytes in %u question%s: %.3f ms of wire and silence; turnaround %.3f ms each (the map says %g)\n",
         "wire", wire.bytes, wire.questions, ethd__s(wire.questions), 1e3 * wire.usual, 1e3 * turnaround,
         1e3 * map.turnaround);
}

/* Returns whether the map's exchanges end before the next begins. */
static void print_divisor(void) {
  double slow = 1e-9 * (double)ethd_histogram_at(&trip, 0.99);
  uint32_t needed = ethd__servo_divisor_for(slow, arg.period);
  printf("%-10s %u holds at %g ms ticks: %s", "divisor", map.divisor, 1e3 * arg.period,
         map.divisor >= needed ? "yes" : "no");
  if (map.divisor < needed)
    printf(", 99 %% of the exchanges need %.3g ms; %u would hold", 1e3 * slow, needed);
  else if (map.divisor > needed)
    printf(", and so would %u", needed);
  printf("\n");
}

static void print_values(void) {
  for (uint32_t i = 0; i < map.count; i++) {
    const ethd__servo_register *r = &map.registers[i];
    if (drive.plan.block[i] < 0 || r->direction != ETHD__SERVO_READ) continue;
    printf("%-10s %-16s raw %-12.10g %.6g", i ? "" : "values", r->name, drive.raw[i],
           r->scale * drive.raw[i] + r->offset);
    const char *unit = ethd__servo_units;
    for (int32_t k = 0; k < r->unit; k++) unit = strchr(unit, '|') + 1;
    printf(" %.*s%s\n", r->unit ? (int)strcspn(unit, "|") : 0, unit, r->unconfirmed ? "; address unconfirmed" : "");
  }
}

void ethd__probe(const ethd__probe_def *def) {
  const char *risk;
  arg = *def;
  ethd__catch_interrupt();
  load();
  find_order();
  reach();
  double seconds = measure();
  print_rate(seconds);
  if (arg.watchdog) try_watchdog();
  if (arg.by_hand > 0) watch_hands();
  print_wire();
  print_divisor();
  print_values();
  for (int i = 0; i < 2; i++)
    if (map.roles[ETHD__SERVO_POSITION1 + i] >= 0)
      ethd__position_report(&map.registers[map.roles[ETHD__SERVO_POSITION1 + i]], &seen[i]);
  uint32_t unconfirmed = ethd__servo_unconfirmed(&map);
  if (unconfirmed)
    printf("%-10s %u of %u register%s: no document confirms %s\n", "unconfirmed", unconfirmed, map.count,
           ethd__s(map.count), unconfirmed == 1 ? "its address" : "their addresses");
  for (uint32_t i = 0; (risk = ethd__servo_risk(&map, i)); i++) printf("%-10s %s\n", i ? "" : "open risk", risk);
  ethd__servo_link_close(&drive);
}
