/* Scenes are written in one form, and read again as they were. */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>

#include "settings/scene_file.h"
#include "unit/rig.h"

static char *print(const ethd_scene *scene) {
  char *text;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  ck_assert_int_eq(ethd_scene_print(scene, file), ETHD_OK);
  fclose(file);
  return text;
}

TEST(test_print) {
  ethd_scene *s = rig_scene(
      "material a k_e=1.5 b_e=0.1\nhalfplane 0.6 0.8 0.30000000000000004 material=a\ncircle 1 2 1e-7\n"
      "capsule 0 0 1 1 .5\nbox 1 2 3 4 0.5 material=b\npolygon 0 0 1 0 1 1\nsegment 0 0 1 1\nmaterial b\n"
      "polyline 0.1 0.2 0.30000000000000004 1 1 0 0.1 0.2\nhalfplane 0.70710678118654746 0.70710678118654757 1\n");
  char *text = print(s);
  ck_assert_str_eq(text, "material a k_e=1.5 b_e=0.1\nmaterial b\nhalfplane 0.6 0.8 0.30000000000000004 material=a\n"
                         "circle 1 2 1e-07\ncapsule 0 0 1 1 0.5\nbox 1 2 3 4 0.5 material=b\npolygon 0 0 1 0 1 1\n"
                         "segment 0 0 1 1\npolyline 0.1 0.2 0.30000000000000004 1 1 0 0.1 0.2\n"
                         "halfplane 0.7071067811865475 0.7071067811865476 1\n");
  ethd_scene *again = rig_scene(text);
  char *twin = print(again);
  ck_assert_str_eq(text, twin);
  free(text);
  free(twin);
  ethd_scene_destroy(s);
  ethd_scene_destroy(again);
}
