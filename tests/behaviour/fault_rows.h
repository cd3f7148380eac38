/* Rows of the fault table and what brings each about. */
#ifndef ETHD_TESTS_FAULT_ROWS_H
#define ETHD_TESTS_FAULT_ROWS_H

#include "behaviour/fault_rig.h"

typedef struct fault_row {
  int row;
  ethd_reaction reaction;
  int is_grave;
  fault_device device;
  int first, last; /* first and last tick of the tap at which it may begin */
  int bound;       /* ticks */
  fault_inject inject;
  void (*change)(ethd_setup *setup);
  const char *how;
  int needs_motion; /* 1: shows in some taps only, and from a moment that `inject` finds */
} fault_row;

extern const fault_row fault_rows[];
extern const size_t fault_row_count;

/* Rows that aren't met in a tick: trial i goes wrong in `says`, or not. */
typedef struct fault_end {
  int row;
  ethd_reaction reaction;
  void (*try)(int i, char *says, size_t room);
  const char *how;
} fault_end;

extern const fault_end fault_ends[];
extern const size_t fault_end_count;

#endif
