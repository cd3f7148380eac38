/* What a controller was spared. */
#ifndef ETHD_APPS_DROPPED_H
#define ETHD_APPS_DROPPED_H

#include <stdio.h>

#include "ethd/scene.h"

/* ", 3 objects out of reach dropped", nothing if there are none; scene NULL: none. [main] */
void ethd__dropped_print(FILE *out, const ethd_scene *scene);

#endif
