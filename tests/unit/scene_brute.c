#include "scene_brute.h"

#include <check.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/shapes.h"
#include "scene_objects.h"

/* ---- scenes ---- */

enum { OBJECTS = 400, NUMBERS = 20000 };

static struct {
  ethd_object_def objects[OBJECTS];
  double numbers[NUMBERS], size;
  size_t count, used;
} draft;

static void begin(double size) {
  draft.size = size;
  draft.count = draft.used = 0;
}

static void number(double v) {
  ck_assert_uint_lt(draft.used, NUMBERS);
  draft.numbers[draft.used++] = draft.size * v;
  draft.objects[draft.count - 1].count++;
}

static void object_of(ethd_shape shape) {
  ck_assert_uint_lt(draft.count, OBJECTS);
  draft.objects[draft.count++] = (ethd_object_def){shape, -1, draft.numbers + draft.used, 0, 0};
}

static void point_of(double x, double y) { number(x), number(y); }

static void segment_of(double x1, double y1, double x2, double y2) {
  object_of(ETHD_SHAPE_SEGMENT);
  point_of(x1, y1), point_of(x2, y2);
}

/* Lengths are scaled, angles and normals aren't. */
static void any_of(ethd_shape shape) {
  object o = scene_random(shape);
  object_of(shape);
  for (size_t k = 0; k < o.count; k++) {
    const ethd__shape *s = &ethd__shapes[shape];
    bool angle = s->form.numbers[ethd__number_of(&s->form, k)].kind == ETHD__DIRECTION;
    number(angle ? o.p[k] / draft.size : o.p[k]);
  }
}

/* Any shape but the half-plane, which is endless. */
static ethd_shape bounded(void) { return (ethd_shape)(1 + scene_draw() % (ETHD_SHAPE_COUNT - 1)); }

static ethd_scene *finish(void) {
  ethd_scene_def def = {draft.objects, draft.count, NULL, 0};
  ethd_scene *scene;
  ethd_error error = {.name = ""};
  ethd_status status = ethd_scene_create(&def, &scene, &error);
  ck_assert_msg(status == ETHD_OK, "%s: %s", ethd_status_sentence(status), error.name);
  return scene;
}

static ethd_scene *many(ethd_shape shape, double size) {
  begin(size);
  for (int n = 20 + (int)(scene_draw() % 150); n > 0; n--) any_of(shape);
  return finish();
}

static ethd_scene *circles(double size) { return many(ETHD_SHAPE_CIRCLE, size); }
static ethd_scene *capsules(double size) { return many(ETHD_SHAPE_CAPSULE, size); }
static ethd_scene *boxes(double size) { return many(ETHD_SHAPE_BOX, size); }
static ethd_scene *segments(double size) { return many(ETHD_SHAPE_SEGMENT, size); }
static ethd_scene *polygons(double size) { return many(ETHD_SHAPE_POLYGON, size); }
static ethd_scene *polylines(double size) { return many(ETHD_SHAPE_POLYLINE, size); }

static ethd_scene *mixed(double size) {
  begin(size);
  for (int n = 20 + (int)(scene_draw() % 150); n > 0; n--) any_of(bounded());
  if (scene_draw() % 2) any_of(ETHD_SHAPE_HALFPLANE);
  any_of(ETHD_SHAPE_CIRCLE);
  return finish();
}

static void star(int n, double x, double y, double r, double spikes) {
  int way = scene_draw() % 2 ? 1 : -1;
  object_of(ETHD_SHAPE_POLYGON);
  for (int k = 0; k < n; k++) {
    double a = way * 2 * M_PI * k / n, d = r * (1 + spikes * scene_uniform(-1, 1));
    point_of(x + d * cos(a), y + d * sin(a));
  }
}

/* One outline of many edges, from smooth to spiky. */
static ethd_scene *outline(double size) {
  static const double spikes[] = {0, 1e-6, 1e-3, 0.05, 0.9};
  begin(size);
  star(5 + (int)(scene_draw() % 1200), 0, 0, 0.5, spikes[scene_draw() % 5]);
  return finish();
}

/* Outlines within outlines, walls across them. */
static ethd_scene *nested(double size) {
  begin(size);
  for (int k = 1; k < 8; k++) star(10 * k, scene_uniform(-0.1, 0.1), 0, 0.09 * k, 0.1);
  for (int k = 0; k < 30; k++) any_of(bounded());
  return finish();
}

/* A room: one polygon with a notch that holds everything else. */
static ethd_scene *room(double size) {
  begin(size);
  object_of(ETHD_SHAPE_POLYGON);
  double s = 0.8, t = 0.85;
  for (int k = 0; k <= 100; k++) point_of(s * cos(0.06 * k), s * sin(0.06 * k));
  for (int k = 100; k >= 0; k--) point_of(t * cos(0.06 * k), t * sin(0.06 * k));
  for (int k = 0; k < 100; k++) any_of(bounded());
  return finish();
}

/* Teeth so thin that rounding can't tell their faces apart. */
static ethd_scene *needles(double size) {
  begin(size);
  object_of(ETHD_SHAPE_POLYGON);
  point_of(-0.6, -0.3), point_of(0.6, -0.3);
  for (int k = 10; k >= -10; k--) {
    double w = pow(10, scene_uniform(-15, -2)), x = 0.05 * k, h = scene_uniform(0, 0.5);
    point_of(x + w, -0.1), point_of(x, h), point_of(x - w, -0.1);
  }
  return finish();
}

static ethd_scene *scribble(double size) {
  double x = 0, y = 0;
  begin(size);
  object_of(ETHD_SHAPE_POLYLINE);
  for (int n = 2 + (int)(scene_draw() % 700); n > 0; n--)
    point_of(x, y), x = scene_uniform(-0.9, 0.9), y = scene_uniform(-0.9, 0.9);
  point_of(x, y);
  if (scene_draw() % 2) point_of(draft.objects[0].numbers[0] / size, draft.objects[0].numbers[1] / size);
  return finish();
}

static ethd_scene *spiral(double size) {
  begin(size);
  object_of(ETHD_SHAPE_POLYLINE);
  int n = 10 + (int)(scene_draw() % 3000);
  for (int k = 0; k < n; k++) point_of(0.9 * k / n * cos(40.0 * k / n), 0.9 * k / n * sin(40.0 * k / n));
  return finish();
}

/* Squares and crosses on a lattice: ties everywhere. */
static ethd_scene *lattice(double size) {
  begin(size);
  for (int i = -5; i < 5; i++)
    for (int j = -5; j < 5; j++) {
      double x = 0.125 * i, y = 0.125 * j, h = 0.0625;
      if ((i + j) % 3 == 0) {
        segment_of(x, y, x + 2 * h, y), segment_of(x, y, x, y + 2 * h);
      } else if ((i + j) % 3 == 1) {
        object_of(ETHD_SHAPE_POLYGON);
        point_of(x, y), point_of(x + h, y), point_of(x + 2 * h, y), point_of(x + 2 * h, y + h);
        point_of(x + 2 * h, y + 2 * h), point_of(x, y + 2 * h);
      } else {
        object_of(ETHD_SHAPE_CIRCLE);
        point_of(x + h, y + h), number(h);
      }
    }
  return finish();
}

/* Everything at one place, and twice. */
static ethd_scene *heap(double size) {
  begin(size);
  for (int k = 0; k < 100; k++) {
    segment_of(0.25, 0.5, 0.5, 0.25);
    object_of(ETHD_SHAPE_CAPSULE);
    point_of(0.25, 0.5), point_of(0.25, 0.5), number(0.125);
  }
  return finish();
}

/* Tiny things, far apart. */
static ethd_scene *dust(double size) {
  begin(size);
  for (int k = 0; k < 150; k++) {
    double x = scene_uniform(-0.9, 0.9), y = scene_uniform(-0.9, 0.9), e = pow(10, scene_uniform(-12, -2));
    if (k % 3 == 0) segment_of(x, y, x + e, y + e);
    if (k % 3 == 1) object_of(ETHD_SHAPE_CIRCLE), point_of(x, y), number(e);
    if (k % 3 == 2) {
      object_of(ETHD_SHAPE_POLYLINE);
      for (int i = 0; i < 9; i++) point_of(x + e * i, y + e * (i % 2));
    }
  }
  return finish();
}

const scene_kind scene_kinds[] = {
    {"circles", circles},   {"capsules", capsules},   {"boxes", boxes},     {"segments", segments},
    {"polygons", polygons}, {"polylines", polylines}, {"mixed", mixed},     {"outline", outline},
    {"nested", nested},     {"room", room},           {"needles", needles}, {"scribble", scribble},
    {"spiral", spiral},     {"lattice", lattice},     {"heap", heap},       {"dust", dust},
};
const int scene_kind_count = sizeof scene_kinds / sizeof *scene_kinds;

/* ---- object after object ---- */

typedef struct nearest {
  double distance, second; /* of another object */
  int32_t object;
} nearest;

static nearest brute_nearest(const ethd_scene *scene, ethd_vec x) {
  nearest n = {INFINITY, INFINITY, -1};
  for (uint32_t i = 0; i < scene->object_count; i++) {
    const ethd__object *o = ethd__object_at(scene, i);
    ethd_touch t;
    ethd__object_nearest(scene, o, x, &t);
    bool first = t.distance < n.distance || (t.distance == n.distance && o->id < n.object);
    n.second = fmin(n.second, first ? n.distance : t.distance);
    if (first) n.distance = t.distance, n.object = o->id;
  }
  return n;
}

static bool has_one(const ethd_scene *scene, const ethd__object *o, const ethd_touch *nearest_touch) {
  return !o->edges || (o->turn && nearest_touch->distance <= scene->slack);
}

enum { TOUCHES = 4096 };

static int in_order(const void *a, const void *b) {
  const ethd_touch *p = a, *q = b;
  if (p->distance != q->distance) return p->distance < q->distance ? -1 : 1;
  if (p->object != q->object) return p->object < q->object ? -1 : 1;
  return (p->feature > q->feature) - (p->feature < q->feature);
}

static size_t brute_touches(const ethd_scene *scene, ethd_vec x, double range, ethd_touch *out) {
  size_t n = 0;
  for (uint32_t i = 0; i < scene->object_count; i++) {
    const ethd__object *o = ethd__object_at(scene, i);
    ethd__chain chain = ethd__chain_of(scene, o);
    ethd_touch t;
    ethd__object_nearest(scene, o, x, &t);
    if (has_one(scene, o, &t)) {
      if (t.distance <= range) out[n++] = t;
      continue;
    }
    for (size_t k = 0; (k = ethd__chain_minimum(&chain, x, k, &t)) != 0;) {
      ethd__label(o, &t);
      ck_assert_uint_lt(n, TOUCHES);
      if (t.distance <= range) out[n++] = t;
    }
  }
  qsort(out, n, sizeof *out, in_order);
  return n;
}

static void brute_follow(const ethd_scene *scene, int32_t id, ethd_vec x, ethd_vec from, ethd_touch *out) {
  const ethd__object *o = NULL;
  for (uint32_t i = 0; i < scene->object_count; i++)
    if (ethd__object_at(scene, i)->id == id) o = ethd__object_at(scene, i);
  ethd__chain chain = ethd__chain_of(scene, o);
  ethd_touch t;
  double least = INFINITY;
  ethd__object_nearest(scene, o, x, out);
  if (has_one(scene, o, out)) return;
  for (size_t k = 0; (k = ethd__chain_minimum(&chain, x, k, &t)) != 0;) {
    ethd_vec u = ethd_vec_sub(t.point, from);
    if (!(ethd_vec_dot(u, u) < least)) continue;
    least = ethd_vec_dot(u, u);
    *out = t;
  }
  ethd__label(o, out);
}

/* ---- both ---- */

static double tight; /* m: at most 1e-15 of the larger of the scene and the distance from it */
static double slack; /* m: as near as this x is on a surface, with the normal of any edge there */

static void same_nearest(const char *how, const ethd_nearest *q, const nearest *b, ethd_vec x) {
  ck_assert_msg(fabs(q->distance - b->distance) <= tight, "%s: %.17g, not %.17g, at %.17g %.17g", how, q->distance,
                b->distance, x.x, x.y);
  if (b->second - b->distance > 2 * tight)
    ck_assert_msg(q->object == b->object, "%s: object %d, not %d", how, q->object, b->object);
  ck_assert(fabs(ethd_vec_norm(q->n) - 1) <= 4 * DBL_EPSILON);
  ethd_vec p = ethd_vec_add(x, ethd_vec_scale(q->distance, q->n));
  ck_assert_msg(ethd_vec_norm(ethd_vec_sub(p, q->point)) <= 4 * tight + (fabs(q->distance) <= slack ? 2 * slack : 0),
                "%s: the point isn't %g along n", how, q->distance);
}

/* All numbers of a touch; of a polygon around x or at it only the distance, for several edges may be as near. */
static bool same_touch(const ethd_touch *a, const ethd_touch *b) {
  if (a->object != b->object || a->material != b->material || fabs(a->distance - b->distance) > tight) return false;
  return b->distance <= fmax(tight, slack) ||
         (a->distance == b->distance && a->point.x == b->point.x && a->point.y == b->point.y && a->n.x == b->n.x &&
          a->n.y == b->n.y && a->feature == b->feature && a->side == b->side);
}

static bool is_among(const ethd_touch *t, const ethd_touch *list, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (same_touch(&list[i], t)) return true;
  return false;
}

static void check_nearest(const ethd_scene *scene, ethd_vec x, ethd_scene_hint *path) {
  tight = SCENE_TIGHT * fmax(draft.size, fmax(fabs(x.x), fabs(x.y)));
  slack = scene->slack;
  nearest b = brute_nearest(scene, x);
  ethd_nearest cold, warm, lost;
  ethd_scene_hint wrong = {(uint32_t)scene_draw() % 2000, (uint32_t)scene_draw() % 2000, (int32_t)scene_draw()};
  ethd_scene_query(scene, x, &cold);
  ethd_scene_query_near(scene, x, path, &warm);
  ethd_scene_query_near(scene, x, &wrong, &lost);
  same_nearest("cold", &cold, &b, x);
  same_nearest("warm", &warm, &b, x);
  same_nearest("lost", &lost, &b, x);
}

static void check_touches(const ethd_scene *scene, ethd_vec x, double range) {
  static ethd_touch expected[TOUCHES], found[TOUCHES];
  size_t n = brute_touches(scene, x, range, expected), room = scene_draw() % 2 ? TOUCHES : 8;
  size_t m = ethd_scene_touches(scene, x, range, found, room);
  ck_assert_msg(n == m, "%zu touches, not %zu, within %g of %.17g %.17g", m, n, range, x.x, x.y);
  if (m > room) m = room;
  for (size_t i = 0; i < m; i++) {
    ck_assert_msg(fabs(found[i].distance - expected[i].distance) <= tight, "touch %zu: %.17g, not %.17g", i,
                  found[i].distance, expected[i].distance);
    ck_assert_msg(i == 0 || in_order(&found[i - 1], &found[i]) <= 0, "touch %zu is out of order", i);
    ck_assert_msg(is_among(&found[i], expected, n), "touch %zu: no %d/%d at %.17g", i, found[i].object,
                  found[i].feature, found[i].distance);
  }
}

static void check_follow(const ethd_scene *scene, ethd_vec x) {
  double s = draft.size;
  int32_t id = (int32_t)(scene_draw() % scene->object_count);
  ethd_vec from = {x.x + s * scene_uniform(-0.1, 0.1), x.y + s * scene_uniform(-0.1, 0.1)};
  ethd_touch a, b;
  ethd_scene_follow(scene, id, x, from, &a);
  brute_follow(scene, id, x, from, &b);
  ck_assert_msg(same_touch(&a, &b), "object %d at %.17g %.17g: feature %d, not %d", id, x.x, x.y, a.feature, b.feature);
}

/* Anywhere, near a number of the scene's, on a lattice, far away. */
static ethd_vec place(void) {
  double s = draft.size, e = pow(10, scene_uniform(-17, -1)) * s, f = pow(10, scene_uniform(0, 9)) * s;
  size_t i = scene_draw() % (draft.used / 2) * 2;
  switch (scene_draw() % 9) {
  case 0:
  case 1:
  case 2: return (ethd_vec){draft.numbers[i] + scene_uniform(-e, e), draft.numbers[i + 1] + scene_uniform(-e, e)};
  case 3: return (ethd_vec){0.0625 * s * (int)(scene_draw() % 16), 0.0625 * s * (int)(scene_draw() % 16)};
  case 4: return (ethd_vec){draft.numbers[i], scene_uniform(-s, s)};
  case 5: return (ethd_vec){scene_uniform(-f, f), scene_draw() % 2 ? scene_uniform(-f, f) : draft.numbers[i + 1]};
  default: return (ethd_vec){scene_uniform(-s, s), scene_uniform(-s, s)};
  }
}

void scene_check_kind(const scene_kind *kind, double size, int queries) {
  for (int left = queries; left > 0;) {
    ethd_scene *scene = kind->create(size);
    ethd_scene_hint path = {0};
    for (int i = 0; i < 250 && left > 0; i++, left--) {
      ethd_vec x = place();
      check_nearest(scene, x, &path);
      check_touches(scene, x, size * (scene_draw() % 2 ? 0.03 : scene_uniform(0, 0.5)));
      check_follow(scene, x);
      for (int step = 0; step < 3; step++) {
        x.x += 1e-3 * size, x.y += 5e-4 * size;
        check_nearest(scene, x, &path);
        left--;
      }
    }
    ethd_scene_destroy(scene);
  }
}

static uint64_t hash(uint64_t h, const void *data, size_t size) {
  const unsigned char *p = data;
  for (size_t i = 0; i < size; i++) h = (h ^ p[i]) * 0x100000001b3u;
  return h;
}

uint64_t scene_hash(const scene_kind *kind, int queries) {
  uint64_t h = 0xcbf29ce484222325u;
  ethd_scene_hint hint = {0};
  ethd_scene *scene = kind->create(1);
  for (int i = 0; i < queries; i++) {
    ethd_vec x = {scene_uniform(-1, 1), scene_uniform(-1, 1)};
    ethd_nearest q;
    ethd_touch t[8];
    ethd_scene_query_near(scene, x, &hint, &q);
    size_t count = ethd_scene_touches(scene, x, 0.1, t, 8);
    h = hash(h, &q, offsetof(ethd_nearest, object) + sizeof q.object);
    h = hash(h, &count, sizeof count);
    h = hash(h, t, (count < 8 ? count : 8) * sizeof *t);
  }
  ethd_scene_destroy(scene);
  return h;
}
