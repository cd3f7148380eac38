/* e: each point's distance from the fitted circle, > 0 outside. g: the change of e when every sensor counts one less.
   If every sensor counts n less, the distances are e + n g. Their sum of squares is least at n = -(e.g) / (g.g). */
#include "proximity_ring/drift.h"

#include <math.h>
#include <string.h>

#define GOOD 12       /* rays that must meet the finger */
#define STEP 100      /* counts less, for g */
#define MOST 3e-4     /* m of the radius: more is a drift */
#define EXPLAINED 0.7 /* of e e, by a drift; calibrations that are off and fingers that aren't round stay under it */

ethd_status ethd__drift_prepare(double ring_radius, double finger_radius, ethd__drift *out, ethd_error *error) {
  double p[ETHD_PARAMS_MAX] = {0};
  const ethd_method *kasa = &ethd_fit_methods[ETHD_FIT_KASA];
  memset(out, 0, sizeof *out);
  for (int k = 0; k < ETHD_RAYS; k++) {
    double angle = 2 * 3.14159265358979323846 * k / ETHD_RAYS;
    out->direction[k] = (ethd_vec){cos(angle), sin(angle)};
  }
  ethd_params_default(kasa->params, kasa->param_count, p);
  return ethd_fit_prepare(ETHD_FIT_KASA, p, ring_radius, finger_radius, &out->fit, error);
}

/* Fits a circle and returns whether enough rays lie on it; e is 0 for the others. */
static bool fit(const ethd__drift *d, const double rays[ETHD_RAYS], double e[ETHD_RAYS], double *radius) {
  ethd_finger finger;
  uint32_t used = 0;
  if (ethd_fit_step(&d->fit, rays, &finger) != ETHD_OK) return false;
  for (int k = 0; k < ETHD_RAYS; k++) {
    double along = d->fit.ring_radius - rays[k];
    double x = along * d->direction[k].x - finger.centre.x, y = along * d->direction[k].y - finger.centre.y;
    bool is_used = finger.used >> k & 1;
    e[k] = is_used ? sqrt(x * x + y * y) - finger.radius : 0;
    used += is_used;
  }
  *radius = finger.radius;
  return used >= GOOD;
}

static void judge(ethd__drift *d) {
  double counts = -d->across / d->along;
  d->offset = -counts * d->grows / d->frames;
  d->is_off = fabs(d->offset) > MOST && d->across * d->across > EXPLAINED * d->along * d->beside;
  d->across = d->along = d->beside = d->grows = 0;
  d->frames = 0;
}

void ethd__drift_step(ethd__drift *d, const ethd__calibration *c, const ethd__ring_frame *f,
                      const double rays[ETHD_RAYS]) {
  double now[ETHD_RAYS], less[ETHD_RAYS], e[ETHD_RAYS], e_less[ETHD_RAYS], radius, radius_less;
  for (int k = 0; k < ETHD_RAYS; k++) {
    uint16_t counts = f->counts[k] > STEP && f->counts[k] < ETHD__FRAME_SATURATED ? (uint16_t)(f->counts[k] - STEP) : 0;
    less[k] = counts && rays[k] < d->fit.ring_radius ? ethd__sensor_distance(&c->sensors[k], counts) : (double)NAN;
    if (!(less[k] < d->fit.ring_radius)) less[k] = (double)NAN;
    now[k] = isnan(less[k]) ? (double)NAN : rays[k];
  }
  if (!fit(d, now, e, &radius) || !fit(d, less, e_less, &radius_less)) return;
  for (int k = 0; k < ETHD_RAYS; k++) {
    double g = (e_less[k] - e[k]) / STEP;
    d->across += e[k] * g;
    d->along += g * g;
    d->beside += e[k] * e[k];
  }
  d->grows += (radius_less - radius) / STEP;
  if (++d->frames == ETHD__DRIFT_FRAMES) judge(d);
}
