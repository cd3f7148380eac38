/* Frames of a made ring with a finger that moves in it. */
#ifndef ETHD_TESTS_RING_SCENE_H
#define ETHD_TESTS_RING_SCENE_H

#include "proximity_ring/receiver.h"
#include "unit/ring_frames.h"
#include "unit/ring_rod.h"

#define SCENE_DELAY 0.0042

typedef struct ring_scene {
  ethd__calibration truth;
  double noise; /* counts */
  int64_t start_ns;
} ring_scene;

/* The finger goes round at up to 0.3 m/s, 0 to 3.5 mm from the middle. */
static inline ethd_vec scene_finger(double t) {
  double r = 1.75e-3 * (1 + sin(31 * t)), angle = 23 * t;
  return (ethd_vec){r * cos(angle), r * sin(angle)};
}

static inline double scene_time(uint32_t i) { return (double)i / ETHD__FRAME_RATE; }

/* Where the finger is at the middle of frame i, and the frame, skew left out. */
static inline ethd__ring_frame scene_frame(const ring_scene *s, uint32_t i) {
  ethd__ring_frame f = {.type = ETHD__FRAME_TYPE, .seq = (uint16_t)i, .flags = i ? 0 : ETHD__FRAME_FIRST};
  double d[ETHD_RAYS];
  ethd_fit_rays(ROD_RING, ROD_RADIUS, scene_finger(scene_time(i)), d);
  f.t_us = (uint32_t)((uint64_t)i * 1000000 / ETHD__FRAME_RATE);
  for (int k = 0; k < ETHD_RAYS; k++)
    f.counts[k] = (uint16_t)rod_counts(&s->truth, k, d[k], s->noise, (uint64_t)i * ETHD_RAYS + (uint64_t)k);
  return f;
}

static inline int64_t scene_arrival(const ring_scene *s, uint32_t i) {
  return s->start_ns + (int64_t)(1e9 * (scene_time(i) + SCENE_DELAY));
}

static inline ring_scene scene_open(uint64_t seed, ethd__receiver *r) {
  ring_scene s = {rod_truth(seed), 5, 1000000000};
  memset(r, 0, sizeof *r);
  r->calibration = s.truth;
  r->clock.delay = SCENE_DELAY;
  if (ethd__plausible_prepare(ROD_RING, ROD_RADIUS, 1.5e-3, 1, 0.5e-3, &r->plausible, NULL)) abort();
  if (ethd__drift_prepare(ROD_RING, ROD_RADIUS, &r->drift, NULL)) abort();
  return s;
}

/* The frame through the receiver; false: no reading. */
static inline bool scene_feed(ethd__receiver *r, const ethd__ring_frame *frame, int64_t arrival_ns,
                              ethd__ring_reading *out) {
  uint8_t wire[ETHD__FRAME_WIRE];
  const uint8_t *at = wire;
  ethd__frame_encode(frame, wire);
  return ethd__receiver_next(r, &at, wire + sizeof wire, arrival_ns, out);
}

/* How far the reading's centre is from the finger, m. */
static inline double scene_error(const ethd__ring_reading *reading, uint32_t i) {
  static const double p[ETHD_PARAMS_MAX];
  ethd_fit fit;
  ethd_finger finger;
  if (ethd_fit_prepare(ETHD_FIT_KASA, p, ROD_RING, ROD_RADIUS, &fit, NULL)) return INFINITY;
  if (ethd_fit_step(&fit, reading->rays, &finger) != ETHD_OK) return INFINITY;
  ethd_vec e = ethd_vec_sub(finger.centre, scene_finger(scene_time(i)));
  return sqrt(ethd_vec_dot(e, e));
}

#endif
