#include "scene.h"

typedef struct list {
  ethd_touch *touches;
  size_t room, count;
  double range;
} list;

static bool deeper(const ethd_touch *a, const ethd_touch *b) {
  if (a->distance != b->distance) return a->distance < b->distance;
  if (a->object != b->object) return a->object < b->object;
  return a->feature < b->feature;
}

static void add(list *l, const ethd_touch *touch) {
  if (!(touch->distance <= l->range)) return;
  size_t kept = l->count < l->room ? l->count : l->room, i = kept;
  l->count++;
  while (i > 0 && deeper(touch, &l->touches[i - 1])) i--;
  if (i == l->room) return;
  for (size_t k = kept < l->room ? kept : kept - 1; k > i; k--) l->touches[k] = l->touches[k - 1];
  l->touches[i] = *touch;
}

/* A solid around x has one touch only; so has one that x is at. */
static bool has_one(const ethd_scene *scene, size_t object, const ethd_touch *nearest) {
  const ethd__object *o = &ethd__objects(scene)[object];
  if (!ethd__is_chain((ethd_shape)o->shape)) return true;
  return o->turn && nearest->distance <= scene->slack;
}

static void add_minima(const ethd_scene *scene, size_t object, ethd_vec x, list *l) {
  ethd__chain chain = ethd__chain_of(scene, object);
  ethd_touch touch;
  for (size_t k = 0; (k = ethd__chain_minimum(&chain, x, k, &touch)) != 0;) {
    ethd__label(scene, object, &touch);
    add(l, &touch);
  }
}

size_t ethd_scene_touches(const ethd_scene *scene, ethd_vec x, double range, ethd_touch *out, size_t room) {
  list l = {out, room, 0, range};
  for (size_t i = 0; i < scene->object_count; i++) {
    ethd_touch nearest;
    if (!(ethd__box_distance(scene, i, x) - scene->slack <= fmax(range, 0))) continue;
    ethd__object_nearest(scene, i, x, &nearest);
    if (!(nearest.distance <= range)) continue;
    if (has_one(scene, i, &nearest))
      add(&l, &nearest);
    else
      add_minima(scene, i, x, &l);
  }
  return l.count;
}

static double squared_distance(ethd_vec a, ethd_vec b) {
  ethd_vec u = ethd_vec_sub(a, b);
  return ethd_vec_dot(u, u);
}

void ethd_scene_follow(const ethd_scene *scene, int32_t object, ethd_vec x, ethd_vec from, ethd_touch *out) {
  size_t i = (size_t)object;
  ethd__object_nearest(scene, i, x, out);
  if (has_one(scene, i, out)) return;
  ethd__chain chain = ethd__chain_of(scene, i);
  ethd_touch touch;
  double least = INFINITY;
  for (size_t k = 0; (k = ethd__chain_minimum(&chain, x, k, &touch)) != 0;) {
    double d = squared_distance(touch.point, from);
    if (!(d < least)) continue;
    least = d;
    *out = touch;
  }
  ethd__label(scene, i, out);
}
