#include "sim/random.h"

#include <math.h>

#include "ethd/maths.h"

#define TWO_PI 6.28318530717958647692

static void round_once(const uint32_t key[2], uint32_t c[4]) {
  uint64_t a = (uint64_t)0xD2511F53u * c[0], b = (uint64_t)0xCD9E8D57u * c[2];
  uint32_t next[4] = {(uint32_t)(b >> 32) ^ c[1] ^ key[0], (uint32_t)b, (uint32_t)(a >> 32) ^ c[3] ^ key[1],
                      (uint32_t)a};
  for (int i = 0; i < 4; i++) c[i] = next[i];
}

void ethd__philox(const uint32_t key[2], uint32_t block[4]) {
  uint32_t k[2] = {key[0], key[1]};
  for (int i = 0; i < 10; i++) {
    round_once(k, block);
    k[0] += 0x9E3779B9u;
    k[1] += 0xBB67AE85u;
  }
}

static void pair(ethd__key key, uint32_t stream, uint32_t counter, double out[2]) {
  uint32_t k[2] = {(uint32_t)key.seed, (uint32_t)(key.seed >> 32)};
  uint32_t c[4] = {counter, stream, (uint32_t)key.tap, (uint32_t)(key.tap >> 32)};
  ethd__philox(k, c);
  for (int i = 0; i < 2; i++) {
    uint64_t word = (uint64_t)c[2 * i + 1] << 32 | c[2 * i];
    out[i] = (double)(word >> 11) * 0x1p-53;
  }
}

double ethd__uniform(ethd__key key, uint32_t stream, uint32_t counter) {
  double u[2];
  pair(key, stream, counter, u);
  return u[0];
}

/* Box and Muller, with 1 - u in (0, 1]. */
double ethd__normal(ethd__key key, uint32_t stream, uint32_t counter) {
  double u[2];
  pair(key, stream, counter, u);
  return sqrt(-2 * ethd_log(1 - u[0])) * ethd_cos(TWO_PI * u[1]);
}

double ethd__normal_cut(ethd__key key, uint32_t stream, double cut) {
  double g;
  uint32_t attempt = 0;
  do g = ethd__normal(key, stream, attempt++);
  while (!(fabs(g) <= cut));
  return g;
}
