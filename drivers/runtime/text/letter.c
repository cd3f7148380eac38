#include "text/text.h"

size_t ethd__letter_of(const char *text, uint32_t *out) {
  static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
  unsigned char first = (unsigned char)*text;
  size_t n = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
  *out = n > 1 ? first & (0x7fu >> n) : first;
  for (size_t i = 1; i < n; i++) {
    if (((unsigned char)text[i] & 0xc0) != 0x80) return 0;
    *out = *out << 6 | ((unsigned char)text[i] & 0x3f);
  }
  bool surrogate = *out >= 0xd800 && *out < 0xe000;
  return n && *out >= least[n] && *out <= 0x10ffff && !surrogate ? n : 0;
}
