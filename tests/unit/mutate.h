/* Mutations of a text for readers that must never crash: case i is the same everywhere. */
#ifndef ETHD_TESTS_MUTATE_H
#define ETHD_TESTS_MUTATE_H

#include <string.h>

#include "draw.h"

/* Replaces the value behind the next '=' from `at` on, up to the line's end, by `value`. Returns the new length; n: there is none,
   or no room. */
static inline size_t mutate_value(char *out, size_t n, size_t at, const char *value, size_t room) {
  char *equals = at < n ? memchr(out + at, '=', n - at) : NULL;
  if (!equals) return n;
  const size_t from = (size_t)(equals - out) + 1, length = strlen(value);
  const char *line_end = memchr(out + from, '\n', n - from);
  const size_t end = line_end ? (size_t)(line_end - out) : n, rest = n - end;
  if (from + length + rest >= room) return n;
  memmove(out + from + length, out + end, rest);
  memcpy(out + from, value, length);
  return from + length + rest;
}

/* Writes a mutation of `seed` into out (room bytes, 0 behind the end); returns its length. `words` are spliced in now and then,
   those that begin with '=' in the place of a value; they end with NULL. */
static inline size_t mutate(const char *seed, size_t length, const char *const *words, uint64_t i, char *out,
                            size_t room) {
  size_t n = length < room / 2 ? length : room / 2, count = 0;
  memcpy(out, seed, n);
  while (words[count]) count++;
  for (uint64_t k = 0, changes = 1 + draw_bits(i * 64) % 4; k < changes; k++) {
    uint64_t r = draw_bits(i * 64 + k + 1), at = n ? (r >> 8) % n : 0;
    const char *word = words[(r >> 40) % count];
    size_t add = strlen(word);
    switch (r & 7) {
    case 0: n = at; break;                                   /* cut */
    case 1: out[at] = (char)(r >> 32); break;                /* any byte */
    case 2: out[at] ^= (char)(1u << ((r >> 32) & 7)); break; /* a bit */
    case 3: memmove(out + at, out + at + (n > at), n > at ? n - at - 1 : 0), n -= n > 0; break;
    default:
      if (word[0] == '=' && add > 1) {
        n = mutate_value(out, n, at, word + 1, room);
        break;
      }
      if (n + add >= room) break;
      memmove(out + at + add, out + at, n - at);
      memcpy(out + at, word, add);
      n += add;
    }
  }
  out[n] = 0;
  return n;
}

#endif
