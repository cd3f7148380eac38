/* Building a scene's tree. [main] */
#ifndef ETHD__SCENE_BUILD_H
#define ETHD__SCENE_BUILD_H

#include "scene/tree.h"

/* An object that has no place among the leaves yet. */
typedef struct ethd__item {
  uint32_t at[2]; /* middle of its bounds: 0 to UINT32_MAX across the scene's extent in x and y */
  uint32_t id;    /* its index in the definition */
} ethd__item;

/* Orders items so that every node of a tree over them holds neighbours. */
void ethd__order_build(ethd__item *items, uint32_t count);

/* Discs in the trees' frame, by centre and radius; radii NULL: all radii are 0. */
typedef struct ethd__cloud {
  const ethd_vec *points;
  const double *radii;
} ethd__cloud;

/* Makes lane `lane` a small box around the discs [from, to). */
void ethd__box_fit(const ethd__cloud *cloud, size_t from, size_t to, ethd__node *node, size_t lane);

/* Marks a lane as empty. */
void ethd__box_clear(ethd__node *node, size_t lane);

/* Builds the nodes and slopes of an otherwise complete scene. `room`: ethd__nodes_room bytes, aligned as by malloc. */
size_t ethd__nodes_room(const ethd_scene *scene);
void ethd__nodes_build(ethd_scene *scene, void *room);

#endif
