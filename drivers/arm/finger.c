#include "arm/finger.h"

#include <math.h>

#include "sim/random.h"

ethd__arm_finger ethd__arm_finger_at(ethd_vec3 meet, ethd_vec3 n) {
  const ethd_vec3 up = {fabs(n.z) > 0.999 * ethd_vec3_norm(n), 0, fabs(n.z) <= 0.999 * ethd_vec3_norm(n)};
  const ethd_vec3 side = ethd_vec3_cross(up, n), unit = ethd_vec3_scale(1 / ethd_vec3_norm(n), n);
  const ethd_vec3 across = ethd_vec3_scale(1 / ethd_vec3_norm(side), side);
  return (ethd__arm_finger){.meet = meet, .n = unit, .across = across, .up = ethd_vec3_cross(unit, across)};
}

void ethd__arm_finger_true(const ethd__arm_finger *f, double t, ethd_vec3 *x, ethd_vec3 *v) {
  ethd_vec at, speed;
  ethd_path_at(&f->path, t - f->begin, &at, &speed);
  *x = ethd_vec3_add(f->meet, ethd_vec3_sub(ethd_vec3_scale(at.y, f->across), ethd_vec3_scale(at.x, f->n)));
  *v = ethd_vec3_sub(ethd_vec3_scale(speed.y, f->across), ethd_vec3_scale(speed.x, f->n));
  if (!f->rise.sample_count) return;
  ethd_path_at(&f->rise, t - f->begin, &at, &speed);
  *x = ethd_vec3_add(*x, ethd_vec3_scale(at.y, f->up));
  *v = ethd_vec3_add(*v, ethd_vec3_scale(speed.y, f->up));
}

void ethd__arm_finger_read(ethd__arm_finger *f, int64_t time_ns, ethd_space_sense *out) {
  if (!(f->rate > 0)) return;
  const double now = 1e-9 * (double)time_ns;
  const int64_t arrived = (int64_t)floor((now - f->latency) * f->rate + 1e-6) + 1; /* the first one at 0 */
  if (arrived <= f->given) return;
  f->given = arrived;
  const int64_t sample_ns = (int64_t)rint(1e9 * (double)(arrived - 1) / f->rate);
  const ethd__sim_key key = {f->seed, f->tap};
  ethd_vec3 x, v;
  ethd__arm_finger_true(f, 1e-9 * (double)sample_ns, &x, &v);
  x = ethd_vec3_add(x, ethd_vec3_scale(f->bias, f->n));
  ethd_vec3_put(x, out->reading);
  for (uint32_t i = 0; i < 3; i++)
    out->reading[i] += f->noise * ethd__normal(key, ETHD__STREAM_CENTRE_X, 3 * (uint32_t)arrived + i);
  out->sample_ns = sample_ns;
  out->reading_noise = f->noise;
  out->have |= ETHD_SPACE_HAVE_READING;
}
