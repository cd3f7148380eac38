#include "calibrate/made.h"

#include <math.h>
#include <string.h>

#include "ethd/maths.h"
#include "sim/random.h"

#define STEP 0.25e-3 /* m */

static double spread(ethd__sim_key key, uint32_t number, double share) {
  return 1 + share * (2 * ethd__uniform(key, ETHD__STREAM_RAY, number) - 1);
}

ethd__calibration ethd__made_ring(uint64_t seed) {
  ethd__calibration c = ethd__calibration_default();
  ethd__sim_key key = {seed, 0};
  for (uint32_t k = 0; k < ETHD_RAYS; k++) {
    ethd__sensor *s = &c.sensors[k];
    s->a *= spread(key, 4 * k, 0.15);
    s->p *= spread(key, 4 * k + 1, 0.03);
    s->a *= ethd_exp((s->p - 2) * ethd_log(7e-3)); /* another exponent with the same brightness in the middle */
    s->d0 *= spread(key, 4 * k + 2, 0.12);
    s->dark = 2000 * spread(key, 4 * k + 3, 0.25);
  }
  return c;
}

/* Returns the mean of many readings, each a whole number of the chip's range. */
static double mean_counts(double light, double noise, int frames, ethd__sim_key key, uint32_t stream) {
  double sum = 0;
  for (int i = 0; i < frames; i++)
    sum += fmin(fmax(rint(light + noise * ethd__normal(key, stream, (uint32_t)i)), 1), ETHD__FRAME_SATURATED);
  return sum / frames;
}

void ethd__made_places(const ethd__calibration *truth, uint64_t seed, double noise, int frames, double ring_radius,
                       double rod, ethd__places *out) {
  double counts[ETHD_RAYS];
  memset(out, 0, sizeof *out);
  out->ring_radius = ring_radius;
  out->rod = rod;
  for (uint32_t k = 0; k < ETHD_RAYS; k++)
    out->dark[k] = mean_counts(truth->sensors[k].dark, noise, frames, (ethd__sim_key){seed, 1}, k);
  for (int i = 0; i < ETHD__PLACES_GUIDED; i++) {
    ethd_vec at = ethd__place_at(ring_radius, rod, i);
    ethd__place_reading expected = ethd__place_expected(ring_radius, rod, at);
    for (uint32_t k = 0; k < ETHD_RAYS; k++) {
      const ethd__sensor *s = &truth->sensors[k];
      double d = expected.distance[k], light = isnan(d) ? s->dark : ethd__sensor_counts(s, d);
      counts[k] = mean_counts(light, noise, frames, (ethd__sim_key){seed, 2 + (uint64_t)i}, k);
    }
    (void)ethd__places_add(out, at, counts);
  }
}

double ethd__made_error(const ethd__calibration *truth, const ethd__calibration *found) {
  double sum = 0;
  int count = 0;
  for (int k = 0; k < ETHD_RAYS; k++)
    for (double d = ETHD__MADE_FROM; d <= ETHD__MADE_TO; d += STEP, count++) {
      double light = fmin(rint(ethd__sensor_counts(&truth->sensors[k], d)), ETHD__FRAME_SATURATED);
      double e = ethd__sensor_distance(&found->sensors[k], (uint16_t)light) - d;
      sum += e * e;
    }
  return sqrt(sum / count);
}
