#ifndef ETHD__CELL_H
#define ETHD__CELL_H

#include <stdatomic.h>
#include <stdbool.h>

#include "ethd/cell.h"

/* There are three slots: the writer fills its own, the reader reads its own, and the third waits in the middle. Either
   side exchanges its slot for the middle one by a single atomic step, so neither ever waits for the other. */
#define ETHD__CELL_FRESH 4u /* a bit of `middle`: the reader hasn't taken that slot yet */

struct ethd_cell {
  size_t size, stride;
  _Alignas(64) atomic_uint middle; /* the slot that neither side owns, and whether it is fresh */
  _Alignas(64) unsigned back;      /* the writer's slot */
  _Alignas(64) unsigned front;     /* the reader's slot */
  bool taken;                      /* the reader's slot holds a value: one was taken before */
  _Alignas(64) unsigned char slots[];
};

#endif
