#include "study/plan.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "study/columns.h"
#include "text/text.h"

#define FARTHEST 4 /* times the cells, up to which another number of participants is looked for */

/* How often each strategy came first, last and behind each other one at a speed, among the first participants. In
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

static bool is_even(const uint32_t *count, size_t n) {
  for (size_t i = 1; i < n; i++)
    if (count[i] != count[0]) return false;
  return true;
}

static bool are_neighbours_even(const ethd__protocol *p, const balance *b, size_t speed) {
  size_t n = p->strategies.count;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      if (i != j && b->behind[speed][i][j] != b->behind[speed][0][1]) return false;
  return true;
}

static bool is_balanced(const ethd__protocol *p, const balance *b) {
  bool even = true;
  for (size_t speed = 0; speed < p->speeds.count; speed++)
    even &= is_even(b->first[speed], p->strategies.count) && is_even(b->last[speed], p->strategies.count) &&
            are_neighbours_even(p, b, speed);
  return even;
}

bool ethd__plan_balanced(const ethd__protocol *p, uint32_t people) {
  balance b = {0};
  for (uint32_t i = 0; i < people; i++) count_person(p, i, &b);
  return is_balanced(p, &b);
}

/* Returns the next number of participants from `people` on at which everything is balanced, up to FARTHEST times the
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

void ethd__plan_table(FILE *file, const ethd__protocol *p) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  char id[ETHD_STUDY_ID_MAX], *header = ethd__table_header(ETHD_TABLE_ORDERS, p);
  fprintf(file, "%s\n", header);
  free(header);
  for (uint32_t person = 0; person < p->participants && person < ETHD_STUDY_PLANNED; person++) {
    size_t count = ethd__order_of(p, person, blocks);
    ethd__participant_id(p, person, id);
    for (size_t i = 0; i < count; i++)
      fprintf(file, "%s,%zu,%s,%s,%s\n", id, i + 1, blocks[i].training ? "training" : "test",
              p->strategies.word[blocks[i].strategy], p->speeds.word[blocks[i].speed]);
  }
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
  for (size_t speed = 0; speed < p->speeds.count; speed++)
    for (size_t i = 0; i < p->strategies.count; i++)
      for (size_t j = 0; j < p->strategies.count; j++) {
        if (i == j) continue;
        if (b->behind[speed][i][j] < least) least = b->behind[speed][i][j];
        if (b->behind[speed][i][j] > most) most = b->behind[speed][i][j];
      }
  if (p->strategies.count > 1) fprintf(file, "  neighbours %" PRIu32 " to %" PRIu32, least, most);
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
