#include "cli/dropped.h"

void ethd__dropped_print(FILE *out, const ethd_scene *scene) {
  ethd_scene_info info;
  if (!scene) return;
  ethd_scene_describe(scene, &info);
  if (info.dropped) fprintf(out, ", %zu object%s out of reach dropped", info.dropped, info.dropped == 1 ? "" : "s");
}
