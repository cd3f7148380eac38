#include "study/order.h"

#include "study/people.h"

enum { CELLS = ETHD_STUDY_WORDS * ETHD_STUDY_WORDS };

static void paper(size_t strategies, size_t count, uint32_t participant, size_t cell[CELLS]) {
  for (size_t i = 0; i < count; i++) cell[i] = i / strategies * strategies + (participant + 1 + i) % strategies;
}

static void shuffled(const ethd__protocol *protocol, size_t count, uint32_t participant, size_t cell[CELLS]) {
  for (size_t i = 0; i < count; i++) cell[i] = i;
  for (size_t i = count; i-- > 1;) {
    size_t j = ethd__person_below(protocol->seed, participant, (uint32_t)i, (uint32_t)i + 1), other = cell[j];
    cell[j] = cell[i];
    cell[i] = other;
  }
}

/* A permutation of 0 .. count-1 by the study's seed; `draw` tells one from another. */
static void permutation(uint64_t seed, uint32_t draw, size_t count, size_t out[CELLS * 2]) {
  for (size_t i = 0; i < count; i++) out[i] = i;
  for (size_t i = count; i-- > 1;) {
    size_t j = ethd__person_below(seed, UINT32_MAX - draw, (uint32_t)i, (uint32_t)i + 1), other = out[j];
    out[j] = out[i];
    out[i] = other;
  }
}

/* The square's row: 0, 1, n-1, 2, n-2, .. plus the row; an odd n needs the mirror images too. A number stands for
   strategy * speeds + speed, so that going down `speeds` rows turns strategies round within each speed: each is first
   and last at a speed equally often, too. The seed says which strategy and speed a number means, and which row is
   whose. */
static void latin(const ethd__protocol *p, size_t count, uint32_t participant, size_t cell[CELLS]) {
  size_t strategies = p->strategies.count, speeds = p->speeds.count, rows = count % 2 ? 2 * count : count;
  size_t strategy[CELLS * 2], speed[CELLS * 2], line[CELLS * 2];
  permutation(p->seed, 0, strategies, strategy);
  permutation(p->seed, 1, speeds, speed);
  permutation(p->seed, 2 + participant / (uint32_t)rows, rows, line);
  size_t row = line[participant % rows];
  for (size_t i = 0; i < count; i++) {
    size_t step = i % 2 ? (i + 1) / 2 : (count - i / 2) % count, number = (step + row) % count;
    cell[row >= count ? count - 1 - i : i] = speed[number % speeds] * strategies + strategy[number / speeds];
  }
}

static size_t last_at(size_t strategies, const size_t cell[CELLS], size_t count, size_t speed) {
  size_t last = 0;
  for (size_t i = 0; i < count; i++)
    if (cell[i] / strategies == speed) last = cell[i];
  return last % strategies;
}

uint32_t ethd__block_taps(const ethd__protocol *p) { return p->order == ETHD_ORDER_INTERLEAVED ? 1 : p->taps; }

uint32_t ethd__block_attempts(const ethd__protocol *p) {
  return p->order == ETHD_ORDER_INTERLEAVED ? (p->attempts + p->taps - 1) / p->taps : p->attempts;
}

static size_t interleaved(const ethd__protocol *p, size_t count, uint32_t participant, ethd__study_block *out) {
  size_t cell[CELLS], n = 0, strategies = p->strategies.count;
  latin(p, count, (participant + 1) * p->taps - 1, cell);
  for (size_t speed = 0; p->training && speed < p->speeds.count; speed++)
    out[n++] = (ethd__study_block){true, last_at(strategies, cell, count, speed), speed, 0};
  for (uint32_t round = 0; round < p->taps; round++) {
    latin(p, count, participant * p->taps + round, cell);
    for (size_t i = 0; i < count; i++)
      out[n++] = (ethd__study_block){false, cell[i] % strategies, cell[i] / strategies, round};
  }
  return n;
}

size_t ethd__order_of(const ethd__protocol *protocol, uint32_t participant, ethd__study_block out[ETHD_STUDY_BLOCKS]) {
  size_t cell[CELLS], n = 0, strategies = protocol->strategies.count;
  size_t count = strategies * protocol->speeds.count;
  bool trained[ETHD_STUDY_WORDS] = {false};
  if (protocol->order == ETHD_ORDER_INTERLEAVED) return interleaved(protocol, count, participant, out);
  if (protocol->order == ETHD_ORDER_PAPER)
    paper(strategies, count, participant, cell);
  else if (protocol->order == ETHD_ORDER_RANDOM)
    shuffled(protocol, count, participant, cell);
  else
    latin(protocol, count, participant, cell);
  for (size_t i = 0; i < count; i++) {
    size_t speed = cell[i] / strategies;
    if (protocol->training && !trained[speed])
      out[n++] = (ethd__study_block){true, last_at(strategies, cell, count, speed), speed, 0};
    trained[speed] = true;
    out[n++] = (ethd__study_block){false, cell[i] % strategies, speed, 0};
  }
  return n;
}
