/* Whether a scene can be made of what was given. [main] */
#ifndef ETHD_LIB_SCENE_CHECK_H
#define ETHD_LIB_SCENE_CHECK_H

#include <stdbool.h>

#include "ethd/scene.h"

static inline bool ethd__same(const char *a, const char *b) {
  while (*a && *a == *b) a++, b++;
  return *a == *b;
}

/* ETHD_OK if a shape may have so many numbers, else `status`; the error names no line. */
ethd_status ethd__check_count(ethd_shape shape, size_t count, ethd_status status, ethd_error *error);

/* The contract of ethd_scene_create. `room`: ethd__check_room(def) bytes, aligned like malloc's. */
size_t ethd__check_room(const ethd_scene_def *def);
ethd_status ethd__check_scene(const ethd_scene_def *def, void *room, ethd_error *error);

/* Whether the closed chain of n points {x, y}, 3 <= n < 2^30, is a simple polygon. If it isn't, `meet` holds two
   edges that meet. `room`: ethd__simple_room(n) bytes, aligned like malloc's. */
size_t ethd__simple_room(size_t n);
bool ethd__is_simple(const double *points, size_t n, void *room, size_t meet[2]);

#endif
