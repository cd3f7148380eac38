/* The commands of ethd-scene; each returns an exit code. */
#ifndef ETHD_APPS_SCENE_H
#define ETHD_APPS_SCENE_H

#include <stdbool.h>

#include "ethd/config.h"
#include "svg/svg.h"

typedef struct ethd__scene_args {
  const char *command, *scene, *in, *out, *config;
  const char *plot; /* ends in .png */
  ethd_svg_options svg;
  bool svg_given; /* one of its options was */
} ethd__scene_args;

/* A scene file, and how long reading and building took; exits when there is none. */
ethd_scene *ethd__scene_load(const char *path, double *seconds);

int ethd__scene_query(const ethd__scene_args *arg);
int ethd__scene_info(const ethd__scene_args *arg);
int ethd__scene_convert(const ethd__scene_args *arg);

/* Draws a scene, its trees and the arm's reach into arg->plot, from the CSV of that name that it leaves. */
int ethd__scene_plot(const ethd__scene_args *arg, const ethd_scene *scene, const ethd_setup *setup);

#endif
