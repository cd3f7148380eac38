#include "fp_mode.h"
#include "scene/strip.h"

/* ---- all touches ---- */

typedef struct touch_list {
  ethd_touch *touches;
  size_t room, count;
  double range;
} touch_list;

static bool deeper(const ethd_touch *a, const ethd_touch *b) {
  if (a->distance != b->distance) return a->distance < b->distance;
  if (a->object != b->object) return a->object < b->object;
  return a->feature < b->feature;
}

static void add(touch_list *l, const ethd_touch *touch) {
  if (!(touch->distance <= l->range)) return;
  size_t kept = l->count < l->room ? l->count : l->room, i = kept;
  l->count++;
  while (i > 0 && deeper(touch, &l->touches[i - 1])) i--;
  if (i == l->room) return;
  for (size_t k = kept < l->room ? kept : kept - 1; k > i; k--) l->touches[k] = l->touches[k - 1];
  l->touches[i] = *touch;
}

/* Returns true if only the nearest point counts: a closed form is convex, and a solid has one touch when x is inside or
   at its surface. */
static bool has_one(const ethd_scene *scene, const ethd__object *o, double distance) {
  return !o->edges || (o->turn && distance <= scene->slack);
}

static void add_object(const ethd_scene *scene, const ethd__object *o, ethd_vec x, touch_list *l) {
  ethd__chain chain = ethd__chain_of(scene, o);
  ethd_touch touch;
  if (!o->edges || o->turn) {
    ethd__object_nearest(scene, o, x, &touch);
    if (has_one(scene, o, touch.distance)) {
      add(l, &touch);
      return;
    }
  }
  for (size_t k = 0; (k = ethd__chain_minimum(&chain, x, k, &touch)) != 0;) {
    ethd__label(o, &touch);
    add(l, &touch);
  }
}

/* Finds the nearest point of a polygon with a tree, without its label; returns true if it is the only touch. */
static bool only_touch(const ethd__strip *strip, ethd_touch *out) {
  ethd__chain chain = ethd__chain_of(strip->scene, strip->object);
  ethd__nearest_edge near;
  ethd__strip_signed(strip, ETHD__NONE, &near);
  ethd__chain_touch(&chain, near.edge, strip->x, near.inside, out);
  return has_one(strip->scene, strip->object, out->distance);
}

static void add_strip(const ethd__strip *strip, bool maybe_inside, float bound, touch_list *l) {
  const ethd__object *o = strip->object;
  ethd_touch touch;
  ethd__minima minima;
  if (o->turn && maybe_inside && only_touch(strip, &touch)) {
    ethd__label(o, &touch);
    add(l, &touch);
    return;
  }
  ethd__minima_start(&minima, strip, strip->probe);
  minima.bound = bound;
  while (ethd__minima_next(&minima, &touch)) {
    ethd__label(o, &touch);
    add(l, &touch);
  }
}

/* Adds the touches of the object at `at`, which is put into `leaf`. x can be inside an object only if its box is at
   distance 0. */
static void add_leaf(ethd__strip *leaf, ethd__scene_place at, float bound, touch_list *l) {
  leaf->object = ethd__object_at(leaf->scene, at.index);
  if (ethd__has_tree(leaf->object))
    add_strip(leaf, at.squared == 0, bound, l);
  else
    add_object(leaf->scene, leaf->object, leaf->x, l);
}

static void add_tree(const ethd_scene *scene, ethd_vec x, double reach, touch_list *l) {
  ethd__probe p = ethd__probe_at(scene, x);
  ethd__strip leaf = {scene, NULL, &p, x};
  ethd__walk walk;
  ethd__scene_place at = {0, 0, 0};
  float bound = ethd__bound(&p, reach * reach);
  if (scene->tree.leaves == 1) {
    add_leaf(&leaf, at, bound, l);
    return;
  }
  ethd__walk_start(&walk, &scene->tree, &p, NULL);
  ethd__walk_around(&walk, 0, bound);
  for (; at.index != ETHD__NONE; at = ethd__walk_next(&walk)) add_leaf(&leaf, at, bound, l);
}

size_t ethd_scene_touches(const ethd_scene *scene, ethd_vec x, double range, ethd_touch *out, size_t room) {
  touch_list l = {out, room, 0, range};
  if (!isfinite(x.x) || !isfinite(x.y) || isnan(range)) return 0;
  for (uint32_t i = scene->tree.leaves; i < scene->object_count; i++)
    add_object(scene, ethd__object_at(scene, i), x, &l);
  if (scene->tree.leaves) add_tree(scene, x, fmax(range, 0) + scene->slack, &l);
  return l.count;
}

/* ---- the continuation of a touch ---- */

/* Keeps the touch nearest to `from`; of several equally near ones, the first along the chain. */
static void take(const ethd_touch *touch, ethd_vec from, double *least, ethd_touch *out) {
  ethd_vec u = ethd_vec_sub(touch->point, from);
  double d = ethd_vec_dot(u, u);
  if (!(d < *least || (d == *least && touch->feature < out->feature))) return;
  *least = d;
  *out = *touch;
}

static void follow_strip(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_vec from, ethd_touch *out) {
  ethd__probe at_x = ethd__probe_at(scene, x), at_from = ethd__probe_at(scene, from);
  ethd__strip strip = {scene, o, &at_x, x};
  ethd_touch touch;
  ethd__minima minima;
  double least = INFINITY;
  if (o->turn && only_touch(&strip, out)) return;
  ethd__minima_start(&minima, &strip, &at_from);
  while (ethd__minima_next(&minima, &touch)) {
    take(&touch, from, &least, out);
    minima.bound = ethd__bound(&at_from, least);
  }
  if (!(least < INFINITY)) ethd__object_nearest(scene, o, x, out);
}

static void follow_object(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_vec from, ethd_touch *out) {
  ethd__chain chain = ethd__chain_of(scene, o);
  ethd_touch touch;
  double least = INFINITY;
  ethd__object_nearest(scene, o, x, out);
  if (has_one(scene, o, out->distance)) return;
  for (size_t k = 0; (k = ethd__chain_minimum(&chain, x, k, &touch)) != 0;) take(&touch, from, &least, out);
}

/* Finds an object by bisection over the ids, which rise; if no object was left out, an id is its own index. */
static const ethd__object *object_of(const ethd_scene *scene, int32_t id) {
  const uint32_t *places = ETHD__ARRAY(scene, uint32_t, places_at);
  uint32_t low = scene->dropped ? 0 : (uint32_t)id, high = scene->dropped ? scene->object_count : low + 1;
  while (high - low > 1) {
    uint32_t middle = low + (high - low) / 2;
    *(ethd__object_at(scene, places[middle])->id <= id ? &low : &high) = middle;
  }
  return ethd__object_at(scene, places[low]);
}

ETHD__FP_APART static void follow(const ethd_scene *scene, int32_t object, ethd_vec x, ethd_vec from, ethd_touch *out) {
  const ethd__object *o = object_of(scene, object);
  if (ethd__has_tree(o))
    follow_strip(scene, o, x, from, out);
  else
    follow_object(scene, o, x, from, out);
  ethd__label(o, out);
}

void ethd_scene_follow(const ethd_scene *scene, int32_t object, ethd_vec x, ethd_vec from, ethd_touch *out) {
  ETHD__FP_DO(follow(scene, object, x, from, out));
}
