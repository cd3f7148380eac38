#include <stdlib.h>

#include "error.h"
#include "fp_mode.h"
#include "scene/scene.h"

/* Collects the objects that stay, in the order of their ids; returns their number. */
static size_t gather(const ethd_scene *scene, double inner, double outer, ethd_object_def *defs, int32_t *ids) {
  const uint32_t *places = ETHD__ARRAY(scene, uint32_t, places_at);
  size_t n = 0;
  for (uint32_t i = 0; i < scene->object_count; i++) {
    if (!ethd__object_is_within(scene, ethd__object_at(scene, places[i]), inner, outer)) continue;
    ids[n] = ethd_scene_object(scene, i, &defs[n]);
    n++;
  }
  return n;
}

/* Takes over the slack, so that decisions which depend on rounding are those of the whole scene, and records the
   dropped objects. */
static void mark(const ethd_scene *whole, double inner, double outer, ethd_scene *scene) {
  scene->slack = whole->slack;
  scene->dropped = whole->dropped + (whole->object_count - scene->object_count);
  scene->inner = fmax(inner, whole->inner);
  scene->outer = fmin(outer, whole->outer);
}

ETHD__FP_APART static ethd_status prune(const ethd_scene *scene, const ethd_arm *arm, double radius, ethd_scene **out,
                                        ethd_error *error) {
  double inner, outer;
  ethd_status status = ETHD_OK;
  *out = NULL;
  ethd__scene_annulus(arm, radius, &inner, &outer);
  ethd_object_def *defs = malloc((scene->object_count + (size_t)1) * sizeof *defs);
  int32_t *ids = malloc((scene->object_count + (size_t)1) * sizeof *ids);
  if (!defs || !ids) {
    status = ethd__error(error, ETHD_E_MEMORY, "scene");
  } else {
    ethd_scene_def def = {defs, gather(scene, inner, outer, defs, ids), ethd_scene_material(scene, 0),
                          scene->material_count};
    if (def.object_count < scene->object_count) status = ethd__scene_make(&def, ids, out, error);
    if (*out) mark(scene, inner, outer, *out);
  }
  free(defs);
  free(ids);
  return status;
}

ethd_status ethd_scene_prune(const ethd_scene *scene, const ethd_arm *arm, double radius, ethd_scene **out,
                             ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, prune(scene, arm, radius, out, error));
}
