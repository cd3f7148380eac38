#include "ethd/loop.h"

#define EXACT 32 /* values below this have a bin each; above, each factor of two has this number of bins */
#define EXACT_BITS 5

static uint32_t bin_of(uint64_t ns) {
  if (ns < EXACT) return (uint32_t)ns;
  uint32_t shift = 63 - (uint32_t)__builtin_clzll(ns) - EXACT_BITS;
  uint32_t bin = (shift << EXACT_BITS) + (uint32_t)(ns >> shift);
  return bin < ETHD_BINS ? bin : ETHD_BINS - 1;
}

int64_t ethd_histogram_first(uint32_t bin) {
  if (bin < 2 * EXACT) return bin;
  uint32_t shift = (bin >> EXACT_BITS) - 1;
  return (int64_t)(bin - (shift << EXACT_BITS)) << shift;
}

int64_t ethd_histogram_last(uint32_t bin) { return ethd_histogram_first(bin + 1) - 1; }

/* There is one writer; a reader at the same time sees whole numbers. */
static void raise(uint64_t *count) { __atomic_store_n(count, *count + 1, __ATOMIC_RELAXED); }

void ethd_histogram_add(ethd_histogram *h, int64_t ns) {
  if (ns < 0) ns = 0;
  raise(&h->counts[bin_of((uint64_t)ns)]);
  raise(&h->count);
  if (ns > h->max) __atomic_store_n(&h->max, ns, __ATOMIC_RELAXED);
}

int64_t ethd_histogram_at(const ethd_histogram *h, double share) {
  uint64_t seen = 0;
  for (uint32_t bin = 0; bin < ETHD_BINS; bin++) {
    seen += h->counts[bin];
    if (!seen || (double)seen < share * (double)h->count) continue;
    int64_t last = ethd_histogram_last(bin);
    return bin < ETHD_BINS - 1 && last < h->max ? last : h->max;
  }
  return 0;
}
