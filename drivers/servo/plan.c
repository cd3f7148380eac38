#include "servo/plan.h"

#include <string.h>

#include "servo/words.h"

/* Registers stand in the order of unit, space, address and number. */
static int64_t key_of(const ethd__servo_map *map, uint32_t i) {
  const ethd__servo_register *r = &map->registers[i];
  return ((int64_t)r->bus_unit << 33 | (int64_t)r->space << 32 | r->address) << 8 | i;
}

/* Finds the next cyclic register of this direction and pace in that order; -1: none. */
static int32_t next(const ethd__servo_map *map, int32_t direction, uint32_t every, int64_t after) {
  int32_t best = -1;
  int64_t best_key = INT64_MAX;
  for (uint32_t i = 0; i < map->count; i++) {
    const ethd__servo_register *r = &map->registers[i];
    int64_t key = key_of(map, i);
    if (!r->cyclic || r->direction != direction || r->every != every || key <= after || key >= best_key) continue;
    best = (int32_t)i;
    best_key = key;
  }
  return best;
}

static bool joins(const ethd__servo_map *map, const ethd__servo_block *b, const ethd__servo_register *r, uint32_t gap,
                  uint32_t most) {
  const ethd__servo_span *s = &b->span;
  if (s->unit != r->bus_unit || s->space != r->space) return false;
  if (map->addressing == ETHD__SERVO_BY_VALUE) return s->address == r->address;
  return r->address <= s->address + s->count + gap && r->address + ethd__servo_words(r) - s->address <= most;
}

/* True when both questions fall due in the same exchange. */
static bool meet(const ethd__servo_block *a, uint32_t every, uint32_t phase) {
  uint32_t common = every;
  for (uint32_t rest = a->every; rest;) {
    uint32_t next_rest = common % rest;
    common = rest;
    rest = next_rest;
  }
  return a->phase % common == phase % common;
}

/* The phase that puts a slow question on the fewest exchanges of earlier ones. */
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
    after = key_of(map, (uint32_t)i);
    if (n == first || !joins(map, &blocks[n - 1], r, gap, most)) {
      blocks[n] = (ethd__servo_block){.span = {r->bus_unit, r->space, r->address, 0}, .with = -1, .every = every};
      blocks[n].phase = spread(blocks, n, every);
      n++;
    }
    ethd__servo_block *b = &blocks[n - 1];
    out->block[i] = (int32_t)n - 1;
    out->offset[i] = r->address - b->span.address;
    uint32_t end = out->offset[i] + ethd__servo_words(r);
    if (end > b->span.count) b->span.count = end;
  }
}

/* Makes the last write and the first read of each unit one question: the read may be an echo of the writes. */
static void combine(ethd__servo_plan *p) {
  for (uint32_t w = 0; w < p->write_count; w++) {
    uint32_t unit = p->writes[w].span.unit, r = 0;
    if (w + 1 < p->write_count && p->writes[w + 1].span.unit == unit) continue;
    while (r < p->read_count && p->reads[r].span.unit != unit) r++;
    if (r == p->read_count || p->reads[r].span.space != ETHD__SERVO_HOLDING || p->reads[r].every > 1) continue;
    p->writes[w].with = (int32_t)r;
    p->reads[r].with = (int32_t)w;
  }
}

void ethd__servo_plan_make(const ethd__servo_map *map, ethd__servo_plan *out) {
  memset(out, 0, sizeof *out);
  memset(out->block, -1, sizeof out->block);
  out->all = true;
  out->write_count = arrange(map, ETHD__SERVO_WRITE, 1, 0, out);
  for (uint32_t every = 1; every <= ETHD__SERVO_EVERY_MAX; every++)
    out->read_count = arrange(map, ETHD__SERVO_READ, every, out->read_count, out);
  if (map->exchange == ETHD__SERVO_COMBINED) combine(out);
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

static ethd__servo_outcome ask_write(ethd__servo_plan *plan, ethd__servo_bus *bus, const ethd__servo_block *w) {
  if (w->with < 0) return ethd__servo_bus_write(bus, w->span, w->words);
  ethd__servo_block *r = &plan->reads[w->with];
  ethd__servo_outcome done = ethd__servo_bus_both(bus, w->span, w->words, r->span, r->words);
  r->asked_ns = bus->asked_ns;
  return done;
}

/* The first write to the unit behind that of write `at`; 0 where there is but one. */
static uint32_t behind(const ethd__servo_plan *plan, uint32_t at) {
  uint32_t next_unit = at;
  while (next_unit < plan->write_count && plan->writes[next_unit].span.unit == plan->writes[at].span.unit) next_unit++;
  return next_unit % plan->write_count;
}

ethd__servo_outcome ethd__servo_plan_ask(ethd__servo_plan *plan, ethd__servo_bus *bus) {
  ethd__servo_outcome done = ETHD__SERVO_DONE;
  uint32_t first = plan->first;
  choose(plan);
  plan->first = 0;
  for (uint32_t i = 0; i < plan->write_count && !done; i++) {
    uint32_t at = (first + i) % plan->write_count;
    done = ask_write(plan, bus, &plan->writes[at]);
    if (done) plan->first = behind(plan, at);
  }
  for (uint32_t i = 0; i < plan->read_count && !done; i++) {
    ethd__servo_block *r = &plan->reads[i];
    if (!r->fresh || r->with >= 0) continue;
    done = ethd__servo_bus_read(bus, r->span, r->words);
    r->asked_ns = bus->asked_ns;
  }
  if (!done) plan->all = false;
  for (uint32_t i = 0; done && i < plan->read_count; i++) plan->reads[i].fresh = false;
  return done;
}
