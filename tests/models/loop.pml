/* The loop's thread, and [main], which enables, disarms, stops and joins: who has the device.

   = drivers/runtime/loop/cycle.c: return atomic_compare_exchange_strong_explicit(&l->mode, &mode, ETHD__LOOP_PARKED, memory_order_acq_rel,
   = drivers/runtime/loop/cycle.c: if (parked(l)) {
   = drivers/runtime/loop/cycle.c: while (!failure && !told_to_stop(l)) failure = ethd__loop_turn(l);
   = drivers/runtime/loop/cycle.c: ethd__loop_rest(l);
   = drivers/runtime/loop/threads.c: atomic_store_explicit(&l->mode, ETHD__LOOP_ASKED, memory_order_release);
   = drivers/runtime/loop/threads.c: return !atomic_compare_exchange_strong(&l->mode, &asked, ETHD__LOOP_RUNS);
   = drivers/runtime/loop/threads.c: atomic_store_explicit(&l->mode, ETHD__LOOP_RUNS, memory_order_release);
   = drivers/runtime/loop/threads.c: atomic_store_explicit(&l->ended, 1, memory_order_release);

   Kept: never two in the device; the thread ends once it is told to, whatever enabling does; the last that is written
   is zero torque. Patience may be lost at any moment. */
#ifndef ENABLES
#define ENABLES 3
#endif
mtype = {RUNS, ASKED, PARKED};

mtype mode = RUNS;
bit stop, ended, armed = 1;
byte inside;        /* threads in the device */
byte torque;        /* written last */

inline into() { inside++; assert(inside == 1) }
inline out_of() { inside-- }

active proctype loop() {
  bit is_parked;
  do
  :: stop && mode == RUNS -> break
  :: !(stop && mode == RUNS) ->
#ifdef BUG
     if /* looked at, then stored: [main] may have lost its patience in between */
     :: mode == ASKED -> mode = PARKED; is_parked = 1
     :: mode == PARKED -> is_parked = 1
     :: mode == RUNS -> is_parked = 0
     fi;
#else
     atomic {
       if
       :: mode == ASKED -> mode = PARKED
       :: else
       fi;
       is_parked = mode == PARKED
     };
#endif
     if
     :: is_parked /* sleeps a period */
     :: else ->
        into();
        torque = armed;
        out_of()
     fi
  od;
  into();
  torque = 0;
  out_of();
  ended = 1
}

active proctype application() {
  byte k;
  bit has;
  do
  :: k < ENABLES ->
     k++;
     mode = ASKED;
     has = 0;
     do
     :: mode == PARKED -> has = 1; break
     :: true -> /* patience */
        atomic {
          if
          :: mode == ASKED -> mode = RUNS
          :: else -> has = 1
          fi
        };
        break
     od;
     if
     :: has -> into(); armed = 1; out_of(); mode = RUNS
     :: else
     fi;
     if
     :: armed = 0
     :: true
     fi
  :: break
  od;
  stop = 1;
  ended; /* join */
  assert(torque == 0 && inside == 0)
}

ltl ends { [] (stop -> <> ended) }
