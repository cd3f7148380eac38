/* Checks the text of a plugin before programs print it. */
#ifndef ETHD__LINE_H
#define ETHD__LINE_H

#include <stdbool.h>
#include <stddef.h>

/* Returns true for 1 to `most` printable ASCII characters: one line without control characters. */
static inline bool ethd__is_line(const char *text, size_t most) {
  size_t n = 0;
  if (!text) return false;
  while (n <= most && text[n] >= ' ' && text[n] <= '~') n++;
  return n >= 1 && n <= most && !text[n];
}

#endif
