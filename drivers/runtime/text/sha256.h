/* SHA-256 (FIPS 180-4), so that anyone can check a sum with sha256sum. [any] */
#ifndef ETHD__TEXT_SHA256_H
#define ETHD__TEXT_SHA256_H

#include <stddef.h>
#include <stdint.h>

#define ETHD_SHA256_TEXT 65 /* 64 hex digits and a 0 */

typedef struct ethd__sha256 {
  uint32_t h[8];
  unsigned char block[64];
  uint64_t length; /* bytes so far */
} ethd__sha256;

void ethd__sha256_begin(ethd__sha256 *s);
void ethd__sha256_add(ethd__sha256 *s, const void *bytes, size_t length);
void ethd__sha256_end(ethd__sha256 *s, char out[ETHD_SHA256_TEXT]);

#endif
