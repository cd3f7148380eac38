/* Loads the simulated device that the user names: a configuration, a plant. All [main]. */
#ifndef ETHD__APPS_TAP_LOAD_H
#define ETHD__APPS_TAP_LOAD_H

#include <stdbool.h>

#include "ethd/sim.h"

typedef struct ethd__loaded {
  ethd_config *config; /* with a scene: the paper's wall if it names none */
  char *path;          /* of the configuration */
  ethd_plant plant;
  char *plant_name, *plant_path;
} ethd__loaded;

/* Loads them. config: a file; NULL: the plant's own. plant: q, n, b or p, which came with the programs, or a file, with
   or without .plant; NULL: the one that the configuration's [device] names, else q. simulated: other devices are
   refused; else [device] is ignored. Exit 2 on bad input. */
void ethd__load(const char *config, const char *plant, bool simulated, bool plugins, ethd__loaded *out);

/* Replaces the configuration's scene by this one. Exit 2 on a bad one. */
void ethd__load_scene(ethd__loaded *loaded, const char *scene);

void ethd__loaded_free(ethd__loaded *loaded);

#endif
