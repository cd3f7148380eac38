#include <float.h>

#include "scene/build.h"

#define DIRECTIONS 8 /* directions tried over 90 degrees, after which boxes repeat */
#define SAMPLES 32   /* discs used to compare directions */

static const float directions[DIRECTIONS][2] = {
    {1, 0},
    {0.98078528f, 0.19509032f},
    {0.92387953f, 0.38268343f},
    {0.83146961f, 0.55557023f},
    {0.70710678f, 0.70710678f},
    {0.55557023f, 0.83146961f},
    {0.38268343f, 0.92387953f},
    {0.19509032f, 0.98078528f},
};

typedef struct box_span {
  double min, max;
} box_span;

typedef struct rectangle {
  float c, s;
  box_span u, v;
} rectangle;

static void widen(box_span *s, double v, double r) {
  s->min = v - r < s->min ? v - r : s->min;
  s->max = v + r > s->max ? v + r : s->max;
}

/* Every step-th disc of a cloud in [from, to). */
typedef struct run {
  const ethd__cloud *cloud;
  size_t from, to, step;
} run;

/* Finds the rectangle around a run whose u axis is (c, s). */
static rectangle around(const run *of, float c, float s) {
  const ethd__cloud *k = of->cloud;
  rectangle b = {c, s, {INFINITY, -INFINITY}, {INFINITY, -INFINITY}};
  for (size_t i = of->from; i < of->to; i += of->step) {
    ethd_vec p = k->points[i];
    double r = k->radii ? k->radii[i] : 0;
    widen(&b.u, c * p.x + s * p.y, r);
    widen(&b.v, c * p.y - s * p.x, r);
  }
  return b;
}

static double width(box_span s) { return s.max - s.min; }

/* Returns the area of points nearer to the box than `near`, minus the part that is equal for all boxes. The smaller it
   is, the fewer queries open the box. */
static double cost(const rectangle *b) {
  double w = width(b->u), h = width(b->v), near = 0.01;
  return w * h + near * (w + h);
}

/* Finds the rectangle whose u axis is along the line from the first disc to the last. */
static rectangle along(const run *of) {
  ethd_vec e = ethd_vec_sub(of->cloud->points[of->to - 1], of->cloud->points[of->from]);
  double length = ethd_vec_norm(e);
  bool any = length > 0;
  return around(of, any ? (float)(e.x / length) : 1, any ? (float)(e.y / length) : 0);
}

static rectangle fit(const ethd__cloud *k, size_t from, size_t to) {
  run all = {k, from, to, 1}, some = {k, from, to, (to - from + SAMPLES - 1) / SAMPLES};
  if (to - from <= 2) return along(&all);
  rectangle best = along(&some);
  for (int i = 0; i < DIRECTIONS; i++) {
    rectangle b = around(&some, directions[i][0], directions[i][1]);
    if (cost(&b) < cost(&best)) best = b;
  }
  return around(&all, best.c, best.s);
}

/* Rounds the middle to a float and increases the half width by the possible rounding error. */
static void set(box_span s, float *middle, float *half) {
  *middle = (float)((s.min + s.max) / 2);
  double reach = fmax(s.max - (double)*middle, (double)*middle - s.min);
  *half = (float)(reach * (1 + 4 * (double)FLT_EPSILON)) + ETHD__INFLATE;
}

void ethd__box_fit(const ethd__cloud *k, size_t from, size_t to, ethd__node *node, size_t lane) {
  rectangle b = fit(k, from, to);
  node->c[lane] = b.c;
  node->s[lane] = b.s;
  set(b.u, &node->u[lane], &node->w[lane]);
  set(b.v, &node->v[lane], &node->h[lane]);
}

void ethd__box_clear(ethd__node *node, size_t lane) {
  node->c[lane] = node->s[lane] = node->v[lane] = node->w[lane] = node->h[lane] = 0;
  node->u[lane] = INFINITY;
}
