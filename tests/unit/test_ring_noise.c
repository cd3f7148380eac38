/* Frames damaged on the wire: how many pass the CRC, and how many of those the judgement behind it.
   ETHD_RING_FRAMES damaged frames (20 000), each between two good ones; then a twentieth of that whose CRC was made
   right again, so that the judgement alone stands between them and the filter. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "unit/rig.h"
#include "unit/ring_scene.h"

enum { LOOP = 3000 }; /* frames of the scene, over and over: the finger is back where it began after 1000 s only */

static ethd__receiver r;
static ethd__ring_frame scene[LOOP];

typedef struct count {
  uint64_t damaged, passed_crc, used, good_lost;
  double worst, sum; /* m, m^2: the largest error of a used damaged frame's centre; squares */
  uint64_t off;      /* used ones whose centre is over 0.5 mm off */
} count;

/* Frame i of a stream that never ends: there and back through the scene, so that the finger never leaps. */
static uint32_t part(uint64_t i) {
  uint32_t at = (uint32_t)(i % (2 * LOOP - 2));
  return at < LOOP ? at : 2 * LOOP - 2 - at;
}

static ethd__ring_frame frame_of(uint64_t i) {
  ethd__ring_frame f = scene[part(i)];
  f.flags = i ? 0 : ETHD__FRAME_FIRST;
  f.seq = (uint16_t)i;
  f.t_us = (uint32_t)(i * 1000000 / ETHD__FRAME_RATE);
  return f;
}

static int64_t arrival_of(uint64_t i) { return (int64_t)(i * 1000000000 / ETHD__FRAME_RATE) + 4200000; }

static void note(count *c, const ethd__ring_reading *reading, uint64_t i) {
  double e = scene_error(reading, part(i));
  c->used++;
  c->worst = fmax(c->worst, isfinite(e) ? e : 0); /* no centre: no reading for the filter */
  c->sum += isfinite(e) ? e * e : 0;
  c->off += isfinite(e) && e > 0.5e-3;
}

/* The good one, which must come through; in doubt about the clock one may be spent. */
static void feed_good(count *c, uint64_t i) {
  ethd__ring_frame f = frame_of(i);
  ethd__ring_reading reading;
  if (!scene_feed(&r, &f, arrival_of(i), &reading))
    c->good_lost++;
  else
    ck_assert_double_le(scene_error(&reading, part(i)), 0.5e-3);
}

/* Damage that leaves the frame as it was: undone by itself, or to the zeros between. */
static bool is_whole(const uint8_t *wire, const uint8_t *end, const ethd__ring_frame *sent) {
  ethd__decoder d = {.in_step = true};
  ethd__ring_frame got;
  while (ethd__decoder_next(&d, &wire, end, &got))
    if (ring_same(&got, sent)) return true;
  return false;
}

static void feed_damaged(count *c, uint64_t i) {
  uint8_t wire[2 * ETHD__FRAME_WIRE];
  ethd__ring_frame f = frame_of(i);
  ethd__ring_reading reading;
  uint64_t frames = r.decoder.counters.frames;
  ethd__frame_encode(&f, wire);
  size_t n = ring_noise(i, wire);
  wire[n] = 0; /* the damage stays in its frame */
  const uint8_t *at = wire, *end = wire + n + 1;
  if (is_whole(wire, end, &f)) return;
  c->damaged++;
  while (ethd__receiver_next(&r, &at, end, arrival_of(i), &reading)) note(c, &reading, i);
  c->passed_crc += r.decoder.counters.frames - frames;
}

/* Fields of a frame changed, its CRC right. */
static void feed_forged(count *c, uint64_t i) {
  ethd__ring_frame f = frame_of(i), was = f;
  ethd__ring_reading reading;
  for (uint64_t k = 0, changes = 1 + draw_bits(i * 8 + 5) % 6; k < changes; k++) {
    uint64_t x = draw_bits((i * 8 + k) ^ 0x5555555555);
    uint32_t at = (uint32_t)(x >> 8) % ETHD__FRAME_AT_CRC, bit = 1u << (x >> 40 & 7);
    if (at == 1)
      f.flags ^= (uint8_t)bit;
    else if (at < 2)
      continue;
    else if (at < 4)
      f.seq ^= (uint16_t)(bit << 8 * (at - 2));
    else if (at < 8)
      f.t_us ^= bit << 8 * (at - 4);
    else
      f.counts[(at - 8) / 2] ^= (uint16_t)(x & 1 ? bit << 8 * (at & 1) : x >> 16);
  }
  if (ring_same(&f, &was)) return;
  c->damaged++;
  c->passed_crc++;
  if (scene_feed(&r, &f, arrival_of(i), &reading)) note(c, &reading, i);
}

static uint64_t wanted(void) {
  const char *text = getenv("ETHD_RING_FRAMES");
  return text ? strtoull(text, NULL, 10) : 20000;
}

static count run(uint64_t frames, void (*feed)(count *, uint64_t)) {
  count c = {0};
  ring_scene s = scene_open(1, &r);
  for (uint32_t i = 0; i < LOOP; i++) scene[i] = scene_frame(&s, i);
  for (uint64_t i = 0; i < 300; i++) feed_good(&c, i);
  ck_assert_uint_eq(c.good_lost, 0);
  for (uint64_t i = 300; c.damaged < frames; i++) {
    if (i % 2)
      feed(&c, i);
    else
      feed_good(&c, i);
  }
  return c;
}

static void say(const char *what, const count *c) {
  printf("%s: %" PRIu64 " frames, %" PRIu64 " passed the CRC, %" PRIu64 " of them were used (share %.3g), %" PRIu64
         " with a centre over 0.5 mm off, rms %.3f, at worst %.3f mm; %" PRIu64 " good frames were lost by it\n",
         what, c->damaged, c->passed_crc, c->used, (double)c->used / (double)c->damaged, c->off,
         c->used ? 1e3 * sqrt(c->sum / (double)c->used) : 0, 1e3 * c->worst, c->good_lost);
}

TEST(test_damaged) {
  uint64_t n = wanted();
  count c = run(n, feed_damaged);
  say("damaged on the wire", &c);
  ck_assert_uint_le(c.passed_crc, 20 + n / 50000);
  ck_assert_uint_le(c.used, 10 + n / 100000);
  ck_assert_double_le(c.worst, 1e-3);
}

TEST(test_forged) {
  count c = run(wanted() / 20 + 1000, feed_forged);
  say("with a right CRC", &c);
  ck_assert_double_le(c.worst, 1.5e-3);
  ck_assert_double_le((double)c.off, 0.01 * (double)c.damaged);
}
