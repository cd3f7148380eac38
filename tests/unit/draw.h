/* Random numbers by counter: draw i of a test is the same everywhere. */
#ifndef ETHD_TESTS_DRAW_H
#define ETHD_TESTS_DRAW_H

#include <math.h>
#include <stdint.h>

static inline uint64_t draw_bits(uint64_t i) {
  uint64_t z = (i + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

/* Uniform in [a, b). */
static inline double draw(uint64_t i, double a, double b) {
  return a + (b - a) * ((double)(draw_bits(i) >> 11) * 0x1p-53);
}

/* Standard normal. */
static inline double draw_normal(uint64_t i) {
  return sqrt(-2 * log(1 - draw(2 * i, 0, 1))) * cos(6.28318530717958648 * draw(2 * i + 1, 0, 1));
}

#endif
