#include "sim/sensors.h"

#include "ethd/finger_fit.h"

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

/* ---- proximity ---- */

/* The instant of a part of a frame, as a share of the skew. */
static double place(uint32_t part) {
  if (part == STAMP) return 0.5;
  return (double)(part < STAMP ? part : part - 1) / (ETHD_RAYS - 1);
}

static void appoint(ethd__sensors *s) {
  double skew = s->plant.rays ? s->plant.ray_skew * place(s->part) : 0;
  s->next = s->phase + (double)s->sample / s->plant.rate + skew;
}

void ethd__sensors_start(ethd__sensors *s, const ethd_sim_def *def, const ethd_sim_tap *tap) {
  s->plant = def->plant;
  s->ring_radius = def->ring_radius;
  s->finger_radius = tap->finger_radius;
  s->phase = tap->phase;
  s->key = (ethd__sim_key){tap->seed, tap->tap};
  for (uint32_t j = 0; j < 2; j++)
    s->count_phase[j] = def->plant.count_phase ? ethd__uniform(s->key, ETHD__STREAM_ENCODER, j) : 0;
  s->sample = s->part = 0;
  s->taken = 0;
  appoint(s);
}

static void stamp(const ethd__sensors *s, const ethd__body *body, const ethd__sim_state *state, ethd_vec true_ring,
                  ethd__sim_reading *out) {
  ethd_vec v;
  out->sample_ns = nanoseconds(s->next);
  out->ring = true_ring;
  if (s->plant.reference) ethd__body_motor(body, state, &out->ring, &v);
}

static void take_ray(const ethd__sensors *s, ethd_vec relative, ethd__sim_reading *out) {
  double rays[ETHD_RAYS];
  uint32_t ray = s->part < STAMP ? s->part : s->part - 1;
  ethd_fit_rays(s->ring_radius, s->finger_radius, relative, rays);
  out->rays[ray] = rays[ray] + s->plant.ray_noise * ethd__normal(s->key, ETHD__STREAM_RAY + ray, s->sample);
}

static void take_centre(const ethd__sensors *s, ethd_vec relative, ethd__sim_reading *out) {
  double noise = s->plant.noise;
  out->centre.x = relative.x + noise * ethd__normal(s->key, ETHD__STREAM_CENTRE_X, s->sample);
  out->centre.y = relative.y + noise * ethd__normal(s->key, ETHD__STREAM_CENTRE_Y, s->sample);
}

void ethd__sensors_take(ethd__sensors *s, const ethd__body *body, const ethd__sim_state *state) {
  ethd__sim_reading *r = &s->readings[s->taken % ETHD__READINGS_MAX];
  ethd_vec ring, v, finger = {state->q[ETHD__FINGER], state->q[ETHD__FINGER + 1]};
  ethd__body_ring(body, state, &ring, &v);
  ethd_vec relative = ethd_vec_sub(finger, ring);
  if (!s->plant.rays || s->part == STAMP) stamp(s, body, state, ring, r);
  if (!s->plant.rays)
    take_centre(s, relative, r);
  else if (s->part != STAMP)
    take_ray(s, relative, r);
  if (s->plant.rays && s->part + 1 < PARTS) {
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
  out->have |= ETHD_HAVE_RING | (s->plant.rays ? ETHD_HAVE_RAYS : ETHD_HAVE_CENTRE);
  out->sample_ns = r->sample_ns;
  out->ring[0] = r->ring.x;
  out->ring[1] = r->ring.y;
  out->centre[0] = s->plant.rays ? 0 : r->centre.x;
  out->centre[1] = s->plant.rays ? 0 : r->centre.y;
  for (int k = 0; k < ETHD_RAYS && s->plant.rays; k++) out->rays[k] = r->rays[k];
}

void ethd__sensors_deliver(const ethd__sensors *s, int64_t since_ns, ethd_sense *out) {
  uint64_t held = s->taken < ETHD__READINGS_MAX ? s->taken : ETHD__READINGS_MAX;
  for (uint64_t i = 0; i < held; i++) {
    const ethd__sim_reading *r = &s->readings[(s->taken - 1 - i) % ETHD__READINGS_MAX];
    if (r->due_ns <= since_ns) return;
    if (r->due_ns > out->time_ns) continue;
    fill(s, r, out);
    return;
  }
}
