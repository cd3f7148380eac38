#include "scene/thin.h"

#include <math.h>
#include <stdio.h>

#include "text/text.h"

#define THIN 0.010 /* m: half of it is twice what the paper's wall gives way under the motors' force, 2.4 mm */

/* The least distance of two parallel lines along an edge between which a polygon lies; of a convex one its width. */
static double width(const double *p, size_t count) {
  size_t n = count / 2;
  double least = (double)INFINITY;
  for (size_t i = 0; i < n; i++) {
    const double *a = p + 2 * i, *b = p + 2 * ((i + 1) % n);
    double x = b[0] - a[0], y = b[1] - a[1], length = hypot(x, y), low = 0, high = 0;
    for (size_t k = 0; k < n && length > 0; k++) {
      double d = (x * (p[2 * k + 1] - a[1]) - y * (p[2 * k] - a[0])) / length;
      low = fmin(low, d);
      high = fmax(high, d);
    }
    if (length > 0) least = fmin(least, high - low);
  }
  return least;
}

/* INFINITY: it has no other side. */
static double thickness(const ethd_object_def *o) {
  switch (o->shape) {
  case ETHD_SHAPE_CIRCLE: return 2 * o->numbers[2];
  case ETHD_SHAPE_CAPSULE: return 2 * o->numbers[4];
  case ETHD_SHAPE_BOX: return 2 * fmin(o->numbers[2], o->numbers[3]);
  case ETHD_SHAPE_POLYGON: return o->count <= 128 ? width(o->numbers, o->count) : (double)INFINITY;
  default: return (double)INFINITY;
  }
}

void ethd__scene_say_thin(const ethd_scene *scene, const char *before) {
  ethd_object_def o;
  size_t thin = 0, thinnest = 0;
  double least = (double)INFINITY;
  for (size_t i = 0; ethd_scene_object(scene, i, &o) >= 0; i++) {
    double t = thickness(&o);
    thin += t < THIN;
    if (t < least) least = t, thinnest = i;
  }
  if (!thin || ethd_scene_object(scene, thinnest, &o) < 0) return;
  printf("%s%zu solid%s thinner than %g mm, object %zu (%s) is %.3g mm: a ring pressed in beyond the middle is pushed "
         "out on the other side; the force of a segment or polyline doesn't change its side\n",
         before, thin, thin == 1 ? " is" : "s are", 1e3 * THIN, thinnest, ethd_shape_name(o.shape), 1e3 * least);
}
