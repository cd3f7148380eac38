#ifndef ETHD__CELL_H
#define ETHD__CELL_H

#include <stdatomic.h>
#include <stdbool.h>

#include "ethd/cell.h"

#define ETHD__CELL_FRESH 4u /* in `middle`: its slot hasn't been taken yet */

struct ethd_cell {
  size_t size, stride;
  _Alignas(64) atomic_uint middle; /* slot that is nobody's, and FRESH */
  _Alignas(64) unsigned back;      /* the writer's slot */
  _Alignas(64) unsigned front;     /* the reader's slot */
  bool taken;                      /* the reader's slot holds a value */
  _Alignas(64) unsigned char slots[];
};

#endif
