/* Solids into which a ring may be pressed beyond their middle. */
#ifndef ETHD__APPS_SCENE_THIN_H
#define ETHD__APPS_SCENE_THIN_H

#include "ethd/scene.h"

/* Prints a line, after `before`, if solids of the scene are so thin that a pressed ring passes their middle,
   where the force reverses. [main] */
void ethd__scene_say_thin(const ethd_scene *scene, const char *before);

#endif
