/* The time of every reader is linear in its text: eight times as many rows in eight times as long. Eightfold rows of
   what is quadratic take 64 times as long; half of that is allowed, for caches and a busy machine. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "unit/readers.h"
#include "unit/suite.h"

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The shortest of several readings of a text with this number of rows, s. */
static double time_of(const text_reader *r, int rows) {
  char *text;
  size_t length;
  FILE *out = open_memstream(&text, &length);
  r->grow(out, rows);
  fclose(out);
  double least = 1e9;
  for (int round = 0; round < 5; round++) {
    int times = 0;
    double start = seconds(), spent;
    do {
      ck_assert_msg(r->read(text, length) == 1, "%s: %d rows aren't taken", r->name, rows);
      times++;
    } while ((spent = seconds() - start) < 2e-3);
    if (spent / times < least) least = spent / times;
  }
  free(text);
  return least;
}

static int readers(void) {
  int count = 0;
  while (text_readers[count].name) count++;
  return count;
}

TEST_LOOP(test_time_is_linear, 0, readers()) {
  const text_reader *r = &text_readers[_i];
  if (!r->grow) return;
  double one = time_of(r, r->rows), eight = time_of(r, 8 * r->rows);
  printf("%s: %d rows in %.3g ms, eight times as many in %.3g ms\n", r->name, r->rows, 1e3 * one, 1e3 * eight);
  ck_assert_msg(eight < 32 * one, "%s: %.3g s for %d rows, %.3g s for eight times as many", r->name, one, r->rows,
                eight);
}

/* The seeds from which volume starts are taken. */
TEST(test_seeds) {
  for (const text_reader *r = text_readers; r->name; r++)
    if (strcmp(r->name, "frames") != 0)
      ck_assert_msg(r->read(r->seed, r->length) == 1, "%s: its seed isn't taken", r->name);
}
