/* A controller whose laws misbehave when told to. */
#ifndef ETHD_TESTS_MOODY_H
#define ETHD_TESTS_MOODY_H

#include "unit/rig.h"

enum { MOODY_WELL, MOODY_FAIL, MOODY_POSITIVE, MOODY_BAD };

/* The device's dynamics: 0.1 kg, without delay. A stop commands at first a tenth of the momentum within a tick, m / 10 T,
   and when it sees the ring slow down m / (e T), Ns/m. */
#define MOODY_MASS 0.1
#define MOODY_PROBE 10.0
#define MOODY_DAMPING (MOODY_MASS / (1e-3 * 2.718281828459045))

typedef struct moody {
  int tracking, contact, transition;
  double value; /* of what is bad */
  size_t field; /* of the ruling */
} moody;

extern moody mood;

/* The rig with these laws at the default wall, started. */
void moody_open(rig *r, int latch);

/* 1 mm inside at 10 mm/s, finger 1 mm deeper; a tick later than the last. */
ethd_sense moody_sense(const rig *r);

/* The last tick's command is the safe one, for this reason. */
void moody_expect_safe(const rig *r, ethd_status status, ethd_fault fault);

/* The next event is this one; value NAN: any. */
void moody_expect_event(rig *r, int kind, int code, double value);

#endif
