/* Learns k, the ring's real deceleration over its model's, from the ring's distance while it brakes.

   Since braking began the ring has travelled y more than at constant speed, and the model x more; both are negative.
   Its deceleration is k times the model's:

     x = integral of the model's acceleration, twice     y = d_0 - d - v_0 t     y = s + k x

   s is the stretch of an elastic transmission: the encoders sit on its motors' side, which yields before the ring does
   (0.5 mm on plant p, where x is 2 mm: y/x would say 1.25). It appears within some ms and stays, so k is the slope of y
   over x by least squares, from SETTLED on, until the ring stands or the finger comes. Earlier brakings count with
   weight 1 - learn, and the prior is 1. A braking that ended deeper than planned never raises k. [rt] */
#ifndef ETHD__LAW_BRAKE_LEARNER_H
#define ETHD__LAW_BRAKE_LEARNER_H

#include <stdbool.h>

#include "ethd/base.h"

#define ETHD__SETTLED 5e-3 /* s: then the transmission's stretch is complete and no longer oscillates */
#define ETHD__UNSURE 0.05  /* error of k that friction, delay and sampling cause where the facts are right */
#define ETHD__PRIOR 9e-8   /* m^2: weight of the prior, as a sum of (x - mean)^2 */

/* One braking. */
typedef struct ethd__brake_learner {
  double from, v, t;          /* d_0, v_0; s since then */
  double x, speed;            /* of the model, without v_0 */
  double n, sx, sy, sxx, sxy; /* sums over ticks */
  bool done;
} ethd__brake_learner;

/* Returns k by the sums. */
static inline double ethd__brake_slope(const double *memory) ETHD_RT {
  return (memory[0] + ETHD__PRIOR) / (memory[1] + ETHD__PRIOR);
}

/* Returns k minus its uncertainty: 1 within UNSURE of 1, since the facts then count as right. */
static inline double ethd__brake_learnt(const double *memory) ETHD_RT {
  double k = ethd__brake_slope(memory);
  if (k > 1 + ETHD__UNSURE) return k - ETHD__UNSURE;
  return k < 1 - ETHD__UNSURE ? k + ETHD__UNSURE : 1;
}

static inline void ethd__brake_learner_begin(ethd__brake_learner *l, double d, double v) ETHD_RT {
  *l = (ethd__brake_learner){.from = d, .v = v};
}

/* Adds a tick of T s at whose end the ring is at d; its force came `delay` s late. */
static inline void ethd__brake_learner_add(ethd__brake_learner *l, double model, double d, double T,
                                           double delay) ETHD_RT {
  if (l->done) return;
  l->x += l->speed * T + model * T * T / 2;
  l->speed += model * T;
  l->t += T;
  if (l->t < ETHD__SETTLED) return;
  double x = l->x - l->speed * delay, y = l->from - d - l->v * l->t;
  l->n++;
  l->sx += x;
  l->sy += y;
  l->sxx += x * x;
  l->sxy += x * y;
}

/* Ends a braking, `deeper` m behind its plan, and adds its result to the memory. */
static inline void ethd__brake_learner_end(ethd__brake_learner *l, double deeper, double learn,
                                           double *memory) ETHD_RT {
  if (l->done) return;
  l->done = true;
  if (l->n < 2) return;
  double xy = l->sxy - l->sx * l->sy / l->n, xx = l->sxx - l->sx * l->sx / l->n;
  if (deeper > 0 && xy > xx * ethd__brake_slope(memory)) return;
  const double sums[2] = {(1 - learn) * memory[0] + xy, (1 - learn) * memory[1] + xx};
  double k = ethd__brake_slope(sums);
  if (!(k > 0.25 && k < 4)) return; /* this ring can't have braked so */
  memory[0] = sums[0];
  memory[1] = sums[1];
}

#endif
