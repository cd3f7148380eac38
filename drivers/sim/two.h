/* Two doubles side by side: x and y, or joint 1 and joint 2. */
#ifndef ETHD__SIM_TWO_H
#define ETHD__SIM_TWO_H

#include <math.h>

typedef double ethd__two __attribute__((vector_size(16)));

static inline ethd__two ethd__both(double x) { return (ethd__two){x, x}; }
static inline ethd__two ethd__pair(const double *x) { return (ethd__two){x[0], x[1]}; }
static inline ethd__two ethd__swapped(ethd__two x) { return (ethd__two){x[1], x[0]}; }
static inline double ethd__sum(ethd__two x) { return x[0] + x[1]; }
static inline double ethd__size(ethd__two x) { return fabs(x[0]) + fabs(x[1]); }

#endif
