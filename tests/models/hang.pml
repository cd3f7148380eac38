/* A step that hangs, the thread that watches, and [main], which gives the loop's thread up: who has the device, should
   the step return after all.

   = drivers/runtime/loop/cycle.c: if (atomic_exchange_explicit(&l->stepping, 0, memory_order_acq_rel) != ETHD__LOOP_LEFT) return;
   = drivers/runtime/loop/threads.c: bool taken = step > 0 && atomic_compare_exchange_strong(&l->stepping, &step, ETHD__LOOP_LEFT);
   = drivers/runtime/loop/threads.c: while (l->has_watch && !ethd_loop_ended(l) && !ethd_loop_hangs(l, NULL)) pause_a_little();
   = drivers/runtime/loop/watch.c: atomic_store_explicit(&l->hangs, w->silent >= hang, memory_order_release);

   Kept: once [main] has taken the device, the thread never touches it; a device in whose code the thread hangs isn't
   touched by [main]; join always returns. */
#ifndef TURNS
#define TURNS 3
#endif
#define OUT 0
#define IN 1
#define LEFT 2

byte stepping = OUT;
bit ended, hangs, stop, joined;
bit in_device, is_mains;

active proctype loop() {
  byte k, was;
  do
  :: k < TURNS && !stop ->
     k++;
     in_device = 1;
     assert(!is_mains);
     if
     :: true -> in_device = 0
     :: true -> hung_in_device: false /* for ever */
     fi;
     stepping = IN;
     if
     :: true
     :: true -> hung_in_step: false
     :: true -> (hangs) /* until it was seen; then it lives again */
     fi;
#ifdef BUG
     was = stepping; /* looked at, then stored */
     stepping = OUT;
#else
     atomic { was = stepping; stepping = OUT };
#endif
     if
     :: was == LEFT -> stays: false
     :: else
     fi;
     in_device = 1; /* write */
     assert(!is_mains);
     in_device = 0
  :: else -> break
  od;
  ended = 1
}

/* It says so at some time, and may say so of a thread that just came to life again. */
active proctype watch() {
  hangs = 1
}

active proctype application() {
  bit taken;
  stop = 1;
  do
  :: ended || hangs -> break
  od;
  if
  :: ended -> is_mains = 1
  :: else ->
     atomic {
       if
       :: stepping == IN -> stepping = LEFT; taken = 1
       :: else
       fi
     };
     if
     :: taken -> assert(!in_device); is_mains = 1
     :: else /* it hangs in the device, or lives: the device is left alone */
     fi
  fi;
  joined = 1
}

ltl returns { <> joined }
