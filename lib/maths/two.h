/* Two doubles side by side. SSE2 and NEON hold them in one register; elsewhere the compiler works on one after the
   other. */
#ifndef ETHD__MATHS_TWO_H
#define ETHD__MATHS_TWO_H

#include <stdint.h>

typedef double two __attribute__((vector_size(16)));
typedef uint64_t two_bits __attribute__((vector_size(16)));

static inline two two_abs(two x) { return (two)((two_bits)x & INT64_MAX); }

/* Each half is x where the mask's bits are set, else 0. */
static inline two two_where(two_bits mask, two x) { return (two)((two_bits)x & mask); }

static inline double two_sum(two x) { return x[0] + x[1]; }

#endif
