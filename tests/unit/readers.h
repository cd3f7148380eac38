/* All readers of strangers' bytes, as one table: for volume (tests/volume.c) and for time (test_linear.c). */
#ifndef ETHD_TESTS_READERS_H
#define ETHD_TESTS_READERS_H

#include <stddef.h>
#include <stdio.h>

typedef struct text_reader {
  const char *name;
  const char *seed; /* a text that is read well */
  size_t length;
  const char *const *words; /* spliced into it, NULL ends */
  /* 1: taken, 0: refused in one line that names the text "x", -1: refused in another way. text[length] is 0. */
  int (*read)(const char *text, size_t length);
  /* Writes a text with this number of rows that is taken; NULL: the reader bounds its input, or doesn't read all of it. */
  void (*grow)(FILE *out, int rows);
  int rows; /* eight times as many are taken too */
} text_reader;

/* NULL name ends. */
extern const text_reader text_readers[];

#endif
