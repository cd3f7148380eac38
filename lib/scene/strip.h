/* Chains through their trees. */
#ifndef ETHD_LIB_SCENE_STRIP_H
#define ETHD_LIB_SCENE_STRIP_H

#include "scene/tree.h"

/* The edge of a chain nearest to x, among those within the root of `limit` (m2); ETHD__NONE: there is
   none. `first`: an edge to start from, ETHD__NONE: any. */
typedef struct ethd__nearest_edge {
  double squared;
  uint32_t edge;
  bool inside; /* of a polygon, if that was asked: x is */
} ethd__nearest_edge;

void ethd__strip_nearest(const ethd_scene *scene, const ethd__object *o, const ethd__probe *p, ethd_vec x,
                         uint32_t first, double limit, ethd__nearest_edge *out) ETHD_RT;

/* The same of a polygon, however far, and whether x is inside. */
void ethd__strip_signed(const ethd_scene *scene, const ethd__object *o, const ethd__probe *p, ethd_vec x,
                        uint32_t first, ethd__nearest_edge *out) ETHD_RT;

/* The local minima of the distance from x to such a chain whose points lie within `bound` of `centre`, in
   no order. Boxes are left out whose edges all lean one way as seen from x (Johnson and Cohen 2001). */
typedef struct ethd__minima {
  ethd__chain chain;
  const ethd__tree *tree;
  ethd__probe at_x, at_centre;
  ethd_vec x;
  float bound; /* see ethd__bound */
  const float *slopes;
  bool apart; /* x and the centre */
  bool end;   /* of an open chain is still to come */
  int count;
  struct {
    uint32_t level, index;
  } stack[(ETHD__WIDE - 1) * ETHD__LEVELS + 1];
} ethd__minima;

/* The probes: of x and of the centre. */
void ethd__minima_start(ethd__minima *m, const ethd_scene *scene, const ethd__object *o, ethd_vec x,
                        const ethd__probe *at_x, const ethd__probe *at_centre) ETHD_RT;
bool ethd__minima_next(ethd__minima *m, ethd_touch *out) ETHD_RT;

#endif
