#include "sim/sensors.h"

#include <math.h>
#include <stdbool.h>

#include "ethd/estimate.h"
#include "ethd/maths.h"

enum { STAMP = ETHD_RAYS / 2, PARTS = ETHD_RAYS + 1 };

static int64_t nanoseconds(double t) { return (int64_t)rint(1e9 * t); }

/* ---- joints ---- */

void ethd__sensors_joints(const ethd__sensors *s, const ethd__body *body, const double x[ETHD__DOF_MAX],
                          ethd_sense *out) {
  double count = s->plant.count;
  ethd__body_joints(body, x, out->q);
  for (int j = 0; j < 2 && count > 0; j++)
    out->q[j] = (rint(out->q[j] / count - s->count_phase[j]) + s->count_phase[j]) * count;
}

/* ---- the finger ---- */

static bool is_frame(const ethd__sensors *s) { return s->plant.reading == ETHD_READING_RAYS; }

/* Returns the instant of a part of a frame as a share of the skew. */
static double place(uint32_t part) {
  if (part == STAMP) return 0.5;
  return (double)(part < STAMP ? part : part - 1) / (ETHD_RAYS - 1);
}

static void appoint(ethd__sensors *s) {
  double skew = is_frame(s) ? s->plant.ray_skew * place(s->part) : 0;
  s->next = s->phase + (double)s->sample / s->plant.rate + skew;
}

#define NAIL_RANGE 10e-3 /* m that the nail's sensor sees */

void ethd__sensors_create(ethd__sensors *s, const ethd_sim_def *def) {
  const ethd_plant *p = &def->plant;
  if (p->reading == ETHD_READING_ZONES)
    ethd__zones_prepare((uint32_t)p->zones, p->zone_reach, def->ring_radius, p->finger_radius, p->noise, &s->zones);
  s->nail = (ethd__nail){.rest = NAIL_RANGE / 2, .furthest = NAIL_RANGE};
  ethd_sincos(p->nail_angle, &s->nail.u.y, &s->nail.u.x);
}

void ethd__sensors_start(ethd__sensors *s, const ethd_sim_def *def, const ethd_sim_tap *tap) {
  s->plant = def->plant;
  s->ring_radius = def->ring_radius;
  s->finger_radius = tap->finger_radius;
  s->phase = tap->phase;
  s->key = (ethd__sim_key){tap->seed, tap->tap};
  for (uint32_t j = 0; j < 2; j++)
    s->count_phase[j] = def->plant.count_phase ? ethd__uniform(s->key, ETHD__STREAM_ENCODER, j) : 0;
  s->sample = s->part = s->lit = 0;
  s->taken = 0;
  appoint(s);
}

static void stamp(const ethd__sensors *s, const ethd__body *body, const ethd__sim_state *state, ethd_vec true_ring,
                  ethd__sim_reading *out) {
  ethd_vec v;
  out->sample_ns = nanoseconds(s->next);
  out->have = ETHD_HAVE_RING | (is_frame(s) ? ETHD_HAVE_RAYS : ETHD_HAVE_CENTRE);
  out->noise = 0;
  out->ring = true_ring;
  if (s->plant.reference) ethd__body_motor(body, state, &out->ring, &v);
}

static void take_ray(const ethd__sensors *s, ethd_vec relative, ethd__sim_reading *out) {
  double rays[ETHD_RAYS];
  uint32_t ray = s->part < STAMP ? s->part : s->part - 1;
  ethd_fit_rays(s->ring_radius, s->finger_radius, relative, rays);
  out->rays[ray] = rays[ray] + s->plant.ray_noise * ethd__normal(s->key, ETHD__STREAM_RAY + ray, s->sample);
}

static void take_centre(const ethd__sensors *s, ethd_vec seen, ethd__sim_reading *out) {
  double noise = s->plant.noise;
  out->centre.x = seen.x + noise * ethd__normal(s->key, ETHD__STREAM_CENTRE_X, s->sample);
  out->centre.y = seen.y + noise * ethd__normal(s->key, ETHD__STREAM_CENTRE_Y, s->sample);
}

/* Takes the barriers. One that is lit goes dark only a little farther away, by the hysteresis. */
static void take_zones(ethd__sensors *s, ethd_vec relative, ethd__sim_reading *out) {
  uint32_t lit = 0;
  for (uint32_t k = 0; k < s->zones.count; k++) {
    double distance = ethd__zones_distance(&s->zones, s->finger_radius, relative, k);
    double limit = s->plant.zone_reach * (s->lit >> k & 1 ? 1 + s->plant.zone_hysteresis : 1);
    limit += s->plant.noise * ethd__normal(s->key, ETHD__STREAM_ZONE + k, s->sample);
    lit |= (uint32_t)(distance <= limit) << k;
  }
  s->lit = lit;
  if (!ethd__zones_centre(&s->zones, lit, &out->centre, &out->noise)) out->have = 0;
}

static void take_nail(const ethd__sensors *s, ethd_vec relative, ethd__sim_reading *out) {
  double noise = s->plant.noise, step = s->plant.nail_step;
  double distance =
      ethd__nail_distance(&s->nail, relative) + noise * ethd__normal(s->key, ETHD__STREAM_NAIL, s->sample);
  if (step > 0) distance = rint(distance / step) * step;
  out->noise = sqrt(noise * noise + step * step / 12);
  if (!ethd__nail_centre(&s->nail, distance, &out->centre)) out->have = 0;
}

/* Samples a sensor that measures everything at one instant. */
static void take_whole(ethd__sensors *s, ethd_vec ring, ethd_vec finger, ethd__sim_reading *out) {
  ethd_vec relative = ethd_vec_sub(finger, ring);
  switch (s->plant.reading) {
  case ETHD_READING_ZONES: take_zones(s, relative, out); break;
  case ETHD_READING_NAIL: take_nail(s, relative, out); break;
  case ETHD_READING_CAMERA:
    out->have = ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD;
    out->noise = s->plant.noise;
    take_centre(s, finger, out);
    break;
  default: take_centre(s, relative, out);
  }
}

void ethd__sensors_take(ethd__sensors *s, const ethd__body *body, const ethd__sim_state *state) {
  ethd__sim_reading *r = &s->readings[s->taken % ETHD__READINGS_MAX];
  ethd_vec ring, v, finger = {state->q[ETHD__FINGER], state->q[ETHD__FINGER + 1]};
  ethd__body_ring(body, state, &ring, &v);
  if (!is_frame(s) || s->part == STAMP) stamp(s, body, state, ring, r);
  if (!is_frame(s))
    take_whole(s, ring, finger, r);
  else if (s->part != STAMP)
    take_ray(s, ethd_vec_sub(finger, ring), r);
  if (is_frame(s) && s->part + 1 < PARTS) {
    s->part++;
  } else {
    r->due_ns = nanoseconds(s->next) + nanoseconds(s->plant.latency);
    s->part = 0;
    s->sample++;
    s->taken++;
  }
  appoint(s);
}

static void fill(const ethd__sensors *s, const ethd__sim_reading *r, ethd_sense *out) {
  ethd_vec ring = r->have & ETHD_HAVE_RING ? r->ring : (ethd_vec){0, 0};
  ethd_vec centre = r->have & ETHD_HAVE_CENTRE ? r->centre : (ethd_vec){0, 0};
  out->have |= r->have;
  out->sample_ns = r->sample_ns;
  out->finger_noise = r->noise;
  ethd_vec_put(ring, out->ring);
  ethd_vec_put(centre, out->centre);
  for (int k = 0; k < ETHD_RAYS && is_frame(s); k++) out->rays[k] = r->rays[k];
}

void ethd__sensors_deliver(const ethd__sensors *s, int64_t since_ns, ethd_sense *out) {
  uint64_t held = s->taken < ETHD__READINGS_MAX ? s->taken : ETHD__READINGS_MAX;
  for (uint64_t i = 0; i < held; i++) {
    const ethd__sim_reading *r = &s->readings[(s->taken - 1 - i) % ETHD__READINGS_MAX];
    if (r->due_ns <= since_ns) return;
    if (r->due_ns > out->time_ns) continue;
    if (r->have) fill(s, r, out);
    return;
  }
}
