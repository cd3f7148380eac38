#include "study/plan.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "study/columns.h"
#include "text/text.h"

#define FARTHEST 4 /* times the cells: bound of the search for another number of participants */

/* Counts of each strategy's place at a speed, first, last and after each other one, among the first participants. In
   interleaved trials, in a round. */
typedef struct balance {
  uint32_t first[ETHD_STUDY_WORDS][ETHD_STUDY_WORDS], last[ETHD_STUDY_WORDS][ETHD_STUDY_WORDS]; /* [speed][strategy] */
  uint32_t behind[ETHD_STUDY_WORDS][ETHD_STUDY_WORDS][ETHD_STUDY_WORDS]; /* [speed][before][strategy] */
} balance;

/* ---- counting ---- */

static void end_round(const ethd__protocol *p, const size_t *before, bool *begun, balance *b) {
  for (size_t speed = 0; speed < p->speeds.count; speed++) b->last[speed][before[speed]]++;
  memset(begun, 0, p->speeds.count * sizeof *begun);
}

static void count_person(const ethd__protocol *p, uint32_t person, balance *b) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  size_t count = ethd__order_of(p, person, blocks), before[ETHD_STUDY_WORDS];
  bool begun[ETHD_STUDY_WORDS] = {false};
  for (size_t i = 0; i < count; i++) {
    size_t speed = blocks[i].speed, strategy = blocks[i].strategy;
    if (blocks[i].training) continue;
    if (i && blocks[i].round != blocks[i - 1].round) end_round(p, before, begun, b);
    if (begun[speed])
      b->behind[speed][before[speed]][strategy]++;
    else
      b->first[speed][strategy]++;
    begun[speed] = true;
    before[speed] = strategy;
  }
  end_round(p, before, begun, b);
}

static bool is_there(const ethd__protocol *p, size_t speed, size_t strategy) {
  for (size_t i = 0; i < p->condition_count; i++)
    if (p->condition[i].speed == speed && p->condition[i].strategy == strategy) return true;
  return false;
}

static bool is_even(const ethd__protocol *p, size_t speed, const uint32_t *count) {
  uint32_t least = UINT32_MAX, most = 0;
  for (size_t i = 0; i < p->strategies.count; i++) {
    if (!is_there(p, speed, i)) continue;
    if (count[i] < least) least = count[i];
    if (count[i] > most) most = count[i];
  }
  return least >= most;
}

/* The least and largest count of a strategy directly after another at a speed. */
static void neighbours(const ethd__protocol *p, const balance *b, size_t speed, uint32_t *least, uint32_t *most) {
  for (size_t i = 0; i < p->strategies.count; i++)
    for (size_t j = 0; j < p->strategies.count; j++) {
      if (i == j || !is_there(p, speed, i) || !is_there(p, speed, j)) continue;
      if (b->behind[speed][i][j] < *least) *least = b->behind[speed][i][j];
      if (b->behind[speed][i][j] > *most) *most = b->behind[speed][i][j];
    }
}

static bool is_balanced(const ethd__protocol *p, const balance *b) {
  bool even = true;
  for (size_t speed = 0; speed < p->speeds.count; speed++) {
    uint32_t least = UINT32_MAX, most = 0;
    neighbours(p, b, speed, &least, &most);
    even &= is_even(p, speed, b->first[speed]) && is_even(p, speed, b->last[speed]) && least >= most;
  }
  return even;
}

/* Returns the next balanced number of participants from `people` on, up to FARTHEST times the
   cells; 0 if there is none. */
static uint32_t next_balanced(const ethd__protocol *p, uint32_t people) {
  uint32_t last = people + FARTHEST * (uint32_t)(p->strategies.count * p->speeds.count);
  balance b = {0};
  for (uint32_t i = 0; i < last; i++) {
    count_person(p, i, &b);
    if (i + 1 >= people && is_balanced(p, &b)) return i + 1;
  }
  return 0;
}

/* ---- the orders ---- */

char *ethd__plan_table(const ethd__protocol *p) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  char id[ETHD_STUDY_ID_MAX];
  ETHD__FREED char *header = ethd__table_header(ETHD_TABLE_ORDERS, p);
  ethd__printed table;
  FILE *file = ethd__print_begin(&table);
  fprintf(file, "%s\n", header);
  for (uint32_t person = 0; person < p->participants && person < ETHD_STUDY_PLANNED; person++) {
    size_t count = ethd__order_of(p, person, blocks);
    ethd__participant_id(p, person, id);
    for (size_t i = 0; i < count; i++)
      fprintf(file, "%s,%zu,%s,%s,%s\n", id, i + 1, blocks[i].training ? "training" : "test",
              p->strategies.word[blocks[i].strategy], p->speeds.word[blocks[i].speed]);
  }
  return ethd__print_end(&table);
}

static void print_orders(FILE *file, const ethd__protocol *p) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  char id[ETHD_STUDY_ID_MAX];
  for (uint32_t person = 0; person < p->participants && person < ETHD_STUDY_PLANNED; person++) {
    size_t count = ethd__order_of(p, person, blocks);
    ethd__participant_id(p, person, id);
    fprintf(file, "%-5s", id);
    for (size_t i = 0; i < count; i++)
      fprintf(file, " %s%s-%s%s", blocks[i].training ? "(" : "", p->strategies.word[blocks[i].strategy],
              p->speeds.word[blocks[i].speed], blocks[i].training ? ")" : "");
    fputc('\n', file);
  }
}

/* ---- the balance ---- */

static void print_counts(FILE *file, const ethd__protocol *p, uint32_t count[][ETHD_STUDY_WORDS]) {
  for (size_t speed = 0; speed < p->speeds.count; speed++) {
    fprintf(file, "  %s ", p->speeds.word[speed]);
    for (size_t i = 0; i < p->strategies.count; i++) fprintf(file, "%s%" PRIu32, i ? ":" : "", count[speed][i]);
  }
}

static void print_neighbours(FILE *file, const ethd__protocol *p, const balance *b) {
  uint32_t least = UINT32_MAX, most = 0;
  for (size_t speed = 0; speed < p->speeds.count; speed++) neighbours(p, b, speed, &least, &most);
  if (least <= most) fprintf(file, "  neighbours %" PRIu32 " to %" PRIu32, least, most);
}

static void print_balance(FILE *file, const ethd__protocol *p) {
  balance b = {0};
  fputs("\nHow often each strategy (", file);
  for (size_t i = 0; i < p->strategies.count; i++) fprintf(file, "%s%s", i ? ":" : "", p->strategies.word[i]);
  fputs(") is the first and the last at a speed, and directly behind another:\n", file);
  for (uint32_t n = 1; n <= p->participants && n <= ETHD_STUDY_PLANNED; n++) {
    count_person(p, n - 1, &b);
    fprintf(file, "%5" PRIu32 "  first", n);
    print_counts(file, p, b.first);
    fputs("  last", file);
    print_counts(file, p, b.last);
    print_neighbours(file, p, &b);
    fputs(is_balanced(p, &b) ? "  balanced\n" : "\n", file);
  }
}

static void warn(FILE *file, const ethd__protocol *p) {
  static const char *const words[] = {"paper", "random", "latin", "interleaved"};
  uint32_t next = next_balanced(p, p->participants);
  if (next == p->participants) return;
  fprintf(file, "\nWARNING: order = %s isn't balanced with %" PRIu32 " participant%s; ", words[p->order],
          p->participants, ethd__s(p->participants));
  if (next) {
    fprintf(file, "%" PRIu32 " are\n", next);
    return;
  }
  ethd__protocol other = *p;
  other.order = p->order == ETHD_ORDER_LATIN ? ETHD_ORDER_PAPER : ETHD_ORDER_LATIN;
  next = next_balanced(&other, p->participants);
  fputs("no number near that is", file);
  if (next) fprintf(file, ", but order = %s with %" PRIu32, words[other.order], next);
  fputc('\n', file);
}

static void print_outcomes(FILE *file, const ethd__protocol *p) {
  fprintf(file, "\nStudy %s, %" PRIu32 " participant%s, %" PRIu32 " valid tap%s a cell\nPrimary outcomes:", p->name,
          p->participants, ethd__s(p->participants), p->taps, ethd__s(p->taps));
  for (size_t i = 0; i < p->primary.count; i++) fprintf(file, "%s %s", i ? "," : "", p->primary.word[i]);
  fprintf(file, "%s\nExclusions: %s\n", p->primary.count ? "" : " none declared",
          p->exclusions ? p->exclusions : "none declared");
}

void ethd__plan_print(FILE *file, const ethd__protocol *p) {
  print_orders(file, p);
  print_balance(file, p);
  warn(file, p);
  print_outcomes(file, p);
}
