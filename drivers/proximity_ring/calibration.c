#include "proximity_ring/calibration.h"

#include <math.h>
#include <string.h>

#include "ethd/maths.h"

const char *const ethd__level_names[ETHD__LEVEL_COUNT] = {"none", "common", "gain", "law", "table"};

ethd__calibration ethd__calibration_default(void) {
  ethd__calibration c;
  memset(&c, 0, sizeof c);
  c.residual = (double)NAN;
  for (int k = 0; k < ETHD_RAYS; k++) {
    ethd__sensor *s = &c.sensors[k];
    s->a = 0.5;
    s->p = 2;
    s->d0 = 0.0025;
    s->dark = s->residual = (double)NAN;
  }
  return c;
}

static double power(double base, double exponent) { return ethd_exp(exponent * ethd_log(base)); }

static double between(double x, double x0, double y0, double x1, double y1) {
  return y0 + (y1 - y0) * ((x - x0) / (x1 - x0));
}

/* Returns the coordinate in which points are joined by straight lines, because a law with p = 2 is straight in it. */
static double straight(double above) { return 1 / sqrt(above); }

/* Looks a distance up in the table; beyond its ends the first and the last line go on. */
static double look_up(const ethd__sensor *s, double above) {
  uint32_t i = 1;
  while (i + 1 < s->points && s->above[i] > above) i++;
  double d = between(straight(above), straight(s->above[i - 1]), s->at[i - 1], straight(s->above[i]), s->at[i]);
  return fmax(d, 0);
}

double ethd__sensor_distance(const ethd__sensor *s, uint16_t counts) {
  double above = counts - s->dark;
  if (counts == ETHD__FRAME_MISSING || isnan(above)) return (double)NAN;
  if (above <= 0) return ETHD__DISTANCE_MAX;
  return fmin(s->points ? look_up(s, above) : power(s->a / above, 1 / s->p) - s->d0, ETHD__DISTANCE_MAX);
}

double ethd__sensor_counts(const ethd__sensor *s, double distance) {
  uint32_t i = 1;
  if (!s->points) return s->dark + s->a / power(fmax(distance + s->d0, 1e-6), s->p);
  while (i + 1 < s->points && s->at[i] < distance) i++;
  double x = between(distance, s->at[i - 1], straight(s->above[i - 1]), s->at[i], straight(s->above[i]));
  return s->dark + 1 / (fmax(x, 1e-4) * fmax(x, 1e-4));
}
