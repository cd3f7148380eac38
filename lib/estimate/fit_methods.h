/* The fits behind ethd_fit_step. */
#ifndef ETHD__ESTIMATE_FIT_METHODS_H
#define ETHD__ESTIMATE_FIT_METHODS_H

#include <stdbool.h>

#include "ethd/estimate.h"
#include "maths/two.h"

/* Rows of the table of the robust fit. */
enum { ROBUST_GATE };

enum { ETHD__PAIRS = ETHD_RAYS / 2 };

/* The points at which the rays meet the finger, relative to the ring's centre; pair i holds rays 2 i and 2 i + 1. A fit
   that drops a ray clears it in `counts` and `used`. */
typedef struct ethd__points {
  two x[ETHD__PAIRS], y[ETHD__PAIRS]; /* 0 for a ray that met nothing */
  two_bits counts[ETHD__PAIRS];       /* all bits set for a ray that counts, else none */
  uint32_t used;                      /* bit k: ray k counts */
} ethd__points;

static inline ethd_vec ethd__point(const ethd__points *points, int ray) {
  return (ethd_vec){points->x[ray / 2][ray % 2], points->y[ray / 2][ray % 2]};
}

/* Each fits the points and returns false if they don't determine a centre. [rt] */
bool ethd__fit_kasa(const ethd__points *points, ethd_vec *centre) ETHD_RT;
bool ethd__fit_robust(const ethd_fit *fit, ethd__points *points, ethd_vec *centre) ETHD_RT;
bool ethd__fit_vertex_mean(const ethd__points *points, ethd_vec *centre) ETHD_RT;
bool ethd__fit_centroid(const ethd__points *points, ethd_vec *centre) ETHD_RT;

/* Does what ethd_fit_step does, for rays that weren't measured at one instant: ray k was measured lag[k] s early. The
   finger moves at v m/s relative to the ring, so each point is moved on by v lag[k]. [rt] */
ethd_status ethd__fit_moving(const ethd_fit *fit, const double r[ETHD_RAYS], const double lag[ETHD_RAYS], ethd_vec v,
                             ethd_finger *out) ETHD_RT;

static inline uint32_t ethd__points_used(const two_bits counts[ETHD__PAIRS]) {
  two_bits used = {0, 0}, bit = {1, 2};
  for (int i = 0; i < ETHD__PAIRS; i++, bit <<= 2) used |= counts[i] & bit;
  return (uint32_t)(used[0] | used[1]);
}

/* Returns the number of set bits of 16, summed in pairs, fours and eights. */
static inline double ethd__count(uint32_t bits) {
  bits -= bits >> 1 & 0x5555;
  bits = (bits & 0x3333) + (bits >> 2 & 0x3333);
  bits = (bits + (bits >> 4)) & 0x0f0f;
  return (bits + (bits >> 8)) & 0x1f;
}

#endif
