/* Says what was dropped from a scene. */
#ifndef ETHD__APPS_CLI_DROPPED_H
#define ETHD__APPS_CLI_DROPPED_H

#include <stdio.h>

#include "ethd/scene.h"

/* Prints ", 3 objects out of reach dropped", or nothing if there are none or scene is NULL. [main] */
void ethd__dropped_print(FILE *out, const ethd_scene *scene);

#endif
