/* Checks text of a plugin that programs show to people. */
#ifndef ETHD__LINE_H
#define ETHD__LINE_H

#include <stdbool.h>
#include <stddef.h>

/* Returns true for 1 to `most` printable ASCII characters: one line without what terminals obey. */
static inline bool ethd__is_line(const char *text, size_t most) {
  size_t n = 0;
  if (!text) return false;
  while (n <= most && text[n] >= ' ' && text[n] <= '~') n++;
  return n >= 1 && n <= most && !text[n];
}

#endif
