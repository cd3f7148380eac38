#include "cell.h"

#include <string.h>

static unsigned char *slot(ethd_cell *cell, unsigned i) { return cell->slots + i * cell->stride; }

void ethd_cell_put(ethd_cell *cell, const void *value) {
  memcpy(slot(cell, cell->back), value, cell->size);
  cell->back =
      atomic_exchange_explicit(&cell->middle, cell->back | ETHD__CELL_FRESH, memory_order_acq_rel) & ~ETHD__CELL_FRESH;
}

ethd_status ethd_cell_take(ethd_cell *cell, void *value) {
  bool fresh = atomic_load_explicit(&cell->middle, memory_order_relaxed) & ETHD__CELL_FRESH;
  if (fresh) {
    cell->front = atomic_exchange_explicit(&cell->middle, cell->front, memory_order_acq_rel) & ~ETHD__CELL_FRESH;
    cell->taken = true;
  }
  if (cell->taken) memcpy(value, slot(cell, cell->front), cell->size);
  return fresh ? ETHD_OK : ETHD_STATUS_STALE;
}
