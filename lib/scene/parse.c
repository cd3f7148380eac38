#include <stdlib.h>

#include "fp_mode.h"
#include "scene/scene.h"
#include "scene/text.h"

static ethd_status read_objects(ethd__text *t, ethd_object_def *objects, size_t *count) {
  ethd__written o;
  ethd_status status;
  while ((status = ethd__text_next(t, &o)) == ETHD_OK)
    objects[(*count)++] = (ethd_object_def){(ethd_shape)o.shape, o.material, o.numbers, o.count, o.line};
  return status == ETHD_STATUS_EMPTY ? ETHD_OK : status;
}

static ethd_status read_all(ethd__text *t, ethd_scene **out, ethd_error *error) {
  ethd_object_def *objects = malloc((ethd__text_lines(t) + 1) * sizeof *objects);
  if (!objects) return ethd__error(error, ETHD_E_MEMORY, "scene");
  ethd_scene_def def = {.objects = objects};
  def.materials = ethd__text_materials(t, &def.material_count);
  ethd_status status = read_objects(t, objects, &def.object_count);
  if (!status) status = ethd_scene_create(&def, out, error);
  free(objects);
  return status;
}

ETHD__FP_APART static ethd_status parse(const char *text, size_t length, ethd_scene **out, ethd_error *error) {
  ethd__text *t;
  *out = NULL;
  ethd_status status = ethd__text_open(text, length, &ethd__plane, &t, error);
  if (!status) status = read_all(t, out, error);
  ethd__text_close(t);
  return status;
}

ethd_status ethd_scene_parse(const char *text, size_t length, ethd_scene **out, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, parse(text, length, out, error));
}
