/* The trees of a query: boxes around everything in a scene, eight to a node, each rotated to fit its contents.

   The idea: a box is never farther from x than its contents. Once an object has been found at some distance, every box
   that is farther can be left out with its contents. So a walk goes down into the nearest box first, and the distance
   found there bounds the rest of the search.

     level 0   leaves: objects or, in the own tree of each chain of more than four edges, its edges
     level l   nodes, each with the boxes of eight items of the level below: node i has those from 8 i on

   Edges keep their chain's order; objects are ordered so that neighbours are near each other (order_build.c). Every
   node is full except the last of its level, so indices replace pointers: the ancestor of leaf k on level l is node k
   >> 3 l, and the box in it that holds the leaf is in lane (k >> 3 (l - 1)) % 8.

   Boxes are floats in the trees' frame, in which all bounded objects lie within [-1, 1]. They are larger than their
   contents, by more than the rounding errors of floats:

     17 2^-24   X is rounded, c X + s Y, - u, - w: each rounding at most 2^-24 of its result, |X|, |Y| <= 2
     2^-22      of the distance: (c, s) isn't exactly of unit length, squares and their sum are rounded
     2^-18      of the distance: all of these errors, if X is farther away
   ETHD__INFLATE exceeds the first error; bounds are stretched by more than the others. */
#ifndef ETHD__SCENE_TREE_H
#define ETHD__SCENE_TREE_H

#include "scene/lanes.h"
#include "scene/scene.h"

#define ETHD__WIDE 8
#define ETHD__FLAT 4 /* the most edges of a chain without a tree: they are tested one by one */
#define ETHD__INFLATE 0x1.8p-20f
#define ETHD__STRETCH_NEAR (1 + 0x1p-20)
#define ETHD__STRETCH_FAR (1 + 0x1p-16)
#define ETHD__NONE UINT32_MAX

/* Lane j is the box |c X + s Y - u| <= w, |c Y - s X - v| <= h. An empty lane has u = inf. */
typedef struct ethd__node {
  _Alignas(64) float c[ETHD__WIDE];
  float s[ETHD__WIDE], u[ETHD__WIDE], v[ETHD__WIDE], w[ETHD__WIDE], h[ETHD__WIDE];
} ethd__node;

/* Sets up a tree with this many leaves whose nodes start at `first`, level 1 before level 2. */
static inline void ethd__tree_set(ethd__tree *t, uint32_t leaves, uint32_t first) {
  t->leaves = leaves;
  t->levels = 0;
  for (uint32_t n = leaves; n > 1;) {
    n = (n + ETHD__WIDE - 1) / ETHD__WIDE;
    t->first[++t->levels] = first;
    first += n;
  }
}

static inline uint32_t ethd__node_count(uint32_t leaves) {
  uint32_t count = 0;
  for (uint32_t n = leaves; n > 1;) count += n = (n + ETHD__WIDE - 1) / ETHD__WIDE;
  return count;
}

/* Returns true if a chain has a tree of its own. */
static inline bool ethd__has_tree(const ethd__object *o) { return o->edges > ETHD__FLAT; }

static inline const ethd__tree *ethd__tree_at(const ethd_scene *scene, const ethd__object *o) {
  return ETHD__ARRAY(scene, ethd__tree, trees_at) + o->tree;
}

/* ---- a point in the trees' frame ---- */

typedef struct ethd__probe {
  const ethd__node *nodes;
  double squares; /* factor from m2 to bounds of squared distances, stretched */
  float x, y;     /* rounded */
} ethd__probe;

/* Returns v, clamped to [-most, most]. */
static inline double ethd__within(double v, double most) { return v > most ? most : v < -most ? -most : v; }

#define ETHD__FAR 0x1p50 /* exact as a float, so that a clamped coordinate is recognised */

/* Makes the probe of x. Beyond ETHD__FAR the nearest point of that square replaces x: no box is farther from it than
   from x. */
static inline ethd__probe ethd__probe_at(const ethd_scene *scene, ethd_vec x) {
  double s = scene->scale, u = s * (x.x - scene->centre.x), v = s * (x.y - scene->centre.y);
  bool near = fabs(u) <= 2 && fabs(v) <= 2;
  ethd__probe p = {ETHD__ARRAY(scene, ethd__node, nodes_at), s * s * (near ? ETHD__STRETCH_NEAR : ETHD__STRETCH_FAR),
                   (float)ethd__within(u, ETHD__FAR), (float)ethd__within(v, ETHD__FAR)};
  return p;
}

/* Returns false if another point replaces x. */
static inline bool ethd__is_true_to(const ethd__probe *p) {
  return fabs((double)p->x) < ETHD__FAR && fabs((double)p->y) < ETHD__FAR;
}

/* Converts a squared distance, m2, into a bound for comparisons with boxes. */
static inline float ethd__bound(const ethd__probe *p, double squared) {
  double b = squared * p->squares;
  return (float)(b < 1e37 ? b : 1e37);
}

/* ---- boxes ---- */

/* Returns the squared distances of four lanes from `i` on.

   `slopes` (NULL: not used) holds for each box of a chain the steepest slope of its edges against the box's axis. If x
   lies far enough beyond the box's end, the distance falls along all of its edges towards that end, whatever their
   slopes. Then neither an edge nor a vertex between two edges of the box is a minimum, and the lane's distance becomes
   inf (Johnson and Cohen 2001). */
ETHD__INLINE ethd__floats ethd__four_squared(const ethd__node *n, const float *slopes, int i, ethd__floats x,
                                             ethd__floats y) {
  ethd__floats c = ethd__load(n->c + i), s = ethd__load(n->s + i), zero = ethd__all(0);
  ethd__floats w = ethd__load(n->w + i), h = ethd__load(n->h + i);
  ethd__floats u = ethd__abs(c * x + s * y - ethd__load(n->u + i));
  ethd__floats v = ethd__abs(c * y - s * x - ethd__load(n->v + i));
  ethd__floats du = ethd__max(u - w, zero), dv = ethd__max(v - h, zero), d = du * du + dv * dv;
  if (!slopes) return d;
  ethd__ints leaning = du > ethd__load(slopes + i) * (v + h);
  return ethd__max(d, (ethd__floats)(leaning & (ethd__ints)ethd__all(INFINITY)));
}

ETHD__INLINE void ethd__eight_squared(const ethd__node *n, const float *slopes, const ethd__probe *p,
                                      float squared[ETHD__WIDE]) {
  ethd__floats x = ethd__all(p->x), y = ethd__all(p->y);
  ethd__floats low = ethd__four_squared(n, slopes, 0, x, y), high = ethd__four_squared(n, slopes, 4, x, y);
  ethd__store(squared, low);
  ethd__store(squared + 4, high);
}

/* Returns the bits of the lanes within the bound, when their distances aren't needed. */
ETHD__INLINE unsigned ethd__lanes_near(const ethd__node *n, const float *slopes, const ethd__probe *p, float bound) {
  ethd__floats x = ethd__all(p->x), y = ethd__all(p->y), most = ethd__all(bound);
  ethd__floats low, high;
  if (slopes)
    low = ethd__four_squared(n, slopes, 0, x, y), high = ethd__four_squared(n, slopes, 4, x, y);
  else
    low = ethd__four_squared(n, NULL, 0, x, y), high = ethd__four_squared(n, NULL, 4, x, y);
  return ethd__bits(low <= most) | ethd__bits(high <= most) << 4;
}

/* Returns the bits of the lanes within the bound. */
ETHD__INLINE unsigned ethd__lanes_within(const float squared[ETHD__WIDE], float bound) {
  ethd__floats most = ethd__all(bound);
  return ethd__bits(ethd__load(squared) <= most) | ethd__bits(ethd__load(squared + 4) <= most) << 4;
}

/* Returns the nearest lane, the first if several are equally near. */
ETHD__INLINE uint32_t ethd__nearest_lane(const float squared[ETHD__WIDE]) {
  ethd__floats low = ethd__load(squared), high = ethd__load(squared + 4), m = ethd__least(ethd__min(low, high));
  unsigned lanes = ethd__bits(low == m) | ethd__bits(high == m) << 4;
  return lanes ? (uint32_t)__builtin_ctz(lanes) : 0; /* unreachable: the least of eight numbers is one of them */
}

/* ---- a walk: the leaves within a bound that its user may lower ---- */

/* A node, or a leaf on level 0, and its box's squared distance. */
typedef struct ethd__scene_place {
  float squared;
  uint32_t level, index;
} ethd__scene_place;

typedef struct ethd__eight {
  _Alignas(16) float squared[ETHD__WIDE];
} ethd__eight;

/* Unopened boxes are on a stack, the nearest box of each node on top. The leaves of one node of level 1, the current
   node, are kept as bits instead, since most walks never need the stack.

   The caller examines one leaf itself, which gives a bound. It finds this leaf by one of two methods:

     walk_around   The caller knows a leaf, perhaps from the last query. The nodes above it follow from its index, so
                   all levels can be read at once; on each, the boxes beside the path to the leaf are kept.
     walk_down     The caller knows none. On each level the nearest box is chosen, and its node's eight distances are
                   stored.
     walk_on       After the leaf found there has given a bound, the boxes beside that path are kept.

   After that, walk_next gives the other leaves one by one. */
typedef struct ethd__walk {
  const ethd__tree *tree;
  const ethd__probe *probe;
  const float *slopes;
  float bound;                  /* of squared distances; may be lowered between two leaves */
  int count;                    /* of the stack */
  unsigned lanes;               /* bits of the current node's leaves that walk_next hasn't given yet */
  uint32_t leaf;                /* the first leaf of that node */
  ethd__eight at[ETHD__LEVELS]; /* distances: [1] of the current node; after walk_down, of a node on each level */
  ethd__scene_place stack[(ETHD__WIDE - 1) * ETHD__LEVELS + 1];
} ethd__walk;

/* Gives the squared distances of a node's eight boxes. */
ETHD__INLINE void ethd__look(ethd__walk *w, uint32_t level, uint32_t index, float squared[ETHD__WIDE]) {
  uint32_t n = w->tree->first[level] + index;
  ethd__eight_squared(w->probe->nodes + n, w->slopes ? w->slopes + ETHD__WIDE * (size_t)n : NULL, w->probe, squared);
}

/* Pushes these lanes of a node on the stack, nearer ones on top. */
static inline void ethd__push(ethd__walk *w, const float squared[ETHD__WIDE], unsigned lanes, uint32_t level,
                              uint32_t index) {
  int start = w->count;
  for (; lanes; lanes &= lanes - 1) {
    uint32_t lane = (uint32_t)__builtin_ctz(lanes);
    int i = w->count++;
    for (; i > start && w->stack[i - 1].squared < squared[lane]; i--) w->stack[i] = w->stack[i - 1];
    w->stack[i] = (ethd__scene_place){squared[lane], level - 1, ETHD__WIDE * index + lane};
  }
}

static inline void ethd__walk_start(ethd__walk *w, const ethd__tree *tree, const ethd__probe *p, const float *slopes) {
  w->tree = tree;
  w->probe = p;
  w->slopes = slopes;
  w->count = 0;
  w->lanes = 0;
}

/* Keeps the lanes of node `index` within the bound, except the one on the path. */
ETHD__INLINE void ethd__walk_beside(ethd__walk *w, const float squared[ETHD__WIDE], uint32_t level, uint32_t index,
                                    uint32_t but) {
  unsigned lanes = ethd__lanes_within(squared, w->bound) & ~(1u << but % ETHD__WIDE);
  if (level > 1) {
    ethd__push(w, squared, lanes, level, index);
  } else {
    w->lanes = lanes;
    w->leaf = ETHD__WIDE * index;
  }
}

/* Keeps the boxes beside the path to leaf `taken`, level by level; no load waits for another. */
static inline void ethd__walk_around(ethd__walk *w, uint32_t taken, float bound) {
  w->bound = bound;
  for (uint32_t level = w->tree->levels; level > 0; level--) {
    ethd__look(w, level, taken >> 3 * level, w->at[1].squared);
    ethd__walk_beside(w, w->at[1].squared, level, taken >> 3 * level, taken >> 3 * (level - 1));
  }
}

/* Returns the leaf on the path of the nearest boxes. The tree isn't empty. */
static inline uint32_t ethd__walk_down(ethd__walk *w) {
  uint32_t index = 0;
  for (uint32_t level = w->tree->levels; level > 0; level--) {
    ethd__look(w, level, index, w->at[level].squared);
    index = ETHD__WIDE * index + ethd__nearest_lane(w->at[level].squared);
  }
  return index;
}

/* Keeps the boxes beside the path that walk_down took. */
static inline void ethd__walk_on(ethd__walk *w, uint32_t found, float bound) {
  w->bound = bound;
  for (uint32_t level = w->tree->levels; level > 0; level--)
    ethd__walk_beside(w, w->at[level].squared, level, found >> 3 * level, found >> 3 * (level - 1));
}

/* Returns the next leaf within the bound; its index is ETHD__NONE when there are no more. */
static inline ethd__scene_place ethd__walk_next(ethd__walk *w) {
  for (;;) {
    if (w->lanes) w->lanes &= ethd__lanes_within(w->at[1].squared, w->bound);
    if (w->lanes) {
      uint32_t lane = (uint32_t)__builtin_ctz(w->lanes);
      for (unsigned rest = w->lanes & (w->lanes - 1); rest; rest &= rest - 1) {
        uint32_t other = (uint32_t)__builtin_ctz(rest);
        if (w->at[1].squared[other] < w->at[1].squared[lane]) lane = other;
      }
      w->lanes ^= 1u << lane;
      return (ethd__scene_place){w->at[1].squared[lane], 0, w->leaf + lane};
    }
    if (!w->count) return (ethd__scene_place){0, 0, ETHD__NONE};
    ethd__scene_place at = w->stack[--w->count];
    if (!(at.squared <= w->bound)) continue;
    if (at.level == 1) {
      ethd__look(w, 1, at.index, w->at[1].squared);
      w->lanes = ethd__lanes_within(w->at[1].squared, w->bound);
      w->leaf = ETHD__WIDE * at.index;
    } else {
      ethd__eight e;
      ethd__look(w, at.level, at.index, e.squared);
      ethd__push(w, e.squared, ethd__lanes_within(e.squared, w->bound), at.level, at.index);
    }
  }
}

/* ---- one edge ---- */

/* The position of x beside an edge e that starts at a, u = x - a; computed without a branch. */
typedef struct ethd__beside {
  double squared;       /* of the distance, m2 */
  double across, doubt; /* e x u, and the bound on its error */
} ethd__beside;

static inline ethd__beside ethd__beside_edge(ethd_vec a, ethd_vec b, ethd_vec x) {
  ethd_vec e = ethd_vec_sub(b, a), u = ethd_vec_sub(x, a);
  double t = ethd_vec_dot(e, u) / ethd_vec_dot(e, e), l = e.x * u.y, r = e.y * u.x;
  t = t > 0 ? t : 0;
  t = t < 1 ? t : 1;
  ethd_vec g = ethd_vec_sub(u, ethd_vec_scale(t, e));
  ethd__beside s = {ethd_vec_dot(g, g), l - r, 4e-16 * (fabs(l) + fabs(r))};
  return s;
}

#endif
