/* Random objects within 1 m, and their distances by other formulas than the library's, in long double. */
#ifndef ETHD_TESTS_SCENE_OBJECTS_H
#define ETHD_TESTS_SCENE_OBJECTS_H

#include <stdint.h>

#include "ethd/scene.h"

enum { SCENE_POINTS = 60 };
#define SCENE_TIGHT 1e-15 /* m */

typedef long double real;

typedef struct object {
  ethd_shape shape;
  size_t count;
  double p[2 * SCENE_POINTS];
} object;

/* Draws start from here, equal for equal seeds. */
void scene_seed(uint64_t seed);
uint64_t scene_draw(void);
double scene_uniform(double a, double b);

/* Its next number. */
void scene_add(object *o, double v);

object scene_random(ethd_shape shape);

/* A scene of several objects; of one. */
ethd_scene *scene_build(const object *objects, size_t n);
ethd_scene *scene_one(ethd_shape shape, size_t count, const double *p);
#define SCENE_ONE(shape, ...) \
  scene_one(shape, sizeof((double[]){__VA_ARGS__}) / sizeof(double), (double[]){__VA_ARGS__})

/* Signed distance of (x, y). */
real scene_expected(const object *o, real x, real y);
/* From an edge; from a chain of n points. */
real scene_to_edge(real ax, real ay, real bx, real by, real x, real y);
real scene_to_chain(const double *p, size_t n, int closed, real x, real y);
/* Turns of a closed chain of n points about (x, y). */
int scene_winding(const double *p, size_t n, real x, real y);

#endif
