/* Prints the contents of a scene. */
#include <stdio.h>

#include "cli/cli.h"
#include "scene/scene.h"
#include "scene/thin.h"
#include "text/text.h"

static ethd_setup setup_of(const char *path) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  if (!path) return ethd_setup_default();
  ethd__need(ethd_config_load(path, &config, message), message);
  ethd__need_plane(config);
  ethd_setup setup = config->setup;
  setup.scene = NULL;
  ethd_config_free(config);
  return setup;
}

static void say_counts(const char *name, const ethd_scene_info *info) {
  printf("%s: %zu object%s\n", name, info->objects, ethd__s(info->objects));
  for (int shape = 0; shape < ETHD_SHAPE_COUNT; shape++)
    if (info->by_shape[shape]) printf("  %-10s %zu\n", ethd_shape_name((ethd_shape)shape), info->by_shape[shape]);
  printf("segments:     %zu (edges of polygons, polylines and segments)\n", info->segments);
  printf("materials:    %zu\n", info->materials);
  if (info->x_min <= info->x_max)
    printf("extent:       x %.9g to %.9g m, y %.9g to %.9g m%s\n", info->x_min, info->x_max, info->y_min, info->y_max,
           info->by_shape[ETHD_SHAPE_HALFPLANE] ? ", and half-planes" : "");
  else
    printf("extent:       %s\n", info->by_shape[ETHD_SHAPE_HALFPLANE] ? "half-planes only" : "none");
}

static int solids_info(const ethd__scene_args *arg, const ethd_solids *solids, double seconds) {
  ethd_solids_info info;
  if (arg->plot || arg->config)
    ethd__fail(ETHD_EXIT_INPUT, "%s: holds solids; --plot and --config are for scenes of the plane", arg->scene);
  ethd_solids_describe(solids, &info);
  printf("%s: %zu solid%s\n", arg->scene, info.objects, ethd__s(info.objects));
  printf("materials:    %zu\n", info.materials);
  if (info.min.x <= info.max.x)
    printf("extent:       x %.9g to %.9g m, y %.9g to %.9g m, z %.9g to %.9g m, without half-spaces\n", info.min.x,
           info.max.x, info.min.y, info.max.y, info.min.z, info.max.z);
  else
    printf("extent:       %s\n", info.objects ? "half-spaces only" : "none");
  printf("build time:   %.3g ms (read and built)\n", 1e3 * seconds);
  printf("memory:       %zu bytes\n", info.bytes);
  return ETHD_EXIT_DONE;
}

int ethd__scene_info(const ethd__scene_args *arg) {
  double seconds;
  ethd_solids *solids;
  ethd_scene *scene = ethd__world_load(arg->scene, &solids, &seconds);
  if (solids) {
    const int code = solids_info(arg, solids, seconds);
    ethd_solids_destroy(solids);
    return code;
  }
  ethd_scene_info info;
  ethd_setup setup = setup_of(arg->config);
  ethd_scene_describe(scene, &info);
  say_counts(arg->scene, &info);
  printf("build time:   %.3g ms (read and built)\n", 1e3 * seconds);
  printf("memory:       %zu bytes\n", info.bytes);
  printf("out of reach: %zu of %zu object%s, which a controller drops (%s arm %g + %g m, ring %g m)\n",
         ethd_scene_out_of_reach(scene, &setup.arm, ethd_setup_range(&setup)), info.objects, ethd__s(info.objects),
         ethd_arm_name(setup.arm.mechanism), setup.arm.link1, setup.arm.link2, setup.ring_radius);
  ethd__scene_say_thin(scene, "thin:         ");
  int code = arg->plot ? ethd__scene_plot(arg, scene, &setup) : ETHD_EXIT_DONE;
  ethd_scene_destroy(scene);
  return code;
}
