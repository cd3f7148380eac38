/* The ring from one writer to one reader: events of the controller, rows of the loop. Counters run on and wrap round.

   = lib/core/mail.c: (atomic_load_explicit(&m->head, memory_order_relaxed) - atomic_load_explicit(&m->tail, memory_order_acquire));
   = lib/core/mail.c: m->at[head % ETHD__EVENTS] = *event;
   = lib/core/mail.c: atomic_store_explicit(&m->head, head + 1, memory_order_release);
   = lib/core/mail.c: if (tail == atomic_load_explicit(&m->head, memory_order_acquire)) return ETHD_STATUS_EMPTY;
   = lib/core/mail.c: *out = m->at[tail % ETHD__EVENTS];
   = lib/core/mail.c: atomic_store_explicit(&m->tail, tail + 1, memory_order_release);
   = drivers/runtime/loop/cycle.c: ethd__loop_copy(l, &l->row, r->at + (head % r->size) * r->bytes);
   = drivers/runtime/loop/cycle.c: atomic_store_explicit(&r->head, head + 1, memory_order_release);
   = drivers/runtime/loop/loop.c: ethd__loop_copy(l, r->at + (tail % r->size) * r->bytes, out);

   Kept: what was pushed is taken whole, once, in order; and in the end, all of it. */
#ifndef SIZE
#define SIZE 2
#endif
#ifndef COUNT
#define COUNT 6
#endif
#define WRAP (2 * SIZE) /* of the counters */
#define ROOM (SIZE - ((head - tail + WRAP) % WRAP))

byte head, tail, low[SIZE], high[SIZE]; /* an element in two halves, so that a torn one shows */
byte pushed, taken;

active proctype writer() {
  do
  :: pushed < COUNT ->
     if
     :: ROOM > 0 ->
#ifdef BUG
        byte at = head % SIZE;
        head = (head + 1) % WRAP; /* published before it is there */
        low[at] = pushed;
        high[at] = pushed;
#else
        low[head % SIZE] = pushed;
        high[head % SIZE] = pushed;
        head = (head + 1) % WRAP;
#endif
        pushed++
     :: else /* no room; it tries again */
     fi
  :: else -> break
  od
}

active proctype reader() {
  byte a, b;
  do
  :: taken < COUNT ->
     if
     :: tail != head ->
        a = low[tail % SIZE];
        b = high[tail % SIZE];
        tail = (tail + 1) % WRAP;
        assert(a == b && a == taken);
        taken++
     :: else
     fi
  :: else -> break
  od
}

ltl all_of_it { <> (taken == COUNT) }
