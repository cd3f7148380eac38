#include "statistics/dip.h"

#include <math.h>
#include <stdlib.h>

#include "sim/random.h"

#define FEWEST 8u
#define LARGEST 200u
#define DRAWS 1000u

/* The mode lies between two values, which close in on it step by step. Before them the nearest unimodal function is the
   greatest convex minorant, behind them the least concave majorant. Counts of values stand for probabilities: in units
   of 1/n, the sample's distribution function is i just before value i and i + 1 from value i on. */
typedef struct hulls {
  const double *x;
  size_t *under, *over; /* values at which the greatest convex minorant bends, and the least concave majorant */
  size_t unders, overs;
} hulls;

/* Twice the signed area of the triangle a, b, c, whose sign says on which side of the line from a to c the point b
   lies. But for a constant, both hulls run through points (x[i], i). */
static double turn(const double *x, size_t a, size_t b, size_t c) {
  return (x[b] - x[a]) * (double)(c - a) - (x[c] - x[a]) * (double)(b - a);
}

static size_t bend(const hulls *h, size_t from, size_t to, double side, size_t *out) {
  size_t n = 0;
  for (size_t i = from; i <= to; i++) {
    while (n > 1 && side * turn(h->x, out[n - 2], out[n - 1], i) <= 0) n--;
    out[n++] = i;
  }
  return n;
}

/* Height of the hull's piece from a to b at value i, in counts. */
static double height(const double *x, size_t a, size_t b, size_t i) {
  return x[b] > x[a] ? (double)a + (double)(b - a) * (x[i] - x[a]) / (x[b] - x[a]) : (double)a;
}

/* Finds the k for which the hull's piece at value i goes from hull[k] to hull[k + 1]. */
static size_t piece(const size_t *hull, size_t count, size_t i, size_t k) {
  while (k + 2 < count && hull[k + 1] <= i) k++;
  return k;
}

typedef struct gap {
  double size;
  size_t low, high; /* the mode lies between these two */
} gap;

/* Finds where minorant and majorant are furthest apart, which is at a bend of one of them. */
static gap widest(const hulls *h) {
  gap best = {-1, 0, 0};
  size_t o = 0, u = 0;
  for (size_t k = 0; k < h->unders; k++) {
    size_t i = h->under[k];
    o = piece(h->over, h->overs, i, o);
    double size = height(h->x, h->over[o], h->over[o + 1], i) + 1 - (double)i;
    if (size > best.size) best = (gap){size, i, h->over[o + 1]};
  }
  for (size_t k = 0; k < h->overs; k++) {
    size_t i = h->over[k];
    u = piece(h->under, h->unders, i, u);
    double size = (double)i + 1 - height(h->x, h->under[u], h->under[u + 1], i);
    if (size > best.size) best = (gap){size, h->under[u], i};
  }
  return best;
}

/* Returns how far the sample's function lies above the minorant at most, from value `from` to value `to`. */
static double above_minorant(const hulls *h, size_t from, size_t to) {
  double most = 0;
  size_t u = 0;
  for (size_t i = from; i <= to; i++) {
    u = piece(h->under, h->unders, i, u);
    most = fmax(most, (double)i + 1 - height(h->x, h->under[u], h->under[u + 1], i));
  }
  return most;
}

static double below_majorant(const hulls *h, size_t from, size_t to) {
  double most = 0;
  size_t o = 0;
  for (size_t i = from; i <= to; i++) {
    o = piece(h->over, h->overs, i, o);
    most = fmax(most, height(h->x, h->over[o], h->over[o + 1], i) + 1 - (double)i);
  }
  return most;
}

double ethd__dip(const double *x, size_t n) {
  hulls h = {x, malloc((n + 1) * sizeof *h.under), malloc((n + 1) * sizeof *h.over), 0, 0};
  size_t low = 0, high = n ? n - 1 : 0;
  double dip = 1;
  if (!h.under || !h.over || !n) dip = NAN;
  while (!isnan(dip) && x[high] > x[low]) {
    h.unders = bend(&h, low, high, 1, h.under);
    h.overs = bend(&h, low, high, -1, h.over);
    gap g = widest(&h);
    if (g.size <= dip) break;
    dip = fmax(dip, fmax(above_minorant(&h, low, g.low), below_majorant(&h, g.high, high)));
    if (g.low == low && g.high == high) break;
    low = g.low, high = g.high;
  }
  free(h.under);
  free(h.over);
  return dip / (2 * (double)n);
}

double ethd__dip_share(double dip, size_t n, uint64_t seed) {
  size_t size = n < LARGEST ? n : LARGEST, above = 0;
  double *room = malloc((size + 1) * sizeof *room), limit = dip * sqrt((double)n / (double)size);
  if (!room || n < FEWEST || isnan(dip)) {
    free(room);
    return NAN;
  }
  for (uint32_t k = 0; k < DRAWS; k++) {
    for (size_t i = 0; i < size; i++) room[i] = ethd__uniform((ethd__sim_key){seed, k}, ETHD_DRAW_UNIFORM, (uint32_t)i);
    ethd__sort(room, size);
    above += ethd__dip(room, size) >= limit;
  }
  free(room);
  return (double)(above + 1) / (DRAWS + 1);
}

void ethd__dip_spread(double *x, size_t n, double grain) {
  for (size_t i = 0, j; i < n; i = j) {
    double value = x[i];
    for (j = i; j < n && x[j] <= value + grain / 4; j++) continue;
    for (size_t k = i; k < j; k++) x[k] = value + grain * (((double)(k - i) + 0.5) / (double)(j - i) - 0.5);
  }
}
