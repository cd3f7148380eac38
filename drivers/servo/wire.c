#include "servo/wire.h"

#include <math.h>

#include "servo/frame.h"

#define SPARE 1.1 /* times the exchange, to leave a tenth to spare */

/* A byte on the wire has a start bit, eight bits, a parity bit or none, and a stop bit. */
static double bits(const ethd__servo_map *map) { return map->format == 0 ? 10 : 11; }

static double time_of(const ethd__servo_map *map, uint32_t bytes, double turnaround) {
  double sum = turnaround + map->silence;
  return map->transport == ETHD__SERVO_TCP ? sum : sum + bytes * bits(map) / map->baud;
}

static uint32_t bytes_of(const ethd__servo_map *map, const ethd__servo_block *b, bool is_write) {
  ethd__servo_frame f;
  if (is_write)
    ethd__servo_frame_write(map, b->span, b->words, &f);
  else
    ethd__servo_frame_read(map, b->span, &f);
  return (uint32_t)(f.length + f.answer);
}

static uint32_t bytes_of_both(const ethd__servo_map *map, const ethd__servo_block *to, const ethd__servo_block *from) {
  ethd__servo_frame f;
  ethd__servo_frame_both(map, to->span, to->words, from->span, &f);
  return (uint32_t)(f.length + f.answer);
}

static void add(const ethd__servo_map *map, uint32_t bytes, double turnaround, ethd__servo_wire *out) {
  out->questions++;
  out->bytes += bytes;
  out->usual += time_of(map, bytes, turnaround);
}

/* The longest time that questions about slow registers add to any exchange of a whole round. */
static double slow(const ethd__servo_map *map, const ethd__servo_plan *plan, double turnaround) {
  double most = 0;
  for (uint32_t turn = 0; turn < ETHD__SERVO_EVERY_MAX; turn++) {
    double sum = 0;
    for (uint32_t i = 0; i < plan->read_count; i++) {
      const ethd__servo_block *b = &plan->reads[i];
      if (b->every > 1 && turn % b->every == b->phase) sum += time_of(map, bytes_of(map, b, false), turnaround);
    }
    most = fmax(most, sum);
  }
  return most;
}

ethd__servo_wire ethd__servo_wire_of(const ethd__servo_map *map, double turnaround) {
  static _Thread_local ethd__servo_plan plan; /* too large for a stack */
  ethd__servo_wire wire = {.questions = 0};
  double t = isnan(turnaround) ? map->turnaround : turnaround;
  ethd__servo_plan_make(map, &plan);
  for (uint32_t i = 0; i < plan.write_count; i++) {
    const ethd__servo_block *w = &plan.writes[i];
    add(map, w->with < 0 ? bytes_of(map, w, true) : bytes_of_both(map, w, &plan.reads[w->with]), t, &wire);
  }
  for (uint32_t i = 0; i < plan.read_count; i++)
    if (plan.reads[i].every == 1 && plan.reads[i].with < 0) add(map, bytes_of(map, &plan.reads[i], false), t, &wire);
  wire.most = wire.usual + slow(map, &plan, t);
  return wire;
}

uint32_t ethd__servo_divisor_for(double exchange, double period) {
  return (uint32_t)fmax(1, ceil(SPARE * exchange / period - 1e-9));
}
