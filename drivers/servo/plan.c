#include "servo/plan.h"

#include <string.h>

#include "servo/words.h"

/* Finds the next cyclic register of this direction and pace in the order of (space, address, number); -1: none. */
static int32_t next(const ethd__servo_map *map, int32_t direction, uint32_t every, int64_t after) {
  int32_t best = -1;
  int64_t best_key = INT64_MAX;
  for (uint32_t i = 0; i < map->count; i++) {
    const ethd__servo_register *r = &map->registers[i];
    int64_t key = ((int64_t)r->space << 32 | r->address) << 8 | i;
    if (!r->cyclic || r->direction != direction || r->every != every || key <= after || key >= best_key) continue;
    best = (int32_t)i;
    best_key = key;
  }
  return best;
}

static bool joins(const ethd__servo_map *map, const ethd__servo_block *b, const ethd__servo_register *r, uint32_t gap,
                  uint32_t most) {
  if (b->space != r->space) return false;
  if (map->addressing == ETHD__SERVO_BY_VALUE) return b->address == r->address;
  return r->address <= b->address + b->count + gap && r->address + ethd__servo_words(r) - b->address <= most;
}

/* True when exchanges come in which both questions are due. */
static bool meet(const ethd__servo_block *a, uint32_t every, uint32_t phase) {
  uint32_t common = every;
  for (uint32_t rest = a->every; rest;) {
    uint32_t next_rest = common % rest;
    common = rest;
    rest = next_rest;
  }
  return a->phase % common == phase % common;
}

/* The phase in which a slow question meets the fewest of those before it. */
static uint32_t spread(const ethd__servo_block *blocks, uint32_t n, uint32_t every) {
  uint32_t best = 0, least = UINT32_MAX;
  for (uint32_t phase = 0; phase < every; phase++) {
    uint32_t met = 0;
    for (uint32_t i = 0; i < n; i++) met += meet(&blocks[i], every, phase);
    if (met < least) best = phase, least = met;
  }
  return best;
}

/* Appends blocks to the first n of them and returns their new number. */
static uint32_t arrange(const ethd__servo_map *map, int32_t direction, uint32_t every, uint32_t n,
                        ethd__servo_plan *out) {
  ethd__servo_block *blocks = direction == ETHD__SERVO_READ ? out->reads : out->writes;
  uint32_t first = n, gap = direction == ETHD__SERVO_READ ? map->gap : 0;
  uint32_t most = direction == ETHD__SERVO_READ ? ETHD__SERVO_READ_MAX : ETHD__SERVO_WRITE_MAX;
  for (int64_t after = -1;;) {
    int32_t i = next(map, direction, every, after);
    if (i < 0) return n;
    const ethd__servo_register *r = &map->registers[i];
    after = ((int64_t)r->space << 32 | r->address) << 8 | i;
    if (n == first || !joins(map, &blocks[n - 1], r, gap, most)) {
      blocks[n] = (ethd__servo_block){.space = r->space, .address = r->address, .every = every};
      blocks[n].phase = spread(blocks, n, every);
      n++;
    }
    ethd__servo_block *b = &blocks[n - 1];
    out->block[i] = (int32_t)n - 1;
    out->offset[i] = r->address - b->address;
    uint32_t end = out->offset[i] + ethd__servo_words(r);
    if (end > b->count) b->count = end;
  }
}

void ethd__servo_plan_make(const ethd__servo_map *map, ethd__servo_plan *out) {
  memset(out, 0, sizeof *out);
  memset(out->block, -1, sizeof out->block);
  out->all = true;
  out->write_count = arrange(map, ETHD__SERVO_WRITE, 1, 0, out);
  for (uint32_t every = 1; every <= ETHD__SERVO_EVERY_MAX; every++)
    out->read_count = arrange(map, ETHD__SERVO_READ, every, out->read_count, out);
  out->combined = map->exchange == ETHD__SERVO_COMBINED && out->reads[0].space == ETHD__SERVO_HOLDING;
}

uint16_t *ethd__servo_plan_words(ethd__servo_plan *plan, const ethd__servo_map *map, int32_t r) {
  ethd__servo_block *blocks = map->registers[r].direction == ETHD__SERVO_WRITE ? plan->writes : plan->reads;
  return &blocks[plan->block[r]].words[plan->offset[r]];
}

bool ethd__servo_plan_fresh(const ethd__servo_plan *plan, int32_t r) { return plan->reads[plan->block[r]].fresh; }

int64_t ethd__servo_plan_asked(const ethd__servo_plan *plan, int32_t r) { return plan->reads[plan->block[r]].asked_ns; }

/* Marks the reads that are due in this exchange. */
static void choose(ethd__servo_plan *plan) {
  for (uint32_t i = 0; i < plan->read_count; i++)
    plan->reads[i].fresh = plan->all || plan->turn % plan->reads[i].every == plan->reads[i].phase;
  plan->turn++;
}

ethd__servo_outcome ethd__servo_plan_ask(ethd__servo_plan *plan, ethd__servo_bus *bus) {
  ethd__servo_outcome done = ETHD__SERVO_DONE;
  uint32_t joined = plan->combined;
  choose(plan);
  for (uint32_t i = joined; i < plan->write_count && !done; i++)
    done = ethd__servo_bus_write(bus, plan->writes[i].address, plan->writes[i].count, plan->writes[i].words);
  if (joined && !done)
    done = ethd__servo_bus_both(bus, plan->writes[0].address, plan->writes[0].count, plan->writes[0].words,
                                plan->reads[0].address, plan->reads[0].count, plan->reads[0].words);
  if (joined) plan->reads[0].asked_ns = bus->asked_ns;
  for (uint32_t i = joined; i < plan->read_count && !done; i++)
    if (plan->reads[i].fresh) {
      done = ethd__servo_bus_read(bus, plan->reads[i].space, plan->reads[i].address, plan->reads[i].count,
                                  plan->reads[i].words);
      plan->reads[i].asked_ns = bus->asked_ns;
    }
  if (!done) plan->all = false;
  return done;
}
