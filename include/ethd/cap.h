/* The fingertip in a cap: a sphere fitted to distances along given rays. Links from libethd.

   A cap over the fingertip follows it in space, as the ring does in the plane (Yoshikawa and Nagura 1999).

                 out                 Ray k starts at from_k on the cap's inside and runs along a unit vector into the
           rim    ^                  cap. r_k is the free distance along it, so that the finger's surface lies at
         |--------|--------|         p_k = from_k + r_k along_k.
         |      .---.      |
         |---> (  c  ) <---|         All vectors are relative to the cap's origin, where the centre c of a finger
          \     '---'     /          rests, in a frame that is fixed to the cap.
           '.     ^     .'
             '----|----'

   A ray counts if and only if |r_k| < reach. NaN means that it is missing; at `reach` or more it has met nothing. At 0
   or less the finger touches the cap there, within noise. */
#ifndef ETHD_CAP_H
#define ETHD_CAP_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/base.h"
#include "ethd/maths.h"

ETHD_BEGIN_DECLS

#define ETHD_CAP_RAYS_MAX 32

typedef struct ethd_cap_ray {
  ethd_vec3 from;  /* m */
  ethd_vec3 along; /* unit vector */
} ethd_cap_ray;

/* A cap. Plain value; all functions below except ethd_cap_check need one that ethd_cap_check has accepted. */
typedef struct ethd_cap {
  ethd_cap_ray rays[ETHD_CAP_RAYS_MAX];
  uint32_t count;       /* rays */
  bool seeks_radius;    /* the finger's radius is fitted too, which needs one more ray */
  double finger_radius; /* m: the known radius, or the start of its fit */
  double reach;         /* m */
  double gate;          /* m: largest accepted residual of a ray: its noise and the radius' error */
  ethd_vec3 rim, out;   /* a point of the rim's plane, m; the plane's unit normal, out of the cap */
  double rim_margin;    /* m: how far beyond the rim a finger's centre still counts as in the cap */
} ethd_cap;

typedef struct ethd_cap_finger {
  ethd_vec3 centre; /* m */
  double radius;    /* m: the fitted radius; with a known radius the rms of |p - c| over the rays used */
  double residual;  /* m: rms of the used rays' residuals */
  uint32_t used;    /* bit k: ray k was used */
  bool gone;        /* the centre is over rim_margin beyond the rim: row FINGER_OUT of the fault table */
} ethd_cap_finger;

/* Checks a cap: 3 (seeks_radius: 4) to 32 rays, directions and `out` of length 1 within 1e-6, lengths of at most 1 m,
   1e-4 m <= finger_radius, 1e-5 m <= gate, 0 < reach, 0 <= rim_margin, and rays that aren't all in one plane and that
   determine a finger in the origin. ETHD_E_RANGE or ETHD_E_NOT_FINITE with the field's name. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_cap_check(const ethd_cap *cap, ethd_error *error);

/* Fits the finger to one frame of `count` distances, m. It minimises the sum of (r_k - rho_k)^2, where rho_k is the
   distance at which ray k meets the sphere: the maximum of the likelihood for distances of equal, normal noise. It
   starts from the mean of p_k + R along_k, as if each ray met the finger at right angles. It takes two steps with all
   rays that count, then Gauss-Newton steps with the rays that meet the sphere at less than 70.5 degrees from its normal
   and within `gate`. At larger angles a distance changes by over 3 times as much as the finger moves.
   ETHD_STATUS_STALE: the rays don't determine a finger: too few of them count, they come from too few sides, fewer than
   half of those that count fit, or the steps don't converge; out is then untouched. [rt] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_cap_step(const ethd_cap *cap, const double *r, ethd_cap_finger *out) ETHD_RT;

/* Gives the `count` distances, m, to a finger of this radius, m, and centre (the fit's inverse); NaN where a ray misses
   it. [any, rt-safe] */
ETHD_API void ethd_cap_rays(const ethd_cap *cap, ethd_vec3 centre, double radius, double *r) ETHD_RT;

/* Gives the least standard deviation, m, that an unbiased estimate of the centre can have in x, y and z, for
   distances of independent normal noise, sd `noise`, m (Cramer-Rao: the inverse of sum g_k g_k^T / noise^2, g_k = n_k /
   (n_k . along_k), with a last component of 1 / (n_k . along_k) if the radius is sought; n_k: the sphere's normal where
   ray k meets it). Rays count as in the fit. ETHD_STATUS_STALE: they don't determine the finger; sd is then untouched.
   [any, rt-safe] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_cap_bound(const ethd_cap *cap, ethd_vec3 centre, double noise,
                                                    ethd_vec3 *sd) ETHD_RT;

ETHD_END_DECLS

#endif
