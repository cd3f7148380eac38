#include "study/order.h"

#include "study/people.h"

enum { CELLS = ETHD_STUDY_CONDITIONS };

/* Within each speed, in the order of the conditions, rotated by one for each participant. */
static void paper(const ethd__protocol *p, uint32_t participant, size_t cell[CELLS]) {
  size_t n = 0;
  for (size_t speed = 0; speed < p->speeds.count; speed++) {
    size_t here[CELLS], count = 0;
    for (size_t i = 0; i < p->condition_count; i++)
      if (p->condition[i].speed == speed) here[count++] = i;
    for (size_t i = 0; i < count; i++) cell[n++] = here[(participant + 1 + i) % count];
  }
}

/* A permutation of 0 .. count-1 by the study's seed and a stream: a participant's own, or one that DRAW gives. */
#define DRAW(number) (UINT32_MAX - (number))
static void permutation(uint64_t seed, uint32_t stream, size_t count, size_t *out) {
  for (size_t i = 0; i < count; i++) out[i] = i;
  for (size_t i = count; i-- > 1;) {
    size_t j = ethd__person_below(seed, stream, (uint32_t)i, (uint32_t)i + 1), other = out[j];
    out[j] = out[i];
    out[i] = other;
  }
}

/* The square's row: 0, 1, n-1, 2, n-2, .. plus the row; an odd n needs the mirror images too. A number stands for
   strategy * speeds + speed, so that going down `speeds` rows rotates the strategies within each speed: each is also
   first and last at a speed equally often. The seed assigns strategies and speeds to numbers, and rows to
   participants. */
static size_t condition_of(const ethd__protocol *p, size_t strategy, size_t speed) {
  size_t i = 0;
  while (p->condition[i].strategy != strategy || p->condition[i].speed != speed) i++;
  return i;
}

static void latin(const ethd__protocol *p, size_t count, uint32_t participant, size_t cell[CELLS]) {
  size_t strategies = p->strategies.count, speeds = p->speeds.count, rows = count % 2 ? 2 * count : count;
  size_t strategy[CELLS * 2], speed[CELLS * 2], line[CELLS * 2], any[CELLS * 2];
  bool all = count == strategies * speeds;
  permutation(p->seed, DRAW(0), strategies, strategy);
  permutation(p->seed, DRAW(1), speeds, speed);
  if (!all) permutation(p->seed, DRAW(0), count, any);
  permutation(p->seed, DRAW(2 + participant / (uint32_t)rows), rows, line);
  size_t row = line[participant % rows];
  for (size_t i = 0; i < count; i++) {
    size_t step = i % 2 ? (i + 1) / 2 : (count - i / 2) % count, number = (step + row) % count;
    cell[row >= count ? count - 1 - i : i] =
        all ? condition_of(p, strategy[number / speeds], speed[number % speeds]) : any[number];
  }
}

static size_t last_at(const ethd__protocol *p, const size_t cell[CELLS], size_t speed) {
  size_t last = 0;
  for (size_t i = 0; i < p->condition_count; i++)
    if (p->condition[cell[i]].speed == speed) last = p->condition[cell[i]].strategy;
  return last;
}

uint32_t ethd__block_taps(const ethd__protocol *p) { return p->order == ETHD_ORDER_INTERLEAVED ? 1 : p->taps; }

uint32_t ethd__block_attempts(const ethd__protocol *p) {
  return p->order == ETHD_ORDER_INTERLEAVED ? (p->attempts + p->taps - 1) / p->taps : p->attempts;
}

static ethd__study_block test_of(const ethd__protocol *p, size_t cell, uint32_t round) {
  return (ethd__study_block){false, p->condition[cell].strategy, p->condition[cell].speed, round};
}

static size_t interleaved(const ethd__protocol *p, size_t count, uint32_t participant, ethd__study_block *out) {
  size_t cell[CELLS], n = 0;
  latin(p, count, (participant + 1) * p->taps - 1, cell);
  for (size_t speed = 0; p->training && speed < p->speeds.count; speed++)
    out[n++] = (ethd__study_block){true, last_at(p, cell, speed), speed, 0};
  for (uint32_t round = 0; round < p->taps; round++) {
    latin(p, count, participant * p->taps + round, cell);
    for (size_t i = 0; i < count; i++) out[n++] = test_of(p, cell[i], round);
  }
  return n;
}

size_t ethd__order_of(const ethd__protocol *protocol, uint32_t participant, ethd__study_block out[ETHD_STUDY_BLOCKS]) {
  size_t cell[CELLS], n = 0, count = protocol->condition_count;
  bool trained[ETHD_STUDY_WORDS] = {false};
  if (protocol->order == ETHD_ORDER_INTERLEAVED) return interleaved(protocol, count, participant, out);
  if (protocol->order == ETHD_ORDER_PAPER)
    paper(protocol, participant, cell);
  else if (protocol->order == ETHD_ORDER_RANDOM)
    permutation(protocol->seed, participant, count, cell);
  else
    latin(protocol, count, participant, cell);
  for (size_t i = 0; i < count; i++) {
    const ethd__study_block test = test_of(protocol, cell[i], 0);
    if (protocol->training && !trained[test.speed])
      out[n++] = (ethd__study_block){true, last_at(protocol, cell, test.speed), test.speed, 0};
    trained[test.speed] = true;
    out[n++] = test;
  }
  return n;
}
