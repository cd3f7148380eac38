/* volume READER FIRST COUNT [SECONDS]: gives a reader of the table (unit/readers.c) the inputs FIRST ... FIRST+COUNT-1,
   which are the same everywhere, for SECONDS at most. Prints where it came to, how many were taken, and seconds. An
   input that is refused in another way than by one line ends it with exit 1 and stands on stderr. volume: the readers'
   names. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "clock.h"
#include "unit/mutate.h"
#include "unit/readers.h"

enum { ROOM = 4096 };

/* A reader's case: a mutation of its seed; of every fourth, a mutation of a mutation. */
static size_t make(const text_reader *r, uint64_t i, char out[ROOM]) {
  static char once[ROOM];
  if (i % 4) return mutate(r->seed, r->length, r->words, i, out, ROOM);
  size_t n = mutate(r->seed, r->length, r->words, i, once, ROOM);
  return mutate(once, n, r->words, i ^ (uint64_t)1 << 57, out, ROOM);
}

int main(int argc, char **argv) {
  const text_reader *r = text_readers;
  if (argc == 1) {
    for (; r->name; r++) puts(r->name);
    return 0;
  }
  while (r->name && strcmp(r->name, argv[1]) != 0) r++;
  if (argc < 4 || !r->name) return fprintf(stderr, "volume READER FIRST COUNT [SECONDS]\n"), 2;
  uint64_t first = strtoull(argv[2], NULL, 10), end = first + strtoull(argv[3], NULL, 10), i = first, taken = 0;
  double start = 1e-9 * (double)ethd__clock_now(), most = argc > 4 ? atof(argv[4]) : 1e18;
  char *text = malloc(ROOM); /* of its own, so that a sanitizer sees its ends */
  if (!text) return 1;
  for (; i < end; i++) {
    if (i % 1024 == 0 && 1e-9 * (double)ethd__clock_now() - start > most) break;
    size_t n = make(r, i, text);
    int verdict = r->read(text, n);
    if (verdict < 0) return fprintf(stderr, "%s: input %llu:\n%.*s\n", r->name, (unsigned long long)i, (int)n, text), 1;
    taken += verdict > 0;
  }
  free(text);
  printf("%llu %llu %.1f\n", (unsigned long long)i, (unsigned long long)taken,
         1e-9 * (double)ethd__clock_now() - start);
  return 0;
}
