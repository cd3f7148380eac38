/* How a command changes without a jump. All [rt].

     soft g + left delta -> command

   soft    after an acknowledged fault rises from 0 to 1 over swap_time, so the command rises from zero whatever the laws
           ask for meanwhile
   left    from a swap on falls from 1 to 0 over swap_time
   delta   old - soft g at the tick of the swap, where `old` is the command that the old plan would have given under its
           own limits: so the swap doesn't jump, whatever it changes
   A stop isn't faded. */
#ifndef ETHD__CORE_FADE_H
#define ETHD__CORE_FADE_H

#include "core/state.h"

/* Ends what fades. */
static inline void ethd__fade_end(ethd__fade *fade) ETHD_RT {
  fade->soft = fade->elapsed = (double)INFINITY;
  fade->active = false;
}

/* Advances by this tick and returns whether anything fades. soft: a fault was acknowledged; swap: a swap begins. */
static inline bool ethd__fade_advance(ethd__fade *fade, double dt, bool soft, bool swap) ETHD_RT {
  if (!fade->active && !soft && !swap) return false;
  if (soft) fade->soft = -dt;
  if (swap) fade->elapsed = -dt;
  fade->active = true;
  fade->soft += dt;
  fade->elapsed += dt;
  return true;
}

/* What a fade starts from at this tick. */
typedef struct ethd__fade_start {
  bool soft;         /* a fault was acknowledged */
  const double *old; /* at a swap, what the old plan would have commanded; NULL: none */
  double swap_time;  /* s */
} ethd__fade_start;

/* Fades the command, of `count` numbers up to 3, and returns the share of the swap's difference that is left. */
double ethd__fade_apply(ethd__fade *fade, const ethd__fade_start *start, int count, double *command) ETHD_RT;

#endif
