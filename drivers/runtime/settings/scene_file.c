#include "settings/scene_file.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"

#define REFERENCE "material="

static bool ends_in(const char *text, const char *end) {
  size_t n = strlen(text), m = strlen(end);
  return n > m && !strcmp(text + n - m, end) && text[n - m - 1] == ' ';
}

/* Says what a line with the wrong count of numbers should be; the error's name ends in the shape's name. */
static void say_form(const ethd_error *error, const char *plain, char message[ETHD_MESSAGE_MAX]) {
  const char *form = "", *name = "SHAPE NUMBERS [material=NAME] or material NAME [KEY=NUMBER...]";
  for (int i = 0; i < ETHD_SHAPE_COUNT && isfinite(error->found); i++)
    if (ends_in(error->name, ethd_shape_name((ethd_shape)i)))
      name = ethd_shape_name((ethd_shape)i), form = ethd_shape_form((ethd_shape)i);
  ethd__say(message, error->status, "%s; %s%s%s is allowed", plain, name, *form ? " " : "", form);
}

static bool is_called(const char *path, const char *end) {
  size_t n = strlen(path), m = strlen(end);
  return n > m && !strcasecmp(path + n - m, end);
}

/* Says what to do with a drawing in the place of a scene; false: it is none. */
static bool say_drawing(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]) {
  if (!is_called(path, ".dxf") && !is_called(path, ".svg") && error->name[0] != '<') return false;
  ethd__say(message, error->status,
            "%.200s: is a drawing, not a scene: ethd-scene convert --in DRAWING.svg --out NAME.scene makes one of it",
            path);
  return true;
}

void ethd__scene_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]) {
  char shapes[160] = "", plain[ETHD_MESSAGE_MAX];
  if (say_drawing(path, error, message)) return;
  ethd_error_text(path, error, plain);
  for (int i = 0; i < ETHD_SHAPE_COUNT; i++) {
    strcat(shapes, ethd_shape_name((ethd_shape)i));
    strcat(shapes, ", ");
  }
  if (error->status == ETHD_E_UNKNOWN && !strncmp(error->name, REFERENCE, strlen(REFERENCE)))
    ethd__say(message, error->status, "%s; a line \"material %.*s k_e=2500\" defines it", plain,
              (int)(sizeof error->name - strlen(REFERENCE)), error->name + strlen(REFERENCE));
  else if (error->status == ETHD_E_UNKNOWN)
    ethd__say(message, error->status, "%s; %smaterial are allowed", plain, shapes);
  else if (error->status == ETHD_E_SYNTAX)
    say_form(error, plain, message);
  else
    ethd__say(message, error->status, "%s", plain);
}

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
