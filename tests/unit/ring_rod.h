/* A made ring: 16 sensors that differ, and a rod in it. */
#ifndef ETHD_TESTS_RING_ROD_H
#define ETHD_TESTS_RING_ROD_H

#include <math.h>

#include "draw.h"
#include "proximity_ring/calibration_fit.h"

#define ROD_RING 0.012
#define ROD_RADIUS 0.0075
#define ROD_PLACES 17 /* in the middle, then touching the ring at each sensor */

static inline double rod_spread(uint64_t key, double share) { return 1 + share * (2 * draw(key, 0, 1) - 1); }

/* Sensors as they may come: gains within 15 %, exponents 3 %, offsets 12 %, darks 25 %. */
static inline ethd__calibration rod_truth(uint64_t seed) {
  ethd__calibration c = ethd__calibration_default();
  for (uint64_t k = 0; k < ETHD_RAYS; k++) {
    ethd__sensor *s = &c.sensors[k];
    s->a *= rod_spread(seed * 1000 + 4 * k, 0.15);
    s->p *= rod_spread(seed * 1000 + 4 * k + 1, 0.03);
    s->a *= pow(7e-3, s->p - 2); /* another exponent, as bright in the middle */
    s->d0 *= rod_spread(seed * 1000 + 4 * k + 2, 0.12);
    s->dark = 2000 * rod_spread(seed * 1000 + 4 * k + 3, 0.25);
  }
  return c;
}

static inline ethd_vec rod_place(int i) {
  double angle = 6.28318530717958648 * (i - 1) / 16, r = i ? ROD_RING - ROD_RADIUS : 0;
  return (ethd_vec){r * cos(angle), r * sin(angle)};
}

/* What sensor k counts at a distance, with noise; clamped as the chip does. */
static inline double rod_counts(const ethd__calibration *truth, int k, double distance, double noise, uint64_t key) {
  double c = isnan(distance) ? truth->sensors[k].dark : ethd__sensor_counts(&truth->sensors[k], distance);
  return fmin(fmax(rint(c + noise * draw_normal(key)), 1), 65535);
}

static inline ethd__place_reading rod_reading(const ethd__calibration *truth, ethd_vec centre, double noise,
                                              uint64_t key) {
  ethd__place_reading place = ethd__place_expected(ROD_RING, ROD_RADIUS, centre);
  for (int k = 0; k < ETHD_RAYS; k++)
    place.counts[k] = rod_counts(truth, k, place.distance[k], noise, key * ETHD_RAYS + (uint64_t)k);
  return place;
}

#endif
