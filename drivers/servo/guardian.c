/* The guardian's actions. Its process is in guardian_process.c. */
#include "servo/guardian.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "device/container.h"
#include "servo/bus_parts.h"
#include "servo/words.h"
#include "text/error_text.h"

#define LEAST 20000000 /* ns */
#define SHARE \
  0.6 /* of the bound may pass in silence; the rest is for noticing it, for a quiet line, and for the message */
#define TRIES 5

int64_t ethd__guardian_bound(const ethd__servo_map *map, int64_t exchange_ns) {
  int64_t unanswered = (int64_t)(1e9 * (map->response + map->drain));
  int64_t spacing = exchange_ns > unanswered ? exchange_ns : unanswered;
  return 2 * spacing > LEAST ? 2 * spacing : LEAST;
}

/* ---- what can end both processes ---- */

const char *ethd__guardian_ends(void) {
  switch (ethd__container_depth()) {
  case 0:
    return "this program is the first process (PID 1) of its container, and the guardian would end with it: docker run "
           "--init or --pid=host, a drive with a watchdog, or device.unguarded = yes";
  case 1:
    return "PID 1 of the container ends with this program, and the guardian with both: start the program by a shell "
           "that stays (sh -c 'PROGRAM; sleep 1'), docker run --pid=host, a drive with a watchdog, or device.unguarded "
           "= yes";
  default: return NULL;
  }
}

void ethd__guardian_limits(const char *root, bool spared, char out[ETHD_MESSAGE_MAX]) {
  const char *container = ethd__in_container() ? "; not when the container is killed (docker kill)" : "";
  const char *memory = !spared && ethd__group_dies_whole(root)
                           ? "; not when memory runs out: memory.oom.group is 1, which kills both"
                           : "";
  const char *service = ethd__group_is_service(root) ? "; not in a service with KillMode=mixed, which kills both" : "";
  ethd__say(out, ETHD_OK, "%s%s%s", container, memory, service);
}

/* ---- frames ---- */

static void make_zeros(const ethd__servo_plan *plan, ethd__guardian *g) {
  ethd__servo_plan zero = *plan;
  for (int i = 0; i < 2; i++) {
    int32_t r = g->map->roles[ETHD__SERVO_TORQUE1 + i];
    if (r < 0) continue;
    const ethd__servo_register *torque = &g->map->registers[r];
    ethd__servo_pack(torque, ethd__servo_raw(torque, 0), ethd__servo_plan_words(&zero, g->map, r));
  }
  for (uint32_t i = 0; i < zero.write_count; i++)
    ethd__servo_frame_write(g->map, zero.writes[i].span, zero.writes[i].words, &g->zeros[i]);
  g->zero_count = zero.write_count;
}

static void make_disables(ethd__guardian *g) {
  const ethd__servo_steps *steps = &g->map->sequences[ETHD__SERVO_DISABLE];
  for (uint32_t i = 0; i < steps->count; i++) {
    uint16_t words[2];
    const ethd__servo_step *s = &steps->at[i];
    if (s->kind != ETHD__SERVO_STEP_WRITE) continue;
    const ethd__servo_register *r = &g->map->registers[s->at];
    ethd__servo_pack(r, s->value, words);
    ethd__servo_frame_write(g->map, ethd__servo_span_of(r), words, &g->disables[g->disable_count++]);
  }
}

void ethd__guardian_make(const ethd__servo_map *map, const ethd__servo_plan *plan, int64_t exchange_ns,
                         ethd__guardian *out) {
  memset(out, 0, sizeof *out);
  out->map = map;
  out->socket = out->line = -1;
  out->limit_ns = (int64_t)(SHARE * (double)ethd__guardian_bound(map, exchange_ns));
  make_zeros(plan, out);
  make_disables(out);
}

/* ---- the I/O thread's side ---- */

void ethd__guardian_arm(ethd__guardian *g, bool armed) {
  if (g->page) atomic_store(&g->page->armed, armed);
}

bool ethd__guardian_due(const ethd__guardian *g, int64_t now_ns) {
  return atomic_load(&g->page->armed) && now_ns - atomic_load(&g->page->beat_ns) > g->limit_ns;
}

/* ---- acting ---- */

/* Waits until nothing has come for `drain`, at most ten times that: on a serial line an answer to the silent program
   may still be under way. A connection needs no such wait, because its messages have numbers. */
static void quiet(const ethd__servo_bus *bus) {
  if (bus->map->transport == ETHD__SERVO_RTU) (void)!ethd__servo_bus_drain((ethd__servo_bus *)bus);
}

/* Each frame goes out once before any is tried again: a unit that is gone doesn't keep the others waiting. */
static bool send(const ethd__servo_bus *bus, const ethd__servo_frame *frames, uint32_t count) {
  uint32_t left = (1u << count) - 1; /* a bit a frame */
  for (int k = 0; k < TRIES && left; k++)
    for (uint32_t i = 0; i < count; i++) {
      if (!(left & 1u << i)) continue;
      if (ethd__servo_ask(bus, &frames[i], NULL))
        quiet(bus);
      else
        left &= ~(1u << i);
    }
  return !left;
}

bool ethd__guardian_act(ethd__guardian *g) {
  int ours = ETHD__GUARDIAN_OURS;
  if (!atomic_compare_exchange_strong(&g->page->line, &ours, ETHD__GUARDIAN_ITS)) return false;
  const ethd__servo_bus bus = {.map = g->map, .fd = g->line};
  bool good = g->line >= 0;
  if (good) {
    quiet(&bus);
    good = send(&bus, g->zeros, g->zero_count);
    for (uint32_t i = 0; i < g->disable_count; i++) good &= send(&bus, &g->disables[i], 1);
  }
  if (g->line >= 0) close(g->line);
  g->line = -1;
  atomic_fetch_add(&g->page->acts, 1);
  atomic_store(&g->page->armed, 0);
  atomic_store(&g->page->line, ETHD__GUARDIAN_FREE);
  return good;
}
