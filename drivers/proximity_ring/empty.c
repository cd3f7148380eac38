#include "proximity_ring/empty.h"

#include <math.h>

#include "text/error_text.h"

void ethd__empty_add(ethd__empty *e, const ethd__ring_frame *frame) {
  e->frames++;
  for (int k = 0; k < ETHD_RAYS; k++) {
    uint16_t counts = frame->counts[k];
    if (counts == ETHD__FRAME_MISSING || counts == ETHD__FRAME_SATURATED) continue;
    e->seen[k]++;
    e->sum[k] += counts;
  }
}

static double most(const ethd__sensor *s, double ring_radius) {
  return isnan(s->dark) ? ETHD__DARK_MOST : ethd__sensor_counts(s, 2 * ring_radius);
}

static ethd_status check_sensor(const ethd__empty *e, int k, double ring_radius, ethd__sensor *s, char *message) {
  double mean = e->sum[k] / e->seen[k], allowed = most(s, ring_radius);
  if (mean > allowed)
    return ethd__say(
        message, ETHD_E_DEVICE,
        "sensor %d counts %.0f, at most %.0f are allowed in an empty ring: remove the object, or clean the ring", k,
        mean, allowed);
  s->dark = mean;
  return ETHD_OK;
}

ethd_status ethd__empty_check(const ethd__empty *e, double ring_radius, ethd__calibration *c,
                              char message[ETHD_MESSAGE_MAX]) {
  ethd__calibration got = *c;
  int good = 0;
  for (int k = 0; k < ETHD_RAYS; k++) {
    if (2 * e->seen[k] <= e->frames) {
      got.sensors[k].dark = (double)NAN;
      continue;
    }
    ethd_status status = check_sensor(e, k, ring_radius, &got.sensors[k], message);
    if (status) return status;
    good++;
  }
  if (good < ETHD__GOOD_LEAST)
    return ethd__say(message, ETHD_E_DEVICE,
                     "%d sensor%s in an empty ring, at least %d are needed: are all boards connected?", good,
                     good == 1 ? " answers" : "s answer", ETHD__GOOD_LEAST);
  *c = got;
  return ETHD_OK;
}
