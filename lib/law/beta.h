/* The decrease of the share of tracking near a surface. */
#ifndef ETHD__LAW_BETA_H
#define ETHD__LAW_BETA_H

#include "ethd/law.h"

/* eq. 4, 8:     1 |        .------      beta over the finger's distance d
                   |      .'
          beta_min |----.'
                   +----+---+----- d
                        0   d_beta                                       [rt] */
static inline double ethd__beta(double beta_min, double d_beta, double d) ETHD_RT {
  if (d > d_beta) return 1;
  if (d > 0) return (1 - beta_min) / d_beta * d + beta_min;
  return beta_min;
}

/* The parameter that smooth and offset have in common. */
#define ETHD__BETA_MIN_PARAM {"beta_min", "1", 0, 1, 0.1, "share of tracking that is left at the wall (beta_min)"}

#endif
