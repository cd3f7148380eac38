/* The ring's decoder under mutated streams: ETHD_FUZZ executions (default 200 000) in one process, after
   the corpus in tests/fuzz/decoder. Each stream is decoded in two ways, whole and in pieces, which must
   agree; a frame that came out must be what its bytes say once more. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>

#include "unit/ring_frames.h"

enum { SEEDS_MAX = 64, ROOM = 1024, LONGEST = 512 };

static struct {
  uint8_t bytes[LONGEST];
  size_t size;
} seeds[SEEDS_MAX];
static uint32_t seed_count;

static int fail(const char *what, const uint8_t *bytes, size_t size) {
  printf("%s:", what);
  for (size_t i = 0; i < size; i++) printf(" %02x", bytes[i]);
  printf("\n");
  return 1;
}

typedef struct result {
  uint64_t sum, frames;
  ethd__decoder_counters counters;
} result;

static void add(result *r, const ethd__ring_frame *f) {
  uint64_t part = f->seq + ((uint64_t)f->t_us << 16) + ((uint64_t)f->lost << 48);
  for (int k = 0; k < ETHD__FRAME_SENSORS; k++) part = part * 31 + f->counts[k];
  r->sum = (r->sum ^ part) * 0x9e3779b97f4a7c15u;
  r->frames++;
}

static int encodes_back(const ethd__ring_frame *frame, const uint8_t *end) {
  uint8_t wire[ETHD__FRAME_WIRE];
  ethd__frame_encode(frame, wire);
  return memcmp(wire, end - ETHD__FRAME_WIRE, sizeof wire) == 0;
}

static int run(const uint8_t *bytes, size_t size, size_t piece) {
  ethd__decoder whole = {0}, parts = {0};
  result a = {0}, b = {0};
  ethd__ring_frame f;
  const uint8_t *at = bytes;
  while (ethd__decoder_next(&whole, &at, bytes + size, &f)) {
    if (at < bytes + ETHD__FRAME_WIRE) return fail("a frame from too few bytes", bytes, size);
    if (!encodes_back(&f, at)) return fail("another coding", bytes, size);
    add(&a, &f);
  }
  for (size_t from = 0; from < size; from += piece) {
    at = bytes + from;
    const uint8_t *end = bytes + (size - from < piece ? size : from + piece);
    while (ethd__decoder_next(&parts, &at, end, &f)) add(&b, &f);
  }
  a.counters = whole.counters;
  b.counters = parts.counters;
  if (memcmp(&a, &b, sizeof a)) return fail("pieces differ", bytes, size);
  if (whole.counters.frames != a.frames || a.frames > size / ETHD__FRAME_WIRE)
    return fail("a wrong count", bytes, size);
  return 0;
}

static int is_seed(const struct dirent *entry) { return entry->d_name[0] != '.'; }

static int load_seed(const char *folder, const char *name) {
  char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "rb");
  if (!file) return printf("%s: can't be read\n", path), 1;
  seeds[seed_count].size = fread(seeds[seed_count].bytes, 1, LONGEST, file);
  seed_count++;
  fclose(file);
  return 0;
}

static int load(const char *folder) {
  struct dirent **entries;
  int failed = 0, n = scandir(folder, &entries, is_seed, alphasort);
  for (int i = 0; i < n; free(entries[i++]))
    if (seed_count < SEEDS_MAX) failed |= load_seed(folder, entries[i]->d_name);
  if (n <= 0) return printf("%s: no corpus\n", folder), 1;
  free(entries);
  return failed;
}

static size_t change(uint8_t *out, size_t n, uint64_t r) {
  size_t at = n ? (r >> 8) % n : 0, length = 1 + (r >> 24) % 50;
  if (length > n - at) length = n - at;
  switch (r % 8) {
  case 0: n = at; break;
  case 1: memmove(out + at, out + at + length, n - at - length), n -= length; break;
  case 2:
    if (n + length > ROOM) break;
    memmove(out + at + length, out + at, n - at), n += length;
    break;
  case 3: memset(out + at, (int)(r >> 40), length); break;
  case 4:
    if (n) out[at] = 0;
    break;
  case 5:
    if (n) out[at] = (uint8_t)(r >> 40);
    break;
  default:
    if (n) out[at] ^= (uint8_t)(1u << (r >> 40 & 7));
    break;
  }
  return n;
}

/* Mutation i of a seed, now and then with a good frame behind it or in its middle. */
static size_t mutated(uint64_t i, uint8_t *out) {
  uint64_t r = draw_bits(i * 8);
  uint32_t seed = (uint32_t)(r % seed_count);
  size_t n = seeds[seed].size;
  memcpy(out, seeds[seed].bytes, n);
  for (uint64_t k = 0; k < 1 + (r >> 32) % 5; k++) n = change(out, n, draw_bits(i * 8 + k + 1));
  if ((r >> 40 & 3) == 0) {
    ethd__ring_frame frame = ring_frame((uint32_t)i);
    size_t at = (r >> 48 & 1) && n > ETHD__FRAME_WIRE ? n - ETHD__FRAME_WIRE : n;
    ethd__frame_encode(&frame, out + at);
    n = at + ETHD__FRAME_WIRE;
  }
  return n;
}

int main(void) {
  static uint8_t bytes[ROOM + ETHD__FRAME_WIRE];
  const char *wanted = getenv("ETHD_FUZZ");
  uint64_t runs = wanted ? strtoull(wanted, NULL, 10) : 200000;
  if (load("tests/fuzz/decoder")) return 1;
  for (uint32_t s = 0; s < seed_count; s++)
    for (size_t piece = 1; piece < 100; piece++)
      if (run(seeds[s].bytes, seeds[s].size, piece)) return 1;
  for (uint64_t i = 0; i < runs; i++)
    if (run(bytes, mutated(i, bytes), 1 + i % 61)) return printf("run %llu\n", (unsigned long long)i), 1;
  printf("%llu runs from %u seeds\n", (unsigned long long)runs, seed_count);
  return 0;
}
