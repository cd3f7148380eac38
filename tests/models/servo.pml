/* A servo's questions and answers on a line without transaction numbers. An answer may come late, or twice as late as
   the line was waited for; it may get lost. After any error nothing is sent until the line was quiet, and every answer
   has to show what was written with its question.

   = drivers/servo/link.c: l->draining = got != ETHD__SERVO_BUSY;
   = drivers/servo/link.c: ethd__servo_outcome got = ethd__servo_bus_drain(&l->bus);
   = drivers/servo/link.c: l->echo_failed = !echoes(l);
   = drivers/servo/link.c: if (l->echo_failed) return stale(l);
   = drivers/servo/link.c: l->counter = next_count(l);
   = drivers/servo/bus.c: if (n > 0) since = ethd__clock_now();

   Kept: an answer that is used belongs to the question that was asked last. With -DQUIET every answer comes while the
   line is still being drained: then the same holds for a drive that echoes nothing. */
#ifndef QUESTIONS
#define QUESTIONS 4
#endif

chan question = [2] of {byte};
chan answer = [3] of {byte};
byte asked, used;
byte pending; /* questions that the drive still has to answer */

active proctype drive() {
  byte q;
end:
  do
  :: question ? q ->
     if
     :: answer ! q; /* as late as it likes: this process may wait here */
     :: true        /* lost */
     fi;
     pending--
  od
}

active proctype master() {
  byte k, got;
  bit draining;
  do
  :: k < QUESTIONS && nfull(question) ->
     k++;
     if
     :: draining ->
#ifdef QUIET
        do /* quiet for longer than any answer takes */
        :: answer ? got
        :: empty(answer) && pending == 0 -> break
        od;
#else
        do /* quiet for a while; what is still on its way comes later */
        :: answer ? got
        :: empty(answer) -> break
        od;
#endif
        draining = 0
     :: else
     fi;
     asked = k;
     pending++;
     question ! k;
     if
     :: answer ? got ->
#ifndef QUIET
#ifndef BUG
        if
        :: got != asked -> draining = 1 /* the echo is of another question */
        :: else -> used = got; assert(used == asked)
        fi
#else
        used = got;
        assert(used == asked)
#endif
#else
        used = got;
        assert(used == asked)
#endif
     :: true -> /* too late */
#ifdef QUIET
#ifndef BUG
        draining = 1
#endif
#else
        draining = 1
#endif
     fi
  :: else -> break
  od
}
