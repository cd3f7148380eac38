/* Identifies the sensors: encoder counts, and the ring's readings. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_SENSING_H
#define ETHD__APPS_IDENTIFY_SENSING_H

#include "identify/evidence.h"

/* A number and its lower and upper bound; NaN: not determined. */
typedef struct ethd__bracket {
  double value, low, high;
} ethd__bracket;

typedef struct ethd__sensing {
  double count;                 /* rad; 0: angles lie on no lattice */
  bool count_drawn;             /* the lattice has a phase */
  ethd__bracket rate;           /* Hz, of the finger's readings */
  ethd__bracket latency, noise; /* s, m; the latency's ends are certain if it is constant, the noise's hold by 95 % */
} ethd__sensing;

/* ETHD_E_ARGUMENT: recordings with different encoder counts are of two devices. */
ETHD_MUST_CHECK ethd_status ethd__sensing_find(const ethd__evidence *evidence, ethd__sensing *out,
                                               char message[ETHD_MESSAGE_MAX]);

#endif
