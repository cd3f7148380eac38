/* The order of the leaves. All items are split in two by a median in the wider of x and y, and each part is split again
   until it fits into one box of the level; then the next level is split in the same way. Parts are whole numbers of
   full boxes, so only the last node of a level stays partly empty. */
#include "scene/build.h"

#define SMALL 12 /* items that are sorted by insertion */

/* Returns an item's rank along one axis; the id makes all ranks distinct. */
static uint64_t rank(const ethd__item *i, int side) { return (uint64_t)i->at[side] << 32 | i->id; }

static void swap(ethd__item *a, ethd__item *b) {
  ethd__item t = *a;
  *a = *b;
  *b = t;
}

static void sort(ethd__item *p, size_t n, int side) {
  for (size_t i = 1; i < n; i++)
    for (size_t k = i; k > 0 && rank(&p[k], side) < rank(&p[k - 1], side); k--) swap(&p[k], &p[k - 1]);
}

static uint64_t median(uint64_t a, uint64_t b, uint64_t c) {
  uint64_t low = a < b ? a : b, high = a < b ? b : a;
  return c < low ? low : c > high ? high : c;
}

/* Returns the median of three medians of nine items, which is neither the first nor the last of all. */
static uint64_t pivot(const ethd__item *p, size_t n, int side) {
  uint64_t m[3];
  for (size_t i = 0; i < 3; i++)
    m[i] = median(rank(&p[i * n / 9], side), rank(&p[(i + 3) * n / 9], side), rank(&p[(i + 6) * n / 9], side));
  return median(m[0], m[1], m[2]);
}

/* Moves the items up to rank `most` to the front; returns their number. No branch depends on the items' order. */
static size_t divide(ethd__item *p, size_t n, uint64_t most, int side) {
  size_t low = 0;
  for (size_t i = 0; i < n; i++) {
    size_t goes = rank(&p[i], side) <= most;
    swap(&p[i], &p[low]);
    low += goes;
  }
  return low;
}

/* Moves the m < n lowest of n items to the front (Hoare 1961). */
static void part(ethd__item *p, size_t n, size_t m, int side) {
  while (n > SMALL && m > 0) {
    size_t low = divide(p, n, pivot(p, n, side), side);
    if (m < low) {
      n = low;
    } else {
      p += low;
      n -= low;
      m -= low;
    }
  }
  if (m > 0) sort(p, n, side);
}

static int wider_side(const ethd__item *p, size_t n) {
  uint32_t low[2] = {UINT32_MAX, UINT32_MAX}, high[2] = {0, 0};
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 2; k++) {
      uint32_t v = p[i].at[k];
      low[k] = v < low[k] ? v : low[k];
      high[k] = v > high[k] ? v : high[k];
    }
  return high[1] - low[1] > high[0] - low[0];
}

/* Items that are still to be split, and the level of the tree that they form. */
typedef struct range {
  ethd__item *items;
  size_t count;
  uint32_t level;
} range;

void ethd__order_build(ethd__item *items, uint32_t count) {
  range stack[4 * ETHD__LEVELS];
  int depth = 0;
  ethd__tree tree;
  ethd__tree_set(&tree, count, 0);
  stack[depth++] = (range){items, count, tree.levels};
  while (depth) {
    range r = stack[--depth];
    if (r.level == 0) continue;
    size_t step = (size_t)1 << 3 * (r.level - 1), things = (r.count + step - 1) / step;
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
