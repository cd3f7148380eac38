/* The camera's datagrams under mutation: ETHD_FUZZ executions (default 200 000) in one process. What passes must be
   what its bytes say once more, with numbers that can be; half of the mutants have their checksum mended, so that what
   comes behind it is tried too. The clock takes them all: an instant is never later than its arrival. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/sense.h"
#include "finger/camera.h"
#include "proximity_ring/decoder.h"
#include "unit/draw.h"

#define DELAY 11100000 /* ns */

static int fail(const char *what, const uint8_t *bytes, size_t size) {
  printf("%s:", what);
  for (size_t i = 0; i < size; i++) printf(" %02x", bytes[i]);
  printf("\n");
  return 1;
}

static size_t mutate(uint64_t i, uint8_t bytes[64]) {
  static const double odd[] = {NAN, INFINITY, -INFINITY, -0.0, 1e-320, 1e300, -1e-9, 1e6, 1000000.1, 1, 1.0001};
  size_t size = ETHD__EXPOSURE_SIZE;
  ethd__exposure e = {(uint32_t)i, (int64_t)(i * 11111111), {draw(i, -1, 1), draw(i + 7, -1, 1)}, 1e-4, 1};
  ethd__exposure_encode(&e, bytes);
  for (uint64_t k = 0, changes = draw_bits(i) % 4; k < changes; k++) {
    uint64_t r = draw_bits(i * 8 + k + 1);
    size_t at = (r >> 8) % ETHD__EXPOSURE_SIZE;
    switch (r % 6) {
    case 0: bytes[at] = (uint8_t)(r >> 16); break;
    case 1: memcpy(bytes + 16 + 8 * ((r >> 20) % 3), &odd[(r >> 24) % (sizeof odd / sizeof *odd)], 8); break;
    case 2: bytes[4 + (r >> 20) % 12] = (uint8_t)(r >> 30); break; /* seq, t_ns */
    case 3: bytes[40] = (uint8_t)(r >> 30); break;                 /* flags */
    case 4: size = (r >> 20) % 64; break;
    default: bytes[at] ^= (uint8_t)(1u << ((r >> 16) & 7)); break;
    }
  }
  if (draw_bits(i + 3) % 2) {
    uint16_t crc = ethd__frame_crc(bytes, ETHD__EXPOSURE_SIZE - 2);
    bytes[42] = (uint8_t)crc, bytes[43] = (uint8_t)(crc >> 8);
  }
  return size;
}

static int possible(const ethd__exposure *e) {
  if (!(e->flags & ETHD__EXPOSURE_SEEN)) return 1;
  return fabs(e->finger.x) <= ETHD_SENSE_LENGTH_MAX && fabs(e->finger.y) <= ETHD_SENSE_LENGTH_MAX && e->noise >= 0 &&
         e->noise <= 1;
}

int main(void) {
  const char *wanted = getenv("ETHD_FUZZ");
  uint64_t runs = wanted ? strtoull(wanted, NULL, 10) : 200000, passed = 0, used = 0;
  ethd__camera_clock clock = {.delay = DELAY};
  for (uint64_t i = 0; i < runs; i++) {
    uint8_t bytes[64] = {0}, again[ETHD__EXPOSURE_SIZE];
    size_t size = mutate(i, bytes);
    ethd__exposure e;
    int64_t sample_ns, arrival_ns = (int64_t)(i * 11111111 + draw_bits(i + 11) % 5000000);
    if (!ethd__exposure_decode(bytes, size, &e)) continue;
    passed++;
    ethd__exposure_encode(&e, again);
    if (size != ETHD__EXPOSURE_SIZE || memcmp(bytes, again, sizeof again) != 0)
      return fail("passes, and says otherwise", bytes, size);
    if (!possible(&e)) return fail("a number that can't be", bytes, size);
    if (!ethd__camera_clock_step(&clock, &e, arrival_ns, &sample_ns)) continue;
    used++;
    if (sample_ns > arrival_ns - DELAY) return fail("later than it arrived", bytes, size);
  }
  printf("%llu datagrams, %llu pass, %llu are used, %llu jumps\n", (unsigned long long)runs, (unsigned long long)passed,
         (unsigned long long)used, (unsigned long long)clock.jumps);
  /* the first four exposures after a jump aren't used */
  return passed < runs / 10 || used + 4 * clock.jumps < passed / 2 || used < passed / 4;
}
