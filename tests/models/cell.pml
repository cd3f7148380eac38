/* ethd_cell: the newest value from one thread to another, by three slots and one exchange.

   = lib/cell.c: memcpy(slot(cell, cell->back), value, cell->size);
   = lib/cell.c: atomic_exchange_explicit(&cell->middle, cell->back | ETHD__CELL_FRESH, memory_order_acq_rel) & ~ETHD__CELL_FRESH;
   = lib/cell.c: bool fresh = atomic_load_explicit(&cell->middle, memory_order_relaxed) & ETHD__CELL_FRESH;
   = lib/cell.c: cell->front = atomic_exchange_explicit(&cell->middle, cell->front, memory_order_acq_rel) & ~ETHD__CELL_FRESH;

   Kept: a value is never torn, never older than the one before; the last one put is taken in the end. */
#ifndef PUTS
#define PUTS 5
#endif
#define FRESH 4

byte low[3], high[3];
byte middle = 1; /* a slot, and FRESH */
byte got;

active proctype writer() {
  byte back = 0, old, n = 1;
  do
  :: n <= PUTS ->
     low[back] = n;
     high[back] = n;
     atomic { old = middle; middle = back | FRESH };
     back = old & 3;
     n++
  :: else -> break
  od
}

active proctype reader() {
  byte front = 2, old, a, b;
  do
  :: got < PUTS ->
     if
     :: middle & FRESH ->
#ifdef BUG
        old = middle; /* not one exchange, but a load and a store */
        middle = front;
#else
        atomic { old = middle; middle = front };
#endif
        front = old & 3;
        a = low[front];
        b = high[front];
        assert(a == b);
        assert(a > got);
        got = a
     :: else
     fi
  :: else -> break
  od
}

ltl newest { <> (got == PUTS) }
