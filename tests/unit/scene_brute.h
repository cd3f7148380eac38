/* Large scenes, and what their trees must agree with: the same closed forms, object after object. */
#ifndef ETHD_TESTS_SCENE_BRUTE_H
#define ETHD_TESTS_SCENE_BRUTE_H

#include <stdint.h>

#include "ethd/scene.h"

/* A kind of scene within `size` m of the origin; `size` is a power of two. */
typedef struct scene_kind {
  const char *name;
  ethd_scene *(*create)(double size);
} scene_kind;

extern const scene_kind scene_kinds[];
extern const int scene_kind_count;

/* Random scenes of this kind and size, 250 queries on each: nearest without a hint, with one that follows
   a path and with a wrong one, touches, and the continuation of one. Fails the test that calls it. */
void scene_check_kind(const scene_kind *kind, double size, int queries);

/* Of all that `queries` queries give, to the bit. */
uint64_t scene_hash(const scene_kind *kind, int queries);

#endif
