/* Building a scene's tree. [main] */
#ifndef ETHD_LIB_SCENE_BUILD_H
#define ETHD_LIB_SCENE_BUILD_H

#include "scene/tree.h"

/* An object before it has its place. */
typedef struct ethd__item {
  uint32_t at[2]; /* the middle of its bounds, in the scene's from 0 to UINT32_MAX */
  uint32_t id;
} ethd__item;

/* Puts items into an order in which every node of a tree over them holds neighbours. */
void ethd__order_build(ethd__item *items, uint32_t count);

/* Discs about points, in the trees' frame; radii NULL: points. */
typedef struct ethd__cloud {
  const ethd_vec *points;
  const double *radii;
} ethd__cloud;

/* Lane `lane`: a small box around all discs from `from` on, before `to`. */
void ethd__box_fit(const ethd__cloud *cloud, size_t from, size_t to, ethd__node *node, size_t lane);

/* Nothing in this lane. */
void ethd__box_clear(ethd__node *node, size_t lane);

/* Nodes and slopes of a scene that has all else; both ask that. `room`: nodes_room bytes, aligned like
   malloc's. */
size_t ethd__nodes_room(const ethd_scene *scene);
void ethd__nodes_build(ethd_scene *scene, void *room);

#endif
