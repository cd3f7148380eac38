/* Estimates position and speed of a ring that approaches a surface, and the acceleration that its model leaves out.

   Fading-memory polynomial filter of the second degree (Morrison 1969, Introduction to Sequential Smoothing and
   Prediction, chapter 13). It subtracts the motion by the model's acceleration from the past distances and fits a
   parabola to the rest by least squares; a sample of j ticks ago has the weight b^j. It predicts, and corrects by the
   residual e of the measured distance:

     d -= v T + (model + w) T^2/2     v += (model + w) T       d < 0: behind the surface, v > 0: towards it
     d += (1 - b^3) e     v -= 3/2 (1 - b^2)(1 - b) e/T     w -= (1 - b)^3 e/T^2

   All three poles are at b. A constant w leaves no error, so the speed isn't late when a ring brakes. Noise of the
   distances reaches the speed as  (1 - b)^3 (13 + 50 b + 49 b^2) / (2 (1 + b)^5) / T^2  times its variance. [rt] */
#ifndef ETHD__LAW_RING_OBSERVER_H
#define ETHD__LAW_RING_OBSERVER_H

#include "ethd/base.h"

typedef struct ethd__ring_observer {
  double d, v; /* m to the surface, m/s */
  double w;    /* m/s^2 that the model leaves out */
} ethd__ring_observer;

/* Predicts and corrects; returns e. */
static inline double ethd__ring_predict(ethd__ring_observer *o, double model, double d, double T) ETHD_RT {
  double a = model + o->w;
  o->d -= o->v * T + a * T * T / 2;
  o->v += a * T;
  return d - o->d;
}

static inline void ethd__ring_correct(ethd__ring_observer *o, double e, double b, double T) ETHD_RT {
  const double g = 1 - b;
  double rate = e / T;
  o->d += (1 - b * b * b) * e;
  o->v -= 1.5 * (1 - b * b) * g * rate;
  o->w -= g * g * g * rate / T;
}

#endif
