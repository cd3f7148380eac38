/* The finger's centre and radius from the ring's 16 distances. Links from libethd.

             r_k        Ray k leaves the ring's inner circle at angle 2 pi k / 16 (x axis = 0,
        .--<--|         counter-clockwise, in R_0: the ring doesn't turn) and runs to the ring's centre.
       (  o   |         r_k is the free distance along it, so the finger's surface lies at
        '-----'         p_k = (R_r - r_k) (cos, sin).

   A ray counts if and only if |r_k| < R_r. NaN means that it is missing. At R_r or more it has met nothing. At 0 or
   less the finger touches the ring there, within noise; dropping such rays would push the centre away from the ring. */
#ifndef ETHD_FINGER_FIT_H
#define ETHD_FINGER_FIT_H

#include "ethd/param.h"
#include "ethd/vec.h"

ETHD_BEGIN_DECLS

#define ETHD_RAYS 16

typedef enum ethd_fit_method {
  ETHD_FIT_KASA = 0,    /* least squares of |p - c|^2 - R^2 in c and R (Kasa 1976) */
  ETHD_FIT_VERTEX_MEAN, /* the paper's centre of the polygon: mean of its vertices. With all rays it
                           gives half of a small offset */
  ETHD_FIT_CENTROID,    /* centroid of the polygon's area, missing vertices left out */
  ETHD_FIT_ROBUST,      /* the same sum in c alone, R = the known finger radius: a Gauss-Newton step from
                           kasa (two from the ring's centre if that isn't such a finger), then up to two
                           without the rays over `gate` from the circle, while rays change or it moves */
  ETHD_FIT_COUNT
} ethd_fit_method;

ETHD_API extern const ethd_method ethd_fit_methods[ETHD_FIT_COUNT];

typedef struct ethd_fit {
  ethd_fit_method method;
  double ring_radius, finger_radius; /* m */
  double p[ETHD_PARAMS_MAX];
} ethd_fit;

typedef struct ethd_finger {
  ethd_vec centre; /* relative to the ring's centre, m */
  double radius;   /* rms of |p - c| over the rays used, m: kasa's R */
  double residual; /* rms of (|p - c|^2 - radius^2) / (2 radius), which is |p - c| - radius nearly, m */
  uint32_t used;   /* bit k: ray k was used */
  uint32_t reserved;
} ethd_finger;

/* Checks p against the method's table, and 1e-4 m <= finger_radius <= ring_radius <= 1 m: ETHD_E_RANGE,
   ETHD_E_NOT_FINITE or, for the method, ETHD_E_UNKNOWN, with the name; out is untouched then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_fit_prepare(ethd_fit_method method, const double *p, double ring_radius,
                                                      double finger_radius, ethd_fit *out, ethd_error *error);

/* Fits the finger to one frame of rays, m. ETHD_STALE: the rays that count don't determine a centre within the ring,
   since there are under 3 (robust: 2) or, for kasa and centroid, they lie on one line; out is then untouched. [rt] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_fit_step(const ethd_fit *fit, const double r[ETHD_RAYS],
                                                   ethd_finger *out) ETHD_RT;

/* Gives the distances, m, that a finger of this radius, m, and centre, m from the ring's, would have, the fit's
   inverse; NaN where a ray meets the ring's centre first, or nothing. [any, rt-safe] */
ETHD_API void ethd_fit_rays(double ring_radius, double finger_radius, ethd_vec centre, double r[ETHD_RAYS]) ETHD_RT;

ETHD_END_DECLS

#endif
