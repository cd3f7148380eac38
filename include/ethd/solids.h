/* The built-in world of space: solids in closed form, which stand still or move as one rigid body. Links from libethd.

       outside            inside
         x ----- n ---->|/////////     distance > 0 outside, < 0 inside
                        P  solid       n = -grad distance: into the solid, also when seen from inside

   Solids are read once and immutable while used: any number of threads may share them. They never move: a query
   transforms its point into the body's frame. The application itself computes the surfaces of a world of triangles. */
#ifndef ETHD_SOLIDS_H
#define ETHD_SOLIDS_H

#include <stdbool.h>
#include <stddef.h>

#include "ethd/surface.h"

ETHD_BEGIN_DECLS

typedef struct ethd_solids ethd_solids;

/* Makes solids of text with one object on each line and '#' for comments:
     halfspace NX NY NZ C                                 {p : n.p > c}, n of unit length within 1e-6
     sphere X Y Z R | capsule X1 Y1 Z1 X2 Y2 Z2 R         in m
     box X Y Z HALF_X HALF_Y HALF_Z [RX RY RZ]            turned by |r| rad about r; without r along the frame's axes
     material NAME k_e=.. b_e=..
   An object may end in material=NAME, as in a scene of the plane. Coordinates and sizes are at most 1e6 m, sizes above
   0. A half-space's n is divided by its length, and c with it. `text` need not end in 0. ETHD_E_SYNTAX, ETHD_E_UNKNOWN
   (a shape of the plane, too), ETHD_E_DUPLICATE, ETHD_E_NOT_FINITE, ETHD_E_RANGE, ETHD_E_FULL, ETHD_E_ARGUMENT,
   ETHD_E_MEMORY, with error->line and the word in error->name. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_solids_parse(const char *text, size_t length, ethd_solids **out,
                                                       ethd_error *error);

/* Frees the solids; NULL is allowed. [main] */
ETHD_API void ethd_solids_destroy(ethd_solids *solids);

/* The pose of a rigid body in R_0, and its motion. */
typedef struct ethd_body_pose3 {
  ethd_vec3 x;           /* m, the origin of the body's frame */
  double orientation[4]; /* unit quaternion w x y z: rotates the body's vectors into R_0 */
  ethd_vec3 v;           /* m/s, of the origin */
  ethd_vec3 rate;        /* rad/s, angular velocity in R_0 */
} ethd_body_pose3;

/* Returns true for a valid pose: the quaternion's length is 1 within 1e-6, other numbers (m, m/s, rad/s) are at most
   1e100. The quaternion is then divided by its length where it is used. [any, rt-safe] */
ETHD_API bool ethd_body_pose3_is_valid(const ethd_body_pose3 *pose) ETHD_RT;

/* Finds the surfaces within `range`, m, of x, m in R_0, the deepest first (of equal ones the lowest id): the nearest
   point of each solid, since a convex solid has one. pose NULL: the solids stand still in R_0. At most `room` are
   written; the return value counts all, so range INFINITY and room 1 give the nearest. Inside a box the nearest face
   counts (of equal ones the last of x, y, z). n is always a unit vector; where the gradient is undefined (at a sphere's
   centre, on a capsule's axis) it is an arbitrary one. Points are exact to 1e-12 times the extent of solids, pose and
   x. There is none if range is NaN, x isn't within 1e100 m, or the pose isn't valid (ethd_body_pose3_is_valid says so).
   Bounds are tested first. On one x86-64 core this takes 7 ns if x is far from all solids, else 2 ns for each solid,
   and 13 to 28 ns for each that is found (make bench WHAT=scene).

   id is the object's number in the text, from 0, and material an index of ethd_solids_material. If a world consists of
   several ethd_solids, their ids must differ: add to the ids of each the object counts of all before it
   (ethd_solids_describe); the same holds for materials, except -1. [any, rt-safe] */
ETHD_API size_t ethd_solids_surfaces(const ethd_solids *solids, const ethd_body_pose3 *pose, ethd_vec3 x, double range,
                                     ethd_surface *out, size_t room) ETHD_RT;

typedef struct ethd_solids_info {
  size_t objects, materials;
  ethd_vec3 min, max; /* m, extent of all but half-spaces; min > max when there are none */
  size_t bytes;       /* memory held */
} ethd_solids_info;

/* Gives counts, extent and memory of the solids. [any] */
ETHD_API void ethd_solids_describe(const ethd_solids *solids, ethd_solids_info *out);

/* Returns material i of the solids, NULL past the end. [any, rt-safe] */
ETHD_API const ethd_material *ethd_solids_material(const ethd_solids *solids, size_t i) ETHD_RT;

ETHD_END_DECLS

#endif
