#ifndef ETHD__CELL_H
#define ETHD__CELL_H

#include <stdatomic.h>
#include <stdbool.h>

#include "ethd/cell.h"

/* There are three slots: the writer's, the reader's, and one in the middle. Either side exchanges its slot for the
   middle one by a single atomic operation, so neither ever waits for the other. */
#define ETHD__CELL_FRESH 4u /* a bit of `middle`: the reader hasn't read that slot yet */

struct ethd_cell {
  size_t size, stride;
  _Alignas(64) atomic_uint middle; /* the slot that neither side owns, and whether it is fresh */
  _Alignas(64) unsigned back;      /* the writer's slot */
  _Alignas(64) unsigned front;     /* the reader's slot */
  bool taken;                      /* the reader's slot holds a value from an earlier read */
  _Alignas(64) unsigned char slots[];
};

#endif
