#include "scene/scene.h"

#include <float.h>

/* The position of x relative to edge k from a to b: e = b - a, u = x - a.

     along = e.u        0 at a, e.e at b
     across = e x u     > 0: x to the left; |across|/|e| is the distance from the line */
typedef struct edge {
  ethd_vec a, e, u;
  double along, across, ee;
} edge;

typedef enum part { AT_START, BETWEEN, AT_END } part;

static inline ethd_vec point(const ethd__chain *chain, size_t k) { return ethd__chain_point(chain, k); }

static inline ethd_vec direction(const ethd__chain *chain, size_t k) {
  return ethd_vec_sub(point(chain, k + 1), point(chain, k));
}

static inline edge edge_of(const ethd__chain *chain, size_t k, ethd_vec x) {
  ethd_vec a = point(chain, k), e = direction(chain, k), u = ethd_vec_sub(x, a);
  edge r = {a, e, u, ethd_vec_dot(e, u), ethd_vec_cross(e, u), ethd_vec_dot(e, e)};
  return r;
}

static inline part part_of(const edge *g) { return g->along <= 0 ? AT_START : g->along >= g->ee ? AT_END : BETWEEN; }

/* Does the same, but a foot that equals a vertex within rounding counts as at the vertex, for both edges there. */
static part settled_part_of(const edge *g) {
  double e = fabs(g->e.x) + fabs(g->e.y), u = fabs(g->u.x) + fabs(g->u.y);
  double margin = 8 * DBL_EPSILON * e * (e + u);
  return g->along <= margin ? AT_START : g->along >= g->ee - margin ? AT_END : BETWEEN;
}

/* Finds the edge that ends at point k; returns false if the chain has none. */
static bool edge_before(const ethd__chain *chain, size_t k, size_t *out) {
  *out = k ? k - 1 : chain->edges - 1;
  return k || chain->closed;
}

/* Finds the edge that starts at point k; false: the chain has none. */
static bool edge_after(const ethd__chain *chain, size_t k, size_t *out) {
  *out = k < chain->edges ? k : 0;
  return k < chain->edges || chain->closed;
}

static ethd_vec unit(ethd_vec v) { return ethd_vec_scale(1 / ethd_vec_norm(v), v); }

static ethd_vec left_of(ethd_vec v) {
  ethd_vec r = {-v.y, v.x};
  return r;
}

/* ---- vertices ---- */

/* A vertex and the directions of its edges; at an end both are the direction of its one edge. */
typedef struct vertex {
  ethd_vec p, in, out;
  int turn;   /* of a sharp turn: +1 left, -1 right, 0 straight back */
  bool blunt; /* the turn is less than 90 degrees */
  bool end;
} vertex;

static vertex vertex_of(const ethd__chain *chain, size_t k) {
  size_t i, j;
  bool has_before = edge_before(chain, k, &i), has_after = edge_after(chain, k, &j);
  if (!has_before) i = j;
  if (!has_after) j = i;
  vertex v = {point(chain, k), direction(chain, i), direction(chain, j), 0, false, i == j};
  v.blunt = ethd_vec_dot(v.in, v.out) > 0;
  if (!v.blunt) v.turn = ethd__orient(point(chain, i), v.p, point(chain, j + 1));
  return v;
}

/* Returns the side of x, which this vertex is nearest to: +1 left, -1 right, 0 beyond an end or where the chain turns
   straight back. A vertex with a sharp turn is nearest only to points on its outer side. */
static int side_of(const vertex *v, ethd_vec x) {
  if (v->end) return 0;
  if (!v->blunt) return -v->turn;
  ethd_vec along = ethd_vec_add(unit(v->in), unit(v->out));
  return ethd_vec_cross(along, ethd_vec_sub(x, v->p)) >= 0 ? 1 : -1;
}

/* Returns the normal to the left for an x at the vertex itself. */
static ethd_vec left_normal(const vertex *v) {
  ethd_vec s = unit(v->in), t = unit(v->out);
  if (v->blunt || !v->turn) return unit(left_of(v->blunt ? ethd_vec_add(s, t) : t));
  return ethd_vec_scale(v->turn, unit(ethd_vec_sub(t, s)));
}

/* ---- touches ---- */

/* Returns n from a surface's left normal: into a polygon; for a thin wall away from x. */
static ethd_vec inward(const ethd__chain *chain, int side, ethd_vec left) {
  return ethd_vec_scale(chain->turn ? chain->turn : side > 0 ? -1 : 1, left);
}

static void touch_edge(const ethd__chain *chain, size_t k, const edge *g, ethd_touch *out) {
  double length = sqrt(g->ee);
  out->side = g->across >= 0 ? 1 : -1;
  out->distance = fabs(g->across) / length;
  out->point = ethd_vec_add(g->a, ethd_vec_scale(g->along / g->ee, g->e));
  out->n = inward(chain, out->side, ethd_vec_scale(1 / length, left_of(g->e)));
  out->feature = (int32_t)(2 * k);
}

/* Sets all fields except the side, which is the most expensive. */
static void meet_vertex(const ethd__chain *chain, size_t k, ethd_vec x, ethd_touch *out) {
  ethd_vec p = point(chain, k), gap = ethd_vec_sub(p, x);
  out->distance = ethd_vec_norm(gap);
  out->point = p;
  out->feature = (int32_t)(2 * (chain->closed && k == chain->edges ? 0 : k) + 1);
  if (out->distance > ETHD__TINY) {
    out->n = ethd_vec_scale(1 / out->distance, gap);
  } else {
    vertex v = vertex_of(chain, k);
    out->n = inward(chain, side_of(&v, x), left_normal(&v));
  }
}

static void touch_vertex(const ethd__chain *chain, size_t k, ethd_vec x, ethd_touch *out) {
  vertex v = vertex_of(chain, k);
  meet_vertex(chain, k, x, out);
  out->side = side_of(&v, x);
}

/* ---- the nearest ---- */

static double squared_distance(const ethd__chain *chain, size_t k, ethd_vec x) {
  edge g = edge_of(chain, k, x);
  part p = part_of(&g);
  if (p == BETWEEN) return g.across * g.across / g.ee;
  ethd_vec u = p == AT_START ? g.u : ethd_vec_sub(x, point(chain, k + 1));
  return ethd_vec_dot(u, u);
}

static bool touch_if_between(const ethd__chain *chain, size_t k, ethd_vec x, ethd_touch *out) {
  edge g = edge_of(chain, k, x);
  if (part_of(&g) != BETWEEN) return false;
  touch_edge(chain, k, &g, out);
  return true;
}

/* Finds the nearest point of edge k. If that is a vertex, the edge beyond it is tried too, since rounding may have
   hidden its foot. */
static void touch_nearest(const ethd__chain *chain, size_t k, ethd_vec x, ethd_touch *out) {
  edge g = edge_of(chain, k, x);
  part p = part_of(&g);
  out->side = 0;
  if (p == BETWEEN) {
    touch_edge(chain, k, &g, out);
    return;
  }
  size_t other;
  bool at_end = p == AT_END;
  bool beside = at_end ? edge_after(chain, k + 1, &other) : edge_before(chain, k, &other);
  if (beside && touch_if_between(chain, other, x, out)) return;
  meet_vertex(chain, at_end ? k + 1 : k, x, out);
}

bool ethd__edge_crossed(ethd_vec a, ethd_vec b, ethd_vec x) {
  if ((a.y > x.y) == (b.y > x.y)) return false;
  return (ethd__orient(a, b, x) > 0) == (b.y > a.y);
}

/* Returns true if x is inside, by the parity of the edges that a ray to the right crosses. */
static bool contains(const ethd__chain *chain, ethd_vec x) {
  bool inside = false;
  for (size_t k = 0; k < chain->edges; k++) inside ^= ethd__edge_crossed(point(chain, k), point(chain, k + 1), x);
  return inside;
}

/* Sets the signs of n and the distance by whether x is inside; at the call n is that of a point outside. Near a
   needle's tip, rounding may choose the edge whose other face is towards x. On the surface itself an edge's own normal
   stays. */
static void sign(const ethd__chain *chain, bool inside, ethd_touch *out) {
  bool at_vertex = out->feature % 2;
  bool turned = at_vertex ? inside && out->distance > ETHD__TINY
                          : inside != (out->side == chain->turn) && out->distance > chain->slack;
  if (turned) out->n = ethd_vec_scale(-1, out->n);
  if (inside) out->distance = -out->distance;
}

void ethd__chain_touch(const ethd__chain *chain, size_t k, ethd_vec x, bool inside, ethd_touch *out) {
  touch_nearest(chain, k, x, out);
  if (chain->turn) sign(chain, inside, out);
}

void ethd__chain_nearest(const ethd__chain *chain, ethd_vec x, ethd_touch *out) {
  size_t nearest = 0;
  double least = squared_distance(chain, 0, x);
  for (size_t k = 1; k < chain->edges; k++) {
    double d = squared_distance(chain, k, x);
    if (d < least) least = d, nearest = k;
  }
  ethd__chain_touch(chain, nearest, x, chain->turn && contains(chain, x), out);
}

/* ---- local minima ---- */

/* Returns the position of x along the edge before vertex k. The start of an open chain has no such edge; there x counts
   as past it. */
static part part_before(const ethd__chain *chain, size_t k, ethd_vec x) {
  size_t i;
  if (!edge_before(chain, k, &i)) return AT_END;
  edge g = edge_of(chain, i, x);
  return settled_part_of(&g);
}

static bool faces(const ethd__chain *chain, const ethd_touch *touch) {
  return !chain->turn || touch->side == -chain->turn;
}

bool ethd__chain_minimum_at(const ethd__chain *chain, size_t k, const ethd_vec *x, ethd_touch *out) {
  bool end = k == chain->edges;
  if (end && chain->closed) return false;
  edge g = edge_of(chain, end ? k - 1 : k, *x);
  part here = settled_part_of(&g);
  if (here == BETWEEN && !end)
    touch_edge(chain, k, &g, out);
  else if (end ? here == AT_END : here == AT_START && part_before(chain, k, *x) == AT_END)
    touch_vertex(chain, k, *x, out);
  else
    return false;
  return faces(chain, out);
}

size_t ethd__chain_minimum(const ethd__chain *chain, ethd_vec x, size_t from, ethd_touch *out) {
  for (size_t k = from; k <= chain->edges; k++)
    if (ethd__chain_minimum_at(chain, k, &x, out)) return k + 1;
  return 0;
}
