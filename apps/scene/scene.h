/* The commands of ethd-scene; each returns an exit code. */
#ifndef ETHD__APPS_SCENE_SCENE_H
#define ETHD__APPS_SCENE_SCENE_H

#include <stdbool.h>

#include "ethd/config.h"

enum { ETHD__DRAWING_OPTIONS = 16 };

typedef struct ethd__scene_args {
  const char *command, *scene, *in, *out, *config;
  const char *plot;                     /* ends in .png */
  char *drawing[ETHD__DRAWING_OPTIONS]; /* the options of convert, as --name=value */
  size_t drawing_count;
  bool for_drawings; /* an option for drawings alone is among them */
} ethd__scene_args;

/* Loads a scene file and measures the time of reading and building; exits on failure. */
ethd_scene *ethd__scene_load(const char *path, double *seconds);

/* The same for a scene or solids; for solids it returns NULL. */
ethd_scene *ethd__world_load(const char *path, ethd_solids **solids, double *seconds);

int ethd__scene_query(const ethd__scene_args *arg);
int ethd__scene_info(const ethd__scene_args *arg);
int ethd__scene_convert(const ethd__scene_args *arg);

/* Draws a scene, its trees and the arm's reach into arg->plot, by a CSV of the same name beside it. */
int ethd__scene_plot(const ethd__scene_args *arg, const ethd_scene *scene, const ethd_setup *setup);

#endif
