#include "scene_objects.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint64_t state;

void scene_seed(uint64_t seed) { state = seed; }

uint64_t scene_draw(void) {
  uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

double scene_uniform(double a, double b) { return a + (b - a) * (double)(scene_draw() >> 11) * 0x1p-53; }

/* ---- objects ---- */

void scene_add(object *o, double v) { o->p[o->count++] = v; }

/* Points about a centre in the order of their angles: simple, mostly concave, of either winding. */
static void star(object *o, size_t n, double x, double y, double least, double most) {
  int clockwise = scene_draw() % 2;
  for (size_t k = 0; k < n; k++) {
    double a = 2 * M_PI * ((double)k + scene_uniform(0.1, 0.9)) / (double)n * (clockwise ? -1 : 1);
    double r = scene_uniform(least, most);
    scene_add(o, x + r * cos(a));
    scene_add(o, y + r * sin(a));
  }
}

object scene_random(ethd_shape shape) {
  object o = {shape, 0, {0}};
  double a = scene_uniform(-4, 4), x = scene_uniform(-0.7, 0.7), y = scene_uniform(-0.7, 0.7);
  switch (shape) {
  case ETHD_SHAPE_HALFPLANE: scene_add(&o, cos(a)), scene_add(&o, sin(a)), scene_add(&o, x); break;
  case ETHD_SHAPE_CIRCLE: scene_add(&o, x), scene_add(&o, y), scene_add(&o, scene_uniform(0.001, 0.3)); break;
  case ETHD_SHAPE_CAPSULE:
    scene_add(&o, x), scene_add(&o, y);
    scene_add(&o, x + scene_uniform(-0.3, 0.3)), scene_add(&o, y + scene_uniform(-0.3, 0.3));
    scene_add(&o, scene_uniform(0.001, 0.1));
    break;
  case ETHD_SHAPE_BOX:
    scene_add(&o, x), scene_add(&o, y);
    scene_add(&o, scene_uniform(0.001, 0.2)), scene_add(&o, scene_uniform(0.001, 0.2)), scene_add(&o, a);
    break;
  case ETHD_SHAPE_POLYGON: star(&o, 3 + scene_draw() % 20, x, y, 0.03, 0.29); break;
  case ETHD_SHAPE_SEGMENT:
    for (int i = 0; i < 4; i++) scene_add(&o, scene_uniform(-0.7, 0.7));
    break;
  default:
    for (size_t n = 2 + scene_draw() % 20, k = 0; k < n; k++) {
      scene_add(&o, x += scene_uniform(-0.1, 0.1));
      scene_add(&o, y += scene_uniform(-0.1, 0.1));
    }
  }
  return o;
}

ethd_scene *scene_build(const object *objects, size_t n) {
  ethd_object_def *defs = calloc(n + 1, sizeof *defs);
  for (size_t i = 0; i < n; i++) defs[i] = (ethd_object_def){objects[i].shape, -1, objects[i].p, objects[i].count, 0};
  ethd_scene_def def = {defs, n, NULL, 0};
  ethd_scene *scene;
  ethd_error error = {.name = ""};
  ethd_status status = ethd_scene_create(&def, &scene, &error);
  ck_assert_msg(status == ETHD_OK, "%s: %s", ethd_status_sentence(status), error.name);
  free(defs);
  return scene;
}

ethd_scene *scene_one(ethd_shape shape, size_t count, const double *p) {
  object o = {shape, count, {0}};
  memcpy(o.p, p, count * sizeof *p);
  return scene_build(&o, 1);
}
/* ---- the same distances, another way ---- */

/* Twice the area over the base where the foot lies between the ends. */
real scene_to_edge(real ax, real ay, real bx, real by, real x, real y) {
  real a = hypotl(bx - x, by - y), b = hypotl(ax - x, ay - y), c = hypotl(bx - ax, by - ay);
  if (a * a >= b * b + c * c) return b;
  if (b * b >= a * a + c * c) return a;
  real area2 = fabsl(ax * (by - y) + bx * (y - ay) + x * (ay - by)); /* shoelace */
  return area2 / c;
}

real scene_to_chain(const double *p, size_t n, int closed, real x, real y) {
  real least = INFINITY;
  for (size_t k = 0; k + !closed < n; k++) {
    const double *a = p + 2 * k, *b = p + 2 * ((k + 1) % n);
    least = fminl(least, scene_to_edge(a[0], a[1], b[0], b[1], x, y));
  }
  return least;
}

/* Turns of the boundary about x. */
int scene_winding(const double *p, size_t n, real x, real y) {
  real sum = 0;
  for (size_t k = 0; k < n; k++) {
    const double *a = p + 2 * k, *b = p + 2 * ((k + 1) % n);
    real ux = a[0] - x, uy = a[1] - y, wx = b[0] - x, wy = b[1] - y;
    sum += atan2l(ux * wy - uy * wx, ux * wx + uy * wy);
  }
  return (int)roundl(sum / (2 * acosl(-1)));
}

real scene_expected(const object *o, real x, real y) {
  const double *p = o->p;
  real d;
  switch (o->shape) {
  case ETHD_SHAPE_HALFPLANE: {
    real nx = p[0], ny = p[1], l = hypotl(nx, ny);
    return (p[2] - nx * x - ny * y) / l;
  }
  case ETHD_SHAPE_CIRCLE: return hypotl(x - p[0], y - p[1]) - p[2];
  case ETHD_SHAPE_CAPSULE: return scene_to_edge(p[0], p[1], p[2], p[3], x, y) - p[4];
  case ETHD_SHAPE_BOX: {
    real c = cosl(p[4]), s = sinl(p[4]), w = p[2], h = p[3];
    real d4 = INFINITY, sx[4] = {-1, 1, 1, -1}, sy[4] = {-1, -1, 1, 1}, qx[4], qy[4];
    int outside = 0;
    for (int k = 0; k < 4; k++) {
      qx[k] = p[0] + c * sx[k] * w - s * sy[k] * h;
      qy[k] = p[1] + s * sx[k] * w + c * sy[k] * h;
    }
    for (int k = 0; k < 4; k++) {
      int l = (k + 1) % 4;
      d4 = fminl(d4, scene_to_edge(qx[k], qy[k], qx[l], qy[l], x, y));
      outside |= (qx[l] - qx[k]) * (y - qy[k]) - (qy[l] - qy[k]) * (x - qx[k]) < 0;
    }
    return outside ? d4 : -d4;
  }
  case ETHD_SHAPE_POLYGON:
    d = scene_to_chain(p, o->count / 2, 1, x, y);
    return scene_winding(p, o->count / 2, x, y) ? -d : d;
  default: return scene_to_chain(p, o->count / 2, 0, x, y);
  }
}
