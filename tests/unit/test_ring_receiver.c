/* From bytes to readings: a moving finger, sensors that fail, frames that can't be true. */
#include <math.h>
#include <stdio.h>

#include "proximity_ring/empty.h"
#include "unit/rig.h"
#include "unit/ring_scene.h"

static ethd__receiver r;
static char message[ETHD_MESSAGE_MAX];

static uint32_t bits(uint32_t mask) { return (uint32_t)__builtin_popcount(mask); }

TEST(test_clean) {
  for (uint64_t seed = 1; seed <= 5; seed++) {
    ring_scene s = scene_open(seed, &r);
    double sum = 0;
    for (uint32_t i = 0; i < 6000; i++) {
      ethd__ring_frame f = scene_frame(&s, i);
      ethd__ring_reading reading;
      ck_assert(scene_feed(&r, &f, scene_arrival(&s, i), &reading));
      ck_assert_int_le(
          llabs(reading.sample_ns - s.start_ns - (int64_t)(1e9 * scene_time(i)) - 1000 * (int64_t)ETHD__MIDDLE_US),
          2000);
      ck_assert_uint_eq(reading.out, 0);
      double e = scene_error(&reading, i);
      sum += e * e;
    }
    ck_assert_double_le(sqrt(sum / 6000), 0.02e-3);
    ck_assert(r.counts.readings == 6000 && !r.counts.frame_lost && !r.counts.sensor && !r.counts.board_clock);
    ck_assert_uint_eq(r.plausible.suspects, 0);
  }
}

/* The first frames came 8 ms late: the clock is placed that much earlier by the fourth, more than two frames before the
   third. Instants don't go back, and are the true ones as soon as those have caught up. */
TEST(test_instants_keep_their_order) {
  ring_scene s = scene_open(1, &r);
  int64_t last = 0;
  for (uint32_t i = 0; i < 12; i++) {
    ethd__ring_frame f = scene_frame(&s, i);
    ethd__ring_reading reading;
    ck_assert(scene_feed(&r, &f, scene_arrival(&s, i) + (i < 3 ? 8000000 : 0), &reading));
    int64_t off = reading.sample_ns - s.start_ns - (int64_t)(1e9 * scene_time(i)) - 1000 * (int64_t)ETHD__MIDDLE_US;
    ck_assert_int_gt(reading.sample_ns, last);
    if (i < 3) ck_assert_int_le(llabs(off - 8000000), 2000);
    if (i == 3 || i == 4) ck_assert_int_eq(reading.sample_ns, last + 1);
    if (i > 4) ck_assert_int_le(llabs(off), 2000);
    last = reading.sample_ns;
  }
  ck_assert(r.counts.readings == 12 && !r.counts.board_clock);
}

/* ---- row 18: sensors ---- */

typedef enum symptom { STUCK, SATURATED, MISSING, UNDER_DARK, OFF, SYMPTOMS } symptom;

static void spoil(ethd__ring_frame *f, symptom kind, int k, uint16_t held) {
  static const uint16_t counts[SYMPTOMS] = {0, ETHD__FRAME_SATURATED, ETHD__FRAME_MISSING, 300, 60000};
  f->counts[k] = kind == STUCK ? held : counts[kind];
  if (kind == MISSING) f->flags |= ETHD__FRAME_SENSOR_MISSING;
}

/* Frames from the onset until the sensor is out of use, and from its end until it is in use again. */
static void watch(symptom kind, int k, uint32_t onset, uint32_t *noticed, uint32_t *forgiven) {
  ring_scene s = scene_open(1, &r);
  uint16_t held = scene_frame(&s, onset).counts[k];
  *noticed = *forgiven = 0;
  for (uint32_t i = 0; i < onset + 120; i++) {
    ethd__ring_frame f = scene_frame(&s, i);
    ethd__ring_reading reading;
    if (i >= onset && i < onset + 60) spoil(&f, kind, k, held);
    ck_assert(scene_feed(&r, &f, scene_arrival(&s, i), &reading));
    ck_assert_uint_eq(reading.out & ~(1u << k), 0);
    if (i >= onset && i < onset + 60 && reading.out && !*noticed) *noticed = i - onset + 1;
    if (*noticed && i < onset + 60) ck_assert(isnan(reading.rays[k]));
    if (i >= onset + 60 && !reading.out && !*forgiven) *forgiven = i - onset - 59;
    ck_assert_double_le(scene_error(&reading, i), 0.25e-3);
  }
}

TEST(test_sensor_faults) {
  static const char *const names[] = {"stuck", "saturated", "missing", "under dark", "off"};
  for (symptom kind = 0; kind < SYMPTOMS; kind++) {
    uint32_t worst = 0, longest = 0;
    for (int phase = 0; phase < 20; phase++) {
      uint32_t noticed, forgiven;
      watch(kind, (phase * 7) % 16, 300 + 13 * (uint32_t)phase, &noticed, &forgiven);
      ck_assert_msg(noticed >= 1 && forgiven >= 1, "%s, phase %d: noticed %u, forgiven %u", names[kind], phase, noticed,
                    forgiven);
      if (noticed > worst) worst = noticed;
      if (forgiven > longest) longest = forgiven;
    }
    printf("%s: out of use after %u frames at most, in use again after %u\n", names[kind], worst, longest);
    /* A stuck sensor differs from its held value first one frame later; saturated and off show where the finger
       isn't. */
    if (kind != OFF) ck_assert_uint_le(worst, kind == STUCK || kind == SATURATED ? 6 : 5);
    ck_assert_uint_le(longest, 8);
  }
}

/* All sensors count more, or less, than when they were calibrated: each ray is on the others' circle, whose radius is wrong.
   A finger of another radius is no drift, nor is a calibration that is a tenth of a millimetre off at each sensor. */
TEST(test_drift) {
  static const double darks[] = {2000, -1200, 0, 100};
  for (uint64_t seed = 1; seed <= 5; seed++)
    for (size_t i = 0; i < sizeof darks / sizeof *darks; i++) {
      ring_scene s = scene_open(seed, &r);
      ethd__ring_reading reading = {.out = 0};
      bool is_drift = fabs(darks[i]) > 1000;
      for (int k = 0; k < ETHD_RAYS; k++) {
        s.truth.sensors[k].dark += darks[i];
        s.truth.sensors[k].d0 += is_drift ? 0 : 1e-4 * draw_normal(seed * 100 + (uint64_t)k);
      }
      uint32_t noticed = 0;
      for (uint32_t n = 0; n < 6 * ETHD__DRIFT_FRAMES; n++) {
        ethd__ring_frame f = scene_frame(&s, n);
        if (scene_feed(&r, &f, scene_arrival(&s, n), &reading) && reading.has_drift && !noticed) noticed = n;
        ck_assert_msg(is_drift || !reading.has_drift, "seed %d, %g: %g m", (int)seed, darks[i], r.drift.offset);
      }
      ck_assert_msg(!is_drift || (noticed && noticed <= 2 * ETHD__DRIFT_FRAMES), "seed %d, %g: %g m at %u", (int)seed,
                    darks[i], r.drift.offset, noticed);
      ck_assert(!is_drift || (r.drift.offset > 0) == (darks[i] > 0));
      printf("darks %+g: radius %+.3f mm\n", darks[i], 1e3 * r.drift.offset);
    }
}

/* A board doesn't answer: its four sensors are out of use, and the frame's flag is set. */
TEST(test_board_missing) {
  ring_scene s = scene_open(2, &r);
  ethd__ring_reading reading;
  for (uint32_t i = 0; i < 400; i++) {
    ethd__ring_frame f = scene_frame(&s, i);
    if (i >= 300) f.flags |= ETHD__FRAME_BOARD_MISSING | ETHD__FRAME_SENSOR_MISSING;
    for (int k = 8; k < 12 && i >= 300; k++) f.counts[k] = 0;
    ck_assert(scene_feed(&r, &f, scene_arrival(&s, i), &reading));
    ck_assert_double_le(scene_error(&reading, i), 0.1e-3);
  }
  ck_assert_uint_eq(reading.out, 0x0f00);
  ck_assert_uint_eq(bits(reading.out), 4);
}

/* Frozen as a whole is no stuck sensor: nothing moves. */
TEST(test_still) {
  ring_scene s = scene_open(2, &r);
  ethd__ring_frame first = scene_frame(&s, 0);
  for (uint32_t i = 0; i < 300; i++) {
    ethd__ring_frame f = scene_frame(&s, i);
    ethd__ring_reading reading;
    memcpy(f.counts, first.counts, sizeof f.counts);
    ck_assert(scene_feed(&r, &f, scene_arrival(&s, i), &reading));
    ck_assert_uint_eq(reading.out, 0);
  }
}

/* ---- rows 15 and 20 ---- */

TEST(test_lost_and_corrupt) {
  ring_scene s = scene_open(3, &r);
  ethd__ring_reading reading;
  uint64_t expected = 0;
  for (uint32_t i = 0; i < 1000; i++) {
    ethd__ring_frame f = scene_frame(&s, i);
    uint8_t wire[ETHD__FRAME_WIRE];
    const uint8_t *at = wire;
    if (i % 10 == 5) continue; /* lost: told by the next one */
    ethd__frame_encode(&f, wire);
    if (i % 10 == 8) wire[i % 43] ^= 3;
    expected += i % 10 == 6 || i % 10 == 8 || (i % 10 == 9);
    bool got = ethd__receiver_next(&r, &at, wire + sizeof wire, scene_arrival(&s, i), &reading);
    ck_assert_int_eq(got, i % 10 != 8);
    ck_assert_uint_eq(r.counts.frame_lost, expected);
  }
}

TEST(test_reset) {
  ring_scene s = scene_open(3, &r);
  ethd__ring_reading reading;
  for (uint32_t i = 0; i < 900; i++) {
    ethd__ring_frame f = scene_frame(&s, i);
    if (i >= 600) f.seq = (uint16_t)(f.seq - 600), f.t_us -= 2000000;
    if (i == 600) f.flags |= ETHD__FRAME_FIRST;
    ck_assert(scene_feed(&r, &f, scene_arrival(&s, i), &reading));
    ck_assert_uint_eq(r.counts.board_clock, i >= 600);
    ck_assert_int_le(
        llabs(reading.sample_ns - s.start_ns - (int64_t)(1e9 * scene_time(i)) - 1000 * (int64_t)ETHD__MIDDLE_US), 3000);
  }
  ck_assert_uint_eq(r.counts.frame_lost, 0);
}

/* A finger that is suddenly elsewhere is believed in the third frame. */
TEST(test_leap) {
  ring_scene s = scene_open(3, &r);
  ethd__ring_reading reading;
  for (uint32_t i = 0; i < 312; i++) {
    ethd__ring_frame f = scene_frame(&s, i);
    if (i >= 300)
      for (int k = 0; k < ETHD_RAYS; k++)
        f.counts[k] = (uint16_t)rod_counts(&s.truth, k, k < 8 ? 8.2e-3 : 0.8e-3, 5, i);
    bool got = scene_feed(&r, &f, scene_arrival(&s, i), &reading);
    ck_assert_int_eq(got, i < 300 || (i - 300) % 3 == 2); /* no finger's shape: a third of the frames */
  }
}

/* ---- the empty ring ---- */

static ethd_status check_empty(ring_scene *s, int finger, ethd__calibration *c, uint32_t missing) {
  ethd__empty e = {0};
  for (uint32_t i = 0; i < ETHD__EMPTY_FRAMES; i++) {
    ethd__ring_frame f = scene_frame(s, i);
    for (int k = 0; k < ETHD_RAYS; k++) {
      if (!finger) f.counts[k] = (uint16_t)rod_counts(&s->truth, k, (double)NAN, 5, i * 16ull + (uint64_t)k);
      if (missing >> k & 1) f.counts[k] = 0;
    }
    ethd__empty_add(&e, &f);
  }
  return ethd__empty_check(&e, ROD_RING, c, message);
}

TEST(test_empty) {
  ring_scene s = scene_open(4, &r);
  ethd__calibration c = s.truth;
  for (int k = 0; k < ETHD_RAYS; k++) c.sensors[k].dark += 100; /* another day */
  ck_assert_msg(check_empty(&s, 0, &c, 0) == ETHD_OK, "%s", message);
  for (int k = 0; k < ETHD_RAYS; k++) ck_assert_double_eq_tol(c.sensors[k].dark, s.truth.sensors[k].dark, 3);
  c = s.truth;
  ck_assert_int_eq(check_empty(&s, 1, &c, 0), ETHD_E_DEVICE);
  ck_assert_ptr_nonnull(strstr(message, "are allowed in an empty ring: remove the object, or clean the ring"));
  c = ethd__calibration_default();
  ck_assert_int_eq(check_empty(&s, 1, &c, 0), ETHD_E_DEVICE);
  ck_assert_int_eq(check_empty(&s, 0, &c, 0), ETHD_OK);
  c = s.truth;
  ck_assert_int_eq(check_empty(&s, 0, &c, 0xf0), ETHD_OK);
  ck_assert(isnan(c.sensors[4].dark) && !isnan(c.sensors[3].dark));
  ck_assert_int_eq(check_empty(&s, 0, &c, 0x1f0), ETHD_E_DEVICE);
  ck_assert_str_eq(message, "11 sensors answer in an empty ring, at least 12 are needed: are all boards connected?");
}
