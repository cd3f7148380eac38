#include "scene_strip.h"

#include <float.h>

/* Near the centre, and not leaning as seen from x, which is the centre unless they are `apart`. */
static unsigned open_lanes(const ethd__minima *m, uint32_t place) {
  ethd__eight near, facing;
  const ethd__node *n = m->at_x.nodes + place;
  const float *slopes = m->slopes ? m->slopes + ETHD__WIDE * (size_t)place : NULL;
  ethd__eight_squared(n, m->apart ? NULL : slopes, &m->at_centre, near.squared);
  unsigned lanes = ethd__lanes_within(near.squared, m->bound);
  if (!lanes || !slopes || !m->apart) return lanes;
  ethd__eight_squared(n, slopes, &m->at_x, facing.squared);
  return lanes & ethd__lanes_within(facing.squared, FLT_MAX);
}

static void open_node(ethd__minima *m, uint32_t level, uint32_t index) {
  unsigned open = open_lanes(m, m->tree->first[level] + index);
  for (; open; open &= open - 1) {
    m->stack[m->count].level = level - 1;
    m->stack[m->count++].index = ETHD__WIDE * index + (uint32_t)__builtin_ctz(open);
  }
}

void ethd__minima_start(ethd__minima *m, const ethd_scene *scene, const ethd__object *o, ethd_vec x,
                        const ethd__probe *at_x, const ethd__probe *at_centre) {
  m->chain = ethd__chain_of(scene, o);
  m->tree = ethd__tree_at(scene, o);
  m->at_x = *at_x;
  m->at_centre = *at_centre;
  m->x = x;
  m->apart = at_x != at_centre;
  m->bound = ethd__bound(&m->at_centre, INFINITY);
  m->slopes = ethd__is_true_to(&m->at_x) ? ETHD__ARRAY(scene, float, slopes_at) : NULL;
  m->end = true;
  m->count = 1;
  m->stack[0].level = m->tree->levels;
  m->stack[0].index = 0;
}

bool ethd__minima_next(ethd__minima *m, ethd_touch *out) {
  while (m->count) {
    m->count--;
    uint32_t level = m->stack[m->count].level, index = m->stack[m->count].index;
    if (level)
      open_node(m, level, index);
    else if (ethd__chain_minimum_at(&m->chain, index, m->x, out))
      return true;
  }
  bool end = m->end;
  m->end = false;
  return end && ethd__chain_minimum_at(&m->chain, m->chain.edges, m->x, out);
}
