#include "scene_build.h"

static int precedes(const ethd__item *a, const ethd__item *b, int k) {
  return a->middle[k] < b->middle[k] || (a->middle[k] == b->middle[k] && a->id < b->id);
}

static void swap(ethd__item *a, ethd__item *b) {
  ethd__item t = *a;
  *a = *b;
  *b = t;
}

/* The first `m` of `n` in the order of coordinate k come first (Hoare 1961). */
static void part(ethd__item *p, size_t n, size_t m, int k) {
  for (size_t round = 0; n > 1 && m > 0 && m < n; round++) {
    ethd__item pivot = p[(n / 2 + round * 0x9e3779b1u) % n];
    size_t i = 0, j = n - 1;
    for (;; i++, j--) {
      while (precedes(&p[i], &pivot, k)) i++;
      while (precedes(&pivot, &p[j], k)) j--;
      if (i >= j) break;
      swap(&p[i], &p[j]);
    }
    size_t low = i == j ? i + 1 : i; /* of p, none before `low` goes after one of the rest */
    if (low == n) low = n - 1;
    if (m < low) {
      n = low;
    } else {
      p += low;
      n -= low;
      m -= low;
    }
  }
}

static int wider_side(const ethd__item *p, size_t n) {
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 2; k++) {
      double v = p[i].middle[k];
      low[k] = v < low[k] ? v : low[k];
      high[k] = v > high[k] ? v : high[k];
    }
  return high[1] - low[1] > high[0] - low[0];
}

/* Items that one thing of this level holds. */
typedef struct range {
  ethd__item *items;
  size_t count;
  uint32_t level;
} range;

static size_t capacity(uint32_t level) { return (size_t)1 << 3 * level; }

/* Halves of whole things of the level below, until there is one. */
void ethd__order_build(ethd__item *items, uint32_t count) {
  range stack[4 * ETHD__LEVELS];
  int depth = 0;
  ethd__tree tree;
  ethd__tree_set(&tree, count, 0);
  stack[depth++] = (range){items, count, tree.levels};
  while (depth) {
    range r = stack[--depth];
    if (r.level == 0) continue;
    size_t step = capacity(r.level - 1), things = (r.count + step - 1) / step;
    if (things <= 1) {
      stack[depth++] = (range){r.items, r.count, r.level - 1};
      continue;
    }
    size_t left = (things + 1) / 2 * step;
    part(r.items, r.count, left, wider_side(r.items, r.count));
    stack[depth++] = (range){r.items + left, r.count - left, r.level};
    stack[depth++] = (range){r.items, left, r.level};
  }
}
