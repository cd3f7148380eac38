#include "tap/seen.h"

#include <math.h>

static void put(double out[2], const double v[2]) {
  out[0] = v[0];
  out[1] = v[1];
}

ethd_truth ethd__seen(const ethd_trace *k, const ethd_setup *setup, double slack, int64_t begin_ns) {
  double off = hypot(k->xf[0] - k->x[0], k->xf[1] - k->x[1]);
  ethd_truth t = {.t = 1e-9 * (double)(k->sense.time_ns - begin_ns),
                  .pad = off - (setup->ring_radius - setup->finger_radius) + slack,
                  .pad_force = NAN};
  put(t.ring, k->x);
  put(t.ring_v, k->v);
  put(t.motor, k->x);
  put(t.motor_v, k->v);
  put(t.finger, k->xf);
  put(t.finger_v, k->vf);
  put(t.hand, k->xf);
  return t;
}
