/* The finger's centre and radius from the ring's 16 distances.

             r_k        Ray k leaves the ring's inner circle at angle 2 pi k / 16 (x axis = 0,
        .--<--|         counter-clockwise, in R_0: the ring doesn't turn) and runs to the ring's centre.
       (  o   |         r_k is the free distance along it, so the finger's surface lies at
        '-----'         p_k = (R_r - r_k) (cos, sin).  NaN: the ray is missing. */
#ifndef ETHD_FINGER_FIT_H
#define ETHD_FINGER_FIT_H

#include "ethd/param.h"
#include "ethd/vec.h"

ETHD_BEGIN_DECLS

#define ETHD_RAYS 16

typedef enum ethd_fit_method {
  ETHD_FIT_KASA = 0,    /* algebraic least squares (Kasa 1976) */
  ETHD_FIT_VERTEX_MEAN, /* the paper's centre of the polygon: mean of its vertices (gain 0.5) */
  ETHD_FIT_CENTROID,    /* centroid of the polygon's area */
  ETHD_FIT_ROBUST,      /* known radius, geometric least squares from kasa, outliers gated */
  ETHD_FIT_COUNT
} ethd_fit_method;

ETHD_API extern const ethd_method ethd_fit_methods[ETHD_FIT_COUNT];

typedef struct ethd_fit {
  ethd_fit_method method;
  double ring_radius, finger_radius; /* m */
  double p[ETHD_PARAMS_MAX];
} ethd_fit;

typedef struct ethd_finger {
  ethd_vec centre;  /* relative to the ring's centre, m */
  double radius;    /* m; mean distance of the vertices where the method has none of its own */
  double residual;  /* rms over the rays used, m */
  uint32_t used;    /* bit k: ray k was used */
} ethd_finger;

/* [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_fit_prepare(ethd_fit_method method, const double *p,
                                                      double ring_radius, double finger_radius,
                                                      ethd_fit *out, ethd_error *error);

/* ETHD_STALE when too few rays are left to say (3 for a circle, 2 with known radius; none beyond the
   ring's radius counts); out is then untouched. [rt] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_fit_step(const ethd_fit *fit, const double r[ETHD_RAYS],
                                                   ethd_finger *out) ETHD_RT;

/* The distances that a finger of this radius and centre gives: the fit's inverse. [any, rt-safe] */
ETHD_API void ethd_fit_rays(double ring_radius, double finger_radius, ethd_vec centre,
                            double r[ETHD_RAYS]) ETHD_RT;

ETHD_END_DECLS

#endif
