#include "file/scene_file.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static void print_number(FILE *out, const char *before, double v) {
  char text[40];
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, v);
    if (strtod(text, NULL) == v) break;
  }
  fputs(before, out);
  fputs(text, out);
}

static bool is_word(const char *name) {
  for (const char *p = name; *p; p++)
    if (!isalnum((unsigned char)*p) && !strchr("_-.", *p)) return false;
  return true;
}

static bool print_material(const ethd_material *m, FILE *out) {
  bool good = is_word(m->name);
  fprintf(out, "material %s", m->name);
  for (uint32_t i = 0; i < m->count; i++) {
    good &= is_word(m->values[i].name);
    fprintf(out, " %s", m->values[i].name);
    print_number(out, "=", m->values[i].value);
  }
  fputc('\n', out);
  return good;
}

ethd_status ethd_scene_print(const ethd_scene *scene, FILE *out) {
  const ethd_material *m;
  ethd_object_def o;
  bool good = true;
  for (size_t i = 0; (m = ethd_scene_material(scene, i)) != NULL; i++) good &= print_material(m, out);
  for (size_t i = 0; ethd_scene_object(scene, i, &o) >= 0; i++) {
    fputs(ethd_shape_name(o.shape), out);
    for (size_t k = 0; k < o.count; k++) print_number(out, " ", o.numbers[k]);
    if (o.material >= 0) fprintf(out, " material=%s", ethd_scene_material(scene, (size_t)o.material)->name);
    fputc('\n', out);
  }
  return good ? ETHD_OK : ETHD_E_ARGUMENT;
}
