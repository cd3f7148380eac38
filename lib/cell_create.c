#include <stdlib.h>
#include <string.h>

#include "cell.h"
#include "error.h"

#define SIZE_MOST 65536
#define LINE 64

ethd_status ethd_cell_create(size_t size, ethd_cell **out, ethd_error *error) {
  *out = NULL;
  if (size < 1 || size > SIZE_MOST)
    return ethd__refuse(error, ETHD_E_RANGE, "cell", (ethd__found){(double)size, 1, SIZE_MOST});
  size_t stride = (size + LINE - 1) / LINE * LINE, bytes = sizeof(ethd_cell) + 3 * stride;
  ethd_cell *cell = aligned_alloc(LINE, (bytes + LINE - 1) / LINE * LINE);
  if (!cell) return ethd__error(error, ETHD_E_MEMORY, "cell");
  memset(cell, 0, bytes);
  cell->size = size;
  cell->stride = stride;
  cell->back = 0;
  cell->front = 1;
  atomic_init(&cell->middle, 2);
  *out = cell;
  return ETHD_OK;
}

void ethd_cell_destroy(ethd_cell *cell) { free(cell); }
