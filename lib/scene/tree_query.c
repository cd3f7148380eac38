/* The nearest object. A walk over the scene's tree gives objects, those in the nearest boxes first, and each one that
   is nearer lowers the walk's bound. A hint gives the place of the last query's result: the walk then starts there and
   mostly needs to open no other box; the result is the same as without the hint. */
#include "scene/strip.h"

typedef struct search {
  ethd__strip at; /* scene, x and the present object */
  ethd__probe probe;
  double squared;       /* of the distance of the nearest so far; 0 where x is inside it */
  double distance;      /* of the nearest so far; INFINITY while there is none */
  uint32_t place, edge; /* of the nearest so far; ETHD__NONE: there is none */
  ethd_touch touch;     /* of the nearest so far, unless it is a thin wall */
} search;

/* Returns true if an object at the same distance comes first: the result is the one with the lowest number. */
static bool goes_first(const search *q, uint32_t place) {
  return q->place == ETHD__NONE || ethd__object_at(q->at.scene, place)->id < ethd__object_at(q->at.scene, q->place)->id;
}

/* Keeps a thin wall if it is nearer. Its touch is computed only at the end, if it is the nearest. */
static void take_thin(search *q, uint32_t place, uint32_t edge, double squared) {
  if (q->distance < 0 || !(squared < q->squared || (squared == q->squared && goes_first(q, place)))) return;
  q->squared = squared;
  q->distance = sqrt(squared);
  q->place = place;
  q->edge = edge;
}

static void take_solid(search *q, uint32_t place, uint32_t edge, const ethd_touch *touch) {
  double d = touch->distance;
  if (!(d < q->distance || (d == q->distance && goes_first(q, place)))) return;
  q->squared = d > 0 ? d * d : 0;
  q->distance = d;
  q->place = place;
  q->edge = edge;
  q->touch = *touch;
}

static void take_polygon(search *q, uint32_t place, const ethd__object *o, bool maybe_inside, uint32_t first) {
  ethd__chain c = ethd__chain_of(q->at.scene, o);
  ethd__nearest_edge near;
  ethd_touch touch;
  q->at.object = o;
  if (maybe_inside)
    ethd__strip_signed(&q->at, first, &near);
  else
    ethd__strip_nearest(&q->at, first, q->squared, &near);
  if (near.edge == ETHD__NONE) return;
  ethd__chain_touch(&c, near.edge, q->at.x, near.inside, &touch);
  take_solid(q, place, near.edge, &touch);
}

static void take(search *q, uint32_t place, bool maybe_inside, uint32_t first) {
  const ethd__object *o = ethd__object_at(q->at.scene, place);
  if (o->edges == 1) {
    const double *p = ethd__numbers(q->at.scene, o);
    take_thin(q, place, 0, ethd__beside_edge(ethd_vec_of(p), ethd_vec_of(p + 2), q->at.x).squared);
  } else if (!ethd__has_tree(o)) {
    ethd_touch touch;
    ethd__object_nearest(q->at.scene, o, q->at.x, &touch);
    take_solid(q, place, 0, &touch);
  } else if (o->turn) {
    take_polygon(q, place, o, maybe_inside, first);
  } else {
    ethd__nearest_edge near;
    q->at.object = o;
    ethd__strip_nearest(&q->at, first, q->squared, &near);
    if (near.edge != ETHD__NONE) take_thin(q, place, near.edge, near.squared);
  }
}

static void answer(search *q, ethd_nearest *out) {
  const ethd__object *o = ethd__object_at(q->at.scene, q->place);
  if (o->edges == 1 || (ethd__has_tree(o) && !o->turn)) {
    ethd__chain c = ethd__chain_of(q->at.scene, o);
    ethd__chain_touch(&c, q->edge, q->at.x, false, &q->touch);
  }
  *out = (ethd_nearest){q->touch.distance, q->touch.point, q->touch.n, o->id};
}

/* Returns the edge to try first: the last query's, moved on by as many edges as it moved before. */
static uint32_t guess_edge(const search *q, uint32_t leaf, const ethd_scene_hint *hint) {
  uint32_t guess = hint->edge + (uint32_t)hint->step, edges = ethd__object_at(q->at.scene, leaf)->edges;
  return guess < edges ? guess : hint->edge;
}

/* Leaf numbers in a hint start at 1: 0 means no hint. */
static void renew(const search *q, ethd_scene_hint *hint) {
  bool same = hint->leaf == q->place + 1;
  *hint = (ethd_scene_hint){q->place + 1, q->edge, same ? (int32_t)(q->edge - hint->edge) : 0};
}

static void search_tree(search *q, const ethd_scene_hint *hint) {
  ethd__walk walk;
  ethd__scene_place at;
  uint32_t first = hint->leaf - 1; /* no hint: ETHD__NONE */
  if (q->at.scene->tree.leaves == 1) {
    take(q, 0, true, first == 0 ? guess_edge(q, 0, hint) : ETHD__NONE);
    return;
  }
  ethd__walk_start(&walk, &q->at.scene->tree, &q->probe, NULL);
  if (first < q->at.scene->tree.leaves) {
    take(q, first, true, guess_edge(q, first, hint));
    ethd__walk_around(&walk, first, ethd__bound(&q->probe, q->squared));
  } else {
    first = ethd__walk_down(&walk);
    take(q, first, true, ETHD__NONE);
    ethd__walk_on(&walk, first, ethd__bound(&q->probe, q->squared));
  }
  while ((at = ethd__walk_next(&walk)).index != ETHD__NONE) {
    take(q, at.index, at.squared == 0, ETHD__NONE);
    walk.bound = ethd__bound(&q->probe, q->squared);
  }
}

void ethd_scene_query_near(const ethd_scene *scene, ethd_vec x, ethd_scene_hint *hint, ethd_nearest *out) {
  *out = (ethd_nearest){INFINITY, x, {1, 0}, -1};
  if (!isfinite(x.x) || !isfinite(x.y)) return;
  search q;
  q.at.scene = scene;
  q.at.x = x;
  q.at.probe = &q.probe;
  q.probe = ethd__probe_at(scene, x);
  q.squared = q.distance = INFINITY;
  q.place = ETHD__NONE;
  for (uint32_t i = scene->tree.leaves; i < scene->object_count; i++) take(&q, i, true, ETHD__NONE);
  if (scene->tree.leaves) search_tree(&q, hint);
  if (q.place == ETHD__NONE) return;
  answer(&q, out);
  if (q.place < scene->tree.leaves) renew(&q, hint);
}

void ethd_scene_query(const ethd_scene *scene, ethd_vec x, ethd_nearest *out) {
  ethd_scene_hint hint = {0};
  ethd_scene_query_near(scene, x, &hint, out);
}
