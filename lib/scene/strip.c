#include "scene/strip.h"

#include <float.h>

static const float *slopes(const ethd_scene *scene, const ethd__probe *p) {
  return ethd__is_true_to(p) ? ETHD__ARRAY(scene, float, slopes_at) : NULL;
}

/* ---- inside or outside ---- */

/* Returns the bits of the boxes that the ray from x to the right may meet. */
static unsigned ahead(const ethd__node *n, float x, float y) {
  unsigned meet = 0;
  for (int i = 0; i < ETHD__WIDE; i += 4) {
    ethd__floats c = ethd__load(n->c + i), s = ethd__load(n->s + i), w = ethd__load(n->w + i), h = ethd__load(n->h + i);
    ethd__floats du = ethd__load(n->u + i) - (c * x + s * y), dv = ethd__load(n->v + i) - (c * y - s * x);
    ethd__floats ac = ethd__abs(c), as = ethd__abs(s), tiny = ethd__all(ETHD__INFLATE);
    ethd__floats right = c * du - s * dv + (ac * w + as * h);
    ethd__floats above = ethd__abs(s * du + c * dv) - (as * w + ac * h);
    meet |= ethd__bits((right >= -tiny) & (above <= tiny)) << i;
  }
  return meet;
}

/* Returns true if x is inside, by the parity of the edges that a ray to the right crosses. Far outside the frame, where
   the boxes' errors would exceed their inflation, no point is inside. */
static bool contains(const ethd__strip *s, const ethd__chain *c) {
  const ethd__tree *tree = ethd__tree_at(s->scene, s->object);
  const ethd__probe *p = s->probe;
  struct {
    uint32_t level, index;
  } stack[(ETHD__WIDE - 1) * ETHD__LEVELS + 1] = {{tree->levels, 0}}, at;
  bool inside = false;
  if (!(fabsf(p->x) <= 2 && fabsf(p->y) <= 2)) return false;
  for (int count = 1; count > 0;) {
    at = stack[--count];
    if (at.level == 0) {
      inside ^= ethd__edge_crossed(ethd__chain_point(c, at.index), ethd__chain_point(c, at.index + 1), s->x);
      continue;
    }
    const ethd__node *n = p->nodes + tree->first[at.level] + at.index;
    for (unsigned meet = ahead(n, p->x, p->y); meet; meet &= meet - 1) {
      stack[count].level = at.level - 1;
      stack[count++].index = ETHD__WIDE * at.index + (uint32_t)__builtin_ctz(meet);
    }
  }
  return inside;
}

/* Squared distances of the nearest edge whose outer face may be towards x, and of the nearest whose inner face may
   be. */
typedef struct faces {
  double outer, inner;
} faces;

/* The nearest face decides. If a face of the other kind is equally near within rounding, edges are counted instead. */
static bool is_inside(const ethd__strip *s, const ethd__chain *c, const faces *f) {
  double outer = sqrt(f->outer), inner = sqrt(f->inner);
  double rounding = 4 * c->slack + 64 * DBL_EPSILON * fmin(outer, inner);
  return fabs(outer - inner) > rounding ? inner < outer : contains(s, c);
}

/* ---- the walk ---- */

/* Keeps edge k if it is the nearest so far; if faces are requested, its face counts in any case. */
ETHD__INLINE void take(const ethd__chain *c, uint32_t k, ethd_vec x, faces *f, ethd__nearest_edge *best) {
  ethd__beside s = ethd__beside_edge(ethd__chain_point(c, k), ethd__chain_point(c, k + (size_t)1), x);
  if (s.squared < best->squared || (s.squared == best->squared && k < best->edge)) {
    best->squared = s.squared;
    best->edge = k;
  }
  if (!f) return;
  double in = c->turn * s.across;
  if (!(in > s.doubt) && s.squared < f->outer) f->outer = s.squared;
  if (!(in < -s.doubt) && s.squared < f->inner) f->inner = s.squared;
}

/* Visits the likely edge first, or the edge found through the nearest boxes; its distance bounds the rest. It is
   compiled twice, with faces and without. */
ETHD__INLINE void visit(const ethd__strip *s, const ethd__chain *c, uint32_t first, faces *f, ethd__nearest_edge *out) {
  const ethd__probe *p = s->probe;
  ethd__walk walk;
  ethd__scene_place at;
  ethd__walk_start(&walk, ethd__tree_at(s->scene, s->object), p, slopes(s->scene, p));
  if (first < s->object->edges) {
    take(c, first, s->x, f, out);
    ethd__walk_around(&walk, first, ethd__bound(p, out->squared));
  } else {
    first = ethd__walk_down(&walk);
    take(c, first, s->x, f, out);
    ethd__walk_on(&walk, first, ethd__bound(p, out->squared));
  }
  while ((at = ethd__walk_next(&walk)).index != ETHD__NONE) {
    take(c, at.index, s->x, f, out);
    walk.bound = ethd__bound(p, out->squared);
  }
}

void ethd__strip_nearest(const ethd__strip *strip, uint32_t first, double limit, ethd__nearest_edge *out) {
  ethd__chain c = ethd__chain_of(strip->scene, strip->object);
  *out = (ethd__nearest_edge){limit, ETHD__NONE, false};
  visit(strip, &c, first, NULL, out);
}

void ethd__strip_signed(const ethd__strip *strip, uint32_t first, ethd__nearest_edge *out) {
  ethd__chain c = ethd__chain_of(strip->scene, strip->object);
  faces f = {INFINITY, INFINITY};
  *out = (ethd__nearest_edge){INFINITY, 0, false};
  visit(strip, &c, first, &f, out);
  out->inside = is_inside(strip, &c, &f);
}
