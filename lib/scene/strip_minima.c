#include "scene/strip.h"

#include <float.h>

/* Returns the bits of the boxes near the centre that may hold a minimum of the distance from x. Centre and x are one
   point unless they are `apart`. */
static unsigned open_lanes(const ethd__minima *m, uint32_t place) {
  const ethd__node *n = m->at_x.nodes + place;
  const float *slopes = m->slopes ? m->slopes + ETHD__WIDE * (size_t)place : NULL;
  if (!m->apart) return ethd__lanes_near(n, slopes, &m->at_x, m->bound);
  unsigned lanes = ethd__lanes_near(n, NULL, &m->at_centre, m->bound);
  return lanes && slopes ? lanes & ethd__lanes_near(n, slopes, &m->at_x, FLT_MAX) : lanes;
}

static void open_node(ethd__minima *m, uint32_t level, uint32_t index) {
  unsigned open = open_lanes(m, m->tree->first[level] + index);
  for (; open; open &= open - 1) {
    m->stack[m->count].level = level - 1;
    m->stack[m->count++].index = ETHD__WIDE * index + (uint32_t)__builtin_ctz(open);
  }
}

/* Starts with the root or, if it has two children, with both of them: choosing between them takes as long as opening
   both. */
static void push_top(ethd__minima *m) {
  uint32_t level = m->tree->levels, roots = 1;
  if (level > 1 && m->tree->first[level] - m->tree->first[level - 1] == 2) level--, roots = 2;
  for (uint32_t i = 0; i < roots; i++) {
    m->stack[m->count].level = level;
    m->stack[m->count++].index = i;
  }
}

void ethd__minima_start(ethd__minima *m, const ethd__strip *s, const ethd__probe *at_centre) {
  m->chain = ethd__chain_of(s->scene, s->object);
  m->tree = ethd__tree_at(s->scene, s->object);
  m->at_x = *s->probe;
  m->at_centre = *at_centre;
  m->x = s->x;
  m->apart = s->probe != at_centre;
  m->bound = ethd__bound(&m->at_centre, INFINITY);
  m->slopes = ethd__is_true_to(&m->at_x) ? ETHD__ARRAY(s->scene, float, slopes_at) : NULL;
  m->end = true;
  m->count = 0;
  push_top(m);
}

bool ethd__minima_next(ethd__minima *m, ethd_touch *out) {
  while (m->count) {
    m->count--;
    uint32_t level = m->stack[m->count].level, index = m->stack[m->count].index;
    if (level)
      open_node(m, level, index);
    else if (ethd__chain_minimum_at(&m->chain, index, &m->x, out))
      return true;
  }
  bool end = m->end;
  m->end = false;
  return end && ethd__chain_minimum_at(&m->chain, m->chain.edges, &m->x, out);
}
