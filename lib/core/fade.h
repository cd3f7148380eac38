/* Fades a command, so that it never jumps. All [rt].

     soft g + left delta -> command

   soft    after an acknowledged fault rises from 0 to 1 over swap_time, so the command rises from zero for any command
           of the laws
   left    after a swap falls from 1 to 0 over swap_time
   delta   old - soft g at the tick of the swap, where `old` is the old plan's command under its own limits: so no swap
           makes the command jump
   A stop isn't faded. */
#ifndef ETHD__CORE_FADE_H
#define ETHD__CORE_FADE_H

#include "core/state.h"

/* Ends what fades. */
static inline void ethd__fade_end(ethd__fade *fade) ETHD_RT {
  fade->soft = fade->elapsed = (double)INFINITY;
  fade->active = false;
}

/* Advances by this tick and returns whether a fade is active. soft: a fault was acknowledged; swap: a swap begins. */
static inline bool ethd__fade_advance(ethd__fade *fade, double dt, bool soft, bool swap) ETHD_RT {
  if (!fade->active && !soft && !swap) return false;
  if (soft) fade->soft = -dt;
  if (swap) fade->elapsed = -dt;
  fade->active = true;
  fade->soft += dt;
  fade->elapsed += dt;
  return true;
}

/* The start of a fade at this tick. */
typedef struct ethd__fade_start {
  bool soft;         /* a fault was acknowledged */
  const double *old; /* at a swap, the old plan's command; NULL: none */
  double swap_time;  /* s */
} ethd__fade_start;

/* Fades the command, of `count` numbers up to 3, and returns the remaining share of the swap's difference. */
double ethd__fade_apply(ethd__fade *fade, const ethd__fade_start *start, int count, double *command) ETHD_RT;

#endif
