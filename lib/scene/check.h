/* Checks the definition of a scene. [main] */
#ifndef ETHD__SCENE_CHECK_H
#define ETHD__SCENE_CHECK_H

#include <stdbool.h>

#include "ethd/scene.h"

/* Makes the checks that ethd_scene_create promises. `room`: ethd__check_room(def) bytes, aligned like malloc's. */
size_t ethd__check_room(const ethd_scene_def *def);
ethd_status ethd__check_scene(const ethd_scene_def *def, void *room, ethd_error *error);

/* Returns true if the closed chain of n points {x, y}, 3 <= n < 2^30, is a simple polygon; if it isn't, `meet` holds
   two edges that meet. `room`: ethd__simple_room(n) bytes, aligned like malloc's. */
size_t ethd__simple_room(size_t n);
bool ethd__is_simple(const double *points, size_t n, void *room, size_t meet[2]);

#endif
