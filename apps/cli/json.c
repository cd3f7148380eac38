#include "cli/json.h"

#include <math.h>
#include <string.h>

void ethd__json_string(FILE *file, const char *text, size_t n) {
  putc('"', file);
  for (size_t i = 0; i < n && text[i]; i++) {
    unsigned char c = (unsigned char)text[i];
    if (c == '"' || c == '\\') putc('\\', file);
    if (c < ' ')
      fprintf(file, "\\u%04x", c);
    else
      putc(c, file);
  }
  putc('"', file);
}

void ethd__json_word(FILE *file, const char *text) {
  if (text)
    ethd__json_string(file, text, strlen(text));
  else
    fputs("null", file);
}

void ethd__json_number(FILE *file, double value) {
  if (isfinite(value))
    fprintf(file, "%.17g", value);
  else
    fputs("null", file);
}
