/* The latest value of a slow feed: one thread writes, another reads, neither ever waits. Links from libethd.

   A triple buffer: the writer fills its own slot and exchanges it for the middle one; the reader exchanges its own slot
   for the middle one. The reader always gets a complete value, and the newest. */
#ifndef ETHD_CELL_H
#define ETHD_CELL_H

#include "ethd/base.h"

ETHD_BEGIN_DECLS

typedef struct ethd_cell ethd_cell;

/* Creates a cell for values of `size` bytes, 1 to 65536: else ETHD_E_RANGE; ETHD_E_MEMORY. *out is NULL then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_cell_create(size_t size, ethd_cell **out, ethd_error *error);

/* Frees the cell; NULL is allowed. [main] */
ETHD_API void ethd_cell_destroy(ethd_cell *cell);

/* Writes a value, which replaces one that hasn't been read. One writer at a time. [any, rt-safe] */
ETHD_API void ethd_cell_put(ethd_cell *cell, const void *value) ETHD_RT;

/* Reads the newest value. ETHD_STATUS_STALE: no value has been written since the last read; `value` then holds the last
   one again, or is untouched if none was ever written. One reader at a time. [any, rt-safe] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_cell_take(ethd_cell *cell, void *value) ETHD_RT;

ETHD_END_DECLS

#endif
