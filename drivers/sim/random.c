#include "sim/random.h"

#include <math.h>

#include "ethd/maths.h"

#define TWO_PI 6.28318530717958647692

void ethd__philox(const uint32_t key[2], uint32_t block[4]) {
  uint32_t k0 = key[0], k1 = key[1], c0 = block[0], c1 = block[1], c2 = block[2], c3 = block[3];
  for (int i = 0; i < 10; i++) {
    uint64_t a = (uint64_t)0xD2511F53u * c0, b = (uint64_t)0xCD9E8D57u * c2;
    c0 = (uint32_t)(b >> 32) ^ c1 ^ k0;
    c1 = (uint32_t)b;
    c2 = (uint32_t)(a >> 32) ^ c3 ^ k1;
    c3 = (uint32_t)a;
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  block[0] = c0;
  block[1] = c1;
  block[2] = c2;
  block[3] = c3;
}

static void pair(ethd__sim_key key, uint32_t stream, uint32_t counter, double out[2]) {
  uint32_t k[2] = {(uint32_t)key.seed, (uint32_t)(key.seed >> 32)};
  uint32_t c[4] = {counter, stream, (uint32_t)key.tap, (uint32_t)(key.tap >> 32)};
  ethd__philox(k, c);
  for (int i = 0; i < 2; i++) {
    uint64_t word = (uint64_t)c[2 * i + 1] << 32 | c[2 * i];
    out[i] = (double)(word >> 11) * 0x1p-53;
  }
}

double ethd__uniform(ethd__sim_key key, uint32_t stream, uint32_t counter) {
  double u[2];
  pair(key, stream, counter, u);
  return u[0];
}

/* By Box and Muller, with 1 - u, which lies in (0, 1]. */
double ethd__normal(ethd__sim_key key, uint32_t stream, uint32_t counter) {
  double u[2];
  pair(key, stream, counter, u);
  return sqrt(-2 * ethd_log(1 - u[0])) * ethd_cos(TWO_PI * u[1]);
}

double ethd__normal_cut(ethd__sim_key key, uint32_t stream, double cut) {
  double g;
  uint32_t attempt = 0;
  do g = ethd__normal(key, stream, attempt++);
  while (!(fabs(g) <= cut));
  return g;
}
