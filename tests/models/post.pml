/* Posting and taking of setups: [main] prepares the spare plan and says so, the tick takes it, uses both plans, hands
   the replaced scene back by an event, and only then lets [main] have the spare one again.

   = lib/control/control_create.c: if (atomic_load_explicit(&control->mail.posted, memory_order_acquire)) return ETHD_STATUS_BUSY;
   = lib/control/control_create.c: ethd__plan *spare = &control->plans[1 - control->mail.ruling];
   = lib/control/control_create.c: atomic_store_explicit(&control->mail.posted, 1, memory_order_release);
   = lib/core/mail.c: if (!atomic_load_explicit(&m->posted, memory_order_acquire) || room(m) < events) return false;
   = lib/core/mail.c: m->ruling = 1 - m->ruling;
   = lib/control/control.c: atomic_store_explicit(&mail->posted, 0, memory_order_release);

   Kept: a tick never uses a plan that is being written, nor a scene that was freed; every scene that stops ruling is
   handed back once; a posted setup is taken in the end. With -DEAGER the application posts a
   replaced scene again before an event has handed it back: then it frees a scene that rules, even where it takes all
   events before it posts. */
#ifndef POSTS
#define POSTS 3
#endif
#define SCENES (POSTS + 1)
#define ROOM 2
#define NONE 255

bit posted, ruling;
byte plan[2] = {0, 0};
byte written = NONE; /* the plan that [main] is writing */
bit freed[SCENES];
chan events = [ROOM] of {byte};
byte handed[SCENES];

inline take_events() {
  do
  :: events ? [old] -> events ? old;
     if
     :: old != NONE -> assert(!freed[old]); handed[old]++; assert(handed[old] == 1); freed[old] = 1
     :: else
     fi
  :: empty(events) -> break
  od
}

active proctype application() {
  byte old, k = 1, spare;
  do
  :: k <= POSTS ->
     take_events();
     if
     :: posted /* busy */
     :: else ->
        spare = 1 - ruling;
        written = spare;
        if
        :: plan[spare] = k /* another scene */
        :: !freed[plan[ruling]] -> plan[spare] = plan[ruling] /* the same once more */
#ifdef EAGER
        :: !freed[plan[spare]] /* the one before once more, before an event handed it back */
#endif
        fi;
        written = NONE;
        posted = 1;
        k++
     fi
  :: else -> break
  od;
end:
  do
  :: nempty(events) -> take_events()
  od
}

inline use(p) {
  assert(written != p);
  assert(!freed[plan[p]])
}

active proctype tick() {
  byte from;
end:
  do
  :: from = NONE;
     if
     :: posted && len(events) < ROOM ->
        from = ruling;
        ruling = 1 - ruling
#ifdef BUG
        ;posted = 0 /* the spare plan is given back before the tick is through with it */
#endif
     :: else
     fi;
     use(ruling);
     if
     :: from != NONE ->
        use(from);
        if
        :: plan[from] != plan[ruling] -> events ! plan[from]
        :: else -> events ! NONE
        fi
#ifndef BUG
        ;posted = 0
#endif
     :: else
     fi
  od
}

ltl taken { [] (posted -> <> !posted) }
