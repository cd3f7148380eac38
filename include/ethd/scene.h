/* The virtual scene: objects of the plane, and local minima of the distance to them. Links from libethd.

       outside            inside
         x ----- n ---->|/////////     d > 0 outside, < 0 inside
            d           P  object      n = -grad d: into the object, also when seen from inside
                        |/////////
   A scene is built once and immutable while used: any number of controllers may share it. */
#ifndef ETHD_SCENE_H
#define ETHD_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "ethd/arm.h"
#include "ethd/maths.h"
#include "ethd/surface.h"

ETHD_BEGIN_DECLS

/* The numbers of each shape: halfplane {nx, ny, c}; circle {x, y, r}; capsule {x1, y1, x2, y2, r};
   box {x, y, half_w, half_h, angle}; segment {x1, y1, x2, y2}; polygon and polyline {x1, y1, x2, y2, ...}.
   Segments and polylines are thin walls without an inside. Polygons are simple, of either winding. */
typedef enum ethd_shape {
  ETHD_SHAPE_HALFPLANE = 0,
  ETHD_SHAPE_CIRCLE,
  ETHD_SHAPE_CAPSULE,
  ETHD_SHAPE_BOX,
  ETHD_SHAPE_POLYGON,
  ETHD_SHAPE_SEGMENT,
  ETHD_SHAPE_POLYLINE,
  ETHD_SHAPE_COUNT
} ethd_shape;

typedef struct ethd_object_def {
  ethd_shape shape;
  int32_t material; /* index, -1: none */
  const double *numbers;
  size_t count; /* of numbers */
  int32_t line; /* of the text, for error messages; 0 without text */
} ethd_object_def;

typedef struct ethd_scene_def {
  const ethd_object_def *objects;
  size_t object_count; /* 0 is a valid, empty scene */
  const ethd_material *materials;
  size_t material_count;
} ethd_scene_def;

typedef struct ethd_scene ethd_scene;

/* Checks the objects and makes a scene of copies of them. Half-plane normals within 1e-6 of unit length are divided by
   their length, and c with them. Coordinates and sizes may be up to 1e6 m. ETHD_E_NOT_FINITE, ETHD_E_RANGE,
   ETHD_E_GEOMETRY (points that differ only by rounding, self-intersecting), ETHD_E_ARGUMENT (a wrong count of
   numbers), ETHD_E_DUPLICATE, ETHD_E_FULL, ETHD_E_MEMORY; error->line is the object's. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_scene_create(const ethd_scene_def *def, ethd_scene **out, ethd_error *error);

/* Makes a scene of text with one object on each line and '#' for comments:
     halfplane NX NY C | circle X Y R | capsule X1 Y1 X2 Y2 R | box X Y HALF_W HALF_H ANGLE
     polygon X1 Y1 ... | segment X1 Y1 X2 Y2 | polyline X1 Y1 ...      each may end in material=NAME
     material NAME k_e=.. b_e=..
   `text` need not end in 0. ETHD_E_SYNTAX, ETHD_E_UNKNOWN, ETHD_E_DUPLICATE and the statuses of create, with
   error->line and the word in error->name. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_scene_parse(const char *text, size_t length, ethd_scene **out,
                                                      ethd_error *error);

/* Frees the scene; NULL is allowed. [main] */
ETHD_API void ethd_scene_destroy(ethd_scene *scene);

/* The result of a query: the nearest object. */
typedef struct ethd_nearest {
  double distance;   /* m, signed; thin walls: >= 0 */
  ethd_vec point, n; /* m; unit vector into the object */
  int32_t object;    /* of several equally near ones the lowest; -1 and distance = inf in an empty scene, and for an x
                        that isn't finite */
} ethd_nearest;

/* Finds the nearest object to x, m in the scene's frame (R_0; a body's own), exact to 1e-12 times the scene's extent. n
   is always a unit vector; where the gradient is undefined (on a segment, at a circle's centre) it is an arbitrary one.
   [any, rt-safe] */
ETHD_API void ethd_scene_query(const ethd_scene *scene, ethd_vec x, ethd_nearest *out) ETHD_RT;

/* The place of a query's result. It makes the next query near this place faster and never changes its result. Start
   with {0} and keep one for each moving point; a hint may be used with any scene. */
typedef struct ethd_scene_hint {
  uint32_t leaf, edge;
  int32_t step;
} ethd_scene_hint;

/* Does what ethd_scene_query does, at x, m, and reads and renews `hint`. [any, rt-safe] */
ETHD_API void ethd_scene_query_near(const ethd_scene *scene, ethd_vec x, ethd_scene_hint *hint,
                                    ethd_nearest *out) ETHD_RT;

/* A local minimum of the distance between x and the points of one object. Surfaces of a solid that face away from x
   have none. A polyline whose last point equals its first has no ends. */
typedef struct ethd_touch {
  double distance; /* signed */
  ethd_vec point, n;
  int32_t object;
  int32_t feature; /* edge (2 i) or vertex (2 i + 1) of a polygon or polyline, else 0 */
  int32_t side;    /* thin walls: +1 left, -1 right of the nearest edge, 0 beyond an end; solids: 0 */
  int32_t material;
} ethd_touch;

/* Finds all local minima with distance <= range, m, from x, m, the deepest first (of equal ones the lowest object, then
   feature). At most `room` are written; the return value counts all. A solid gives one when x is inside. There is none
   if x isn't finite or range is NaN. [any, rt-safe] */
ETHD_API size_t ethd_scene_touches(const ethd_scene *scene, ethd_vec x, double range, ethd_touch *out,
                                   size_t room) ETHD_RT;

/* Finds the touch of one object at x, m, that continues an earlier one: the local minimum whose point is nearest to
   `from`, at any distance. For contacts that go on beyond the range. `object`: as a touch of this scene has it; x and
   from: finite. [any, rt-safe] */
ETHD_API void ethd_scene_follow(const ethd_scene *scene, int32_t object, ethd_vec x, ethd_vec from,
                                ethd_touch *out) ETHD_RT;

typedef struct ethd_scene_info {
  size_t objects, by_shape[ETHD_SHAPE_COUNT], segments, materials;
  size_t dropped;                    /* objects that ethd_scene_prune left out */
  size_t boxes;                      /* how many boxes its trees have room for */
  double x_min, x_max, y_min, y_max; /* of the bounded objects; min > max when there are none */
  size_t bytes;                      /* memory held */
} ethd_scene_info;

/* Gives counts, extent and memory of a scene. [any] */
ETHD_API void ethd_scene_describe(const ethd_scene *scene, ethd_scene_info *out);

/* A rotated box of a tree, m. A box of level 1 encloses one item, one of level l eight boxes of the level below. */
typedef struct ethd_scene_box {
  ethd_vec centre;
  double cosine, sine, half_u, half_v; /* u along (cosine, sine) */
  int32_t level;
  int32_t of_chain; /* 1: the items are edges of a chain, 0: objects */
} ethd_scene_box;

/* Gives box i, from 0 up to ethd_scene_info.boxes, for pictures; ETHD_STATUS_EMPTY: there is none. [any] */
ETHD_API ethd_status ethd_scene_box_at(const ethd_scene *scene, size_t i, ethd_scene_box *out);

/* Gives object i in the order of their numbers, as it was given (a half-plane's divided by |n|), with `line` 0; the
   numbers belong to the scene. Returns its number in the file, -1 past the end. [any] */
ETHD_API int32_t ethd_scene_object(const ethd_scene *scene, size_t i, ethd_object_def *out);

/* Returns how many objects lie wholly farther than `radius`, m, from every position that the ring's centre can have on
   this arm; none if it is NaN. [any] */
ETHD_API size_t ethd_scene_out_of_reach(const ethd_scene *scene, const ethd_arm *arm, double radius);

/* Makes a scene without those objects (radius: m), for one arm; the others keep their numbers and give the same touches
   to the bit. *out is NULL if no object would be dropped: use the scene itself. A setup whose arm or ring reaches
   farther refuses a pruned scene, and no body may have one. ETHD_E_MEMORY. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_scene_prune(const ethd_scene *scene, const ethd_arm *arm, double radius,
                                                      ethd_scene **out, ethd_error *error);

/* Returns material i of the scene, NULL past the end. [any, rt-safe] */
ETHD_API const ethd_material *ethd_scene_material(const ethd_scene *scene, size_t i) ETHD_RT;

/* Returns "halfplane", "circle", ..., or "" for any other number. [any] */
ETHD_API const char *ethd_shape_name(ethd_shape shape);

/* Returns the names of a shape's numbers in its text, "X Y R"; "..." means that more points may follow. "" for any
   other number. [any] */
ETHD_API const char *ethd_shape_form(ethd_shape shape);

ETHD_END_DECLS

#endif
