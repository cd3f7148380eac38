/* Is a closed chain a simple polygon? A line sweeps over its points in the order of x, then y. The edges
   that it crosses are kept in their order along it, in a tree balanced by random priorities (treap). The
   first two edges that meet are neighbours before they do (Shamos and Hoey 1976), so it is enough to
   test new neighbours. Every decision is exact, and the time is O(n log n). */
#include "scene/check.h"
#include "scene/scene.h"

#define NONE UINT32_MAX

/* An edge in the tree, and its neighbours along the sweep line. */
typedef struct node {
  uint32_t parent, child[2]; /* [0] below, [1] above */
  uint32_t beside[2];
  uint32_t priority;
} node;

typedef struct sweep {
  const double *points; /* {x, y} */
  uint32_t n;
  uint32_t *order;
  node *nodes;
  uint32_t root;
  size_t *meet;
} sweep;

size_t ethd__simple_room(size_t n) { return n * (sizeof(node) + 2 * sizeof(uint32_t)); }

static ethd_vec point(const sweep *s, uint32_t k) {
  ethd_vec p = {s->points[2 * (size_t)k], s->points[2 * (size_t)k + 1]};
  return p;
}

static bool precedes(const sweep *s, uint32_t a, uint32_t b) {
  ethd_vec p = point(s, a), q = point(s, b);
  return p.x < q.x || (p.x == q.x && p.y < q.y);
}

static uint32_t next(const sweep *s, uint32_t k) { return k + 1 < s->n ? k + 1 : 0; }
static uint32_t previous(const sweep *s, uint32_t k) { return k ? k - 1 : s->n - 1; }

/* Edge k connects point k and the next; the sweep meets its start first. */
static uint32_t start_of(const sweep *s, uint32_t k) { return precedes(s, k, next(s, k)) ? k : next(s, k); }
static uint32_t end_of(const sweep *s, uint32_t k) { return precedes(s, k, next(s, k)) ? next(s, k) : k; }

static int orient(const sweep *s, uint32_t a, uint32_t b, uint32_t c) {
  return ethd__orient(point(s, a), point(s, b), point(s, c));
}

/* ---- order of the points: merge sort ---- */

/* Merges two sorted runs of `width` that start at `low`; the last ones may be shorter. */
static void merge(const sweep *s, const uint32_t *from, uint32_t *to, size_t low, size_t width) {
  size_t middle = low + width < s->n ? low + width : s->n, high = middle + width < s->n ? middle + width : s->n;
  size_t i = low, j = middle;
  for (size_t k = low; k < high; k++)
    to[k] = i < middle && (j >= high || !precedes(s, from[j], from[i])) ? from[i++] : from[j++];
}

static void sort(sweep *s, uint32_t *a, uint32_t *b) {
  size_t n = s->n;
  for (size_t k = 0; k < n; k++) a[k] = (uint32_t)k;
  for (size_t width = 1; width < n; width *= 2) {
    for (size_t low = 0; low < n; low += 2 * width) merge(s, a, b, low, width);
    uint32_t *t = a;
    a = b;
    b = t;
  }
  s->order = a;
}

/* ---- do two edges meet where they must not? ---- */

static bool share(const sweep *s, uint32_t e, uint32_t f) { return f == next(s, e) || e == next(s, f); }

/* Returns true if two neighbours with a common point overlap. They leave it towards the same side of the sweep line, so
   they overlap exactly if they leave it in the same direction. */
static bool fold(const sweep *s, uint32_t e, uint32_t f) {
  uint32_t p = f == next(s, e) ? f : e;
  return orient(s, p, previous(s, p), next(s, p)) == 0;
}

/* Neighbours on one line overlap: otherwise the sweep line wouldn't cross both. */
static bool cross(const sweep *s, uint32_t e, uint32_t f) {
  uint32_t a = start_of(s, e), b = end_of(s, e), c = start_of(s, f), d = end_of(s, f);
  int oc = orient(s, a, b, c), od = orient(s, a, b, d);
  return oc * od <= 0 && orient(s, c, d, a) * orient(s, c, d, b) <= 0;
}

static bool meets(const sweep *s, uint32_t e, uint32_t f) {
  if (e == NONE || f == NONE) return false;
  if (!(share(s, e, f) ? fold(s, e, f) : cross(s, e, f))) return false;
  s->meet[0] = e < f ? e : f;
  s->meet[1] = e < f ? f : e;
  return true;
}

/* ---- the edges along the line ---- */

static void put_in_place(sweep *s, uint32_t parent, uint32_t old, uint32_t new) {
  if (parent == NONE)
    s->root = new;
  else
    s->nodes[parent].child[s->nodes[parent].child[1] == old] = new;
  if (new != NONE) s->nodes[new].parent = parent;
}

/* Lifts e above its parent. */
static void rotate(sweep *s, uint32_t e) {
  node *t = s->nodes;
  uint32_t p = t[e].parent;
  int side = t[p].child[1] == e;
  uint32_t inner = t[e].child[!side];
  put_in_place(s, t[p].parent, p, e);
  t[p].child[side] = inner;
  if (inner != NONE) t[inner].parent = p;
  t[e].child[!side] = p;
  t[p].parent = e;
}

static void link_beside(sweep *s, uint32_t below, uint32_t above) {
  if (below != NONE) s->nodes[below].beside[1] = above;
  if (above != NONE) s->nodes[above].beside[0] = below;
}

static uint32_t scrambled(uint32_t k) {
  k = (k ^ (k >> 16)) * 0x7feb352du;
  k = (k ^ (k >> 15)) * 0x846ca68bu;
  return k ^ (k >> 16);
}

/* Inserts e between two neighbours: one has no child on the other's side, and e goes there. */
static void insert(sweep *s, uint32_t e, uint32_t below, uint32_t above) {
  node *t = s->nodes;
  t[e] = (node){NONE, {NONE, NONE}, {NONE, NONE}, scrambled(e)};
  link_beside(s, below, e);
  link_beside(s, e, above);
  bool over = below != NONE && t[below].child[1] == NONE;
  uint32_t parent = over ? below : above;
  t[e].parent = parent;
  if (parent == NONE)
    s->root = e;
  else
    t[parent].child[over] = e;
  while (t[e].parent != NONE && t[e].priority > t[t[e].parent].priority) rotate(s, e);
}

static void take_out(sweep *s, uint32_t e) {
  node *t = s->nodes;
  for (;;) {
    uint32_t l = t[e].child[0], r = t[e].child[1];
    if (l == NONE || r == NONE) {
      put_in_place(s, t[e].parent, e, l == NONE ? r : l);
      break;
    }
    rotate(s, t[l].priority > t[r].priority ? l : r);
  }
  link_beside(s, t[e].beside[0], t[e].beside[1]);
}

/* Puts f in the place of e, which ends where f starts. */
static void replace(sweep *s, uint32_t e, uint32_t f) {
  node *t = s->nodes;
  t[f] = t[e];
  put_in_place(s, t[e].parent, e, f);
  for (int i = 0; i < 2; i++)
    if (t[f].child[i] != NONE) t[t[f].child[i]].parent = f;
  link_beside(s, t[f].beside[0], f);
  link_beside(s, f, t[f].beside[1]);
}

/* ---- the sweep over the points ---- */

static bool both_start(sweep *s, uint32_t v) {
  uint32_t e = previous(s, v), f = v, at = s->root, beside[2] = {NONE, NONE};
  while (at != NONE) {
    int above = orient(s, start_of(s, at), end_of(s, at), v);
    if (above == 0) {
      s->meet[0] = at;
      s->meet[1] = v;
      return false;
    }
    beside[above < 0] = at;
    at = s->nodes[at].child[above > 0];
  }
  int turn = orient(s, v, end_of(s, e), end_of(s, f));
  uint32_t low = turn > 0 ? e : f, high = turn > 0 ? f : e;
  insert(s, low, beside[0], beside[1]);
  insert(s, high, low, beside[1]);
  return !meets(s, e, f) && !meets(s, beside[0], low) && !meets(s, high, beside[1]);
}

static bool both_end(sweep *s, uint32_t v) {
  uint32_t e = previous(s, v), f = v;
  take_out(s, e);
  uint32_t below = s->nodes[f].beside[0], above = s->nodes[f].beside[1];
  take_out(s, f);
  return !meets(s, below, above);
}

static bool one_goes_on(sweep *s, uint32_t v) {
  uint32_t e = previous(s, v), f = v;
  if (start_of(s, e) == v) e = v, f = previous(s, v);
  replace(s, e, f);
  return !meets(s, s->nodes[f].beside[0], f) && !meets(s, f, s->nodes[f].beside[1]);
}

static bool pass(sweep *s, uint32_t v) {
  int starting = (start_of(s, previous(s, v)) == v) + (start_of(s, v) == v);
  return starting == 2 ? both_start(s, v) : starting == 1 ? one_goes_on(s, v) : both_end(s, v);
}

bool ethd__is_simple(const double *points, size_t n, void *room, size_t meet[2]) {
  node *nodes = room;
  uint32_t *numbers = (uint32_t *)(nodes + n);
  sweep s = {points, (uint32_t)n, NULL, nodes, NONE, meet};
  sort(&s, numbers, numbers + n);
  for (size_t i = 0; i + 1 < n; i++) {
    if (precedes(&s, s.order[i], s.order[i + 1])) continue;
    meet[0] = s.order[i];
    meet[1] = s.order[i + 1];
    return false;
  }
  for (size_t i = 0; i < n; i++)
    if (!pass(&s, s.order[i])) return false;
  return true;
}
