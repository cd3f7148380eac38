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

/* A world's shapes, as its text writes them. */
typedef struct shape_words {
  const char *names[8], *forms[8]; /* NULL ends the names */
} shape_words;

/* Gives the right form of a line with a wrong count of numbers; the error's name ends in the shape's name. */
static void say_form(const shape_words *w, const ethd_error *error, const char *plain, char message[ETHD_MESSAGE_MAX]) {
  const char *form = "", *name = "SHAPE NUMBERS [material=NAME] or material NAME [KEY=NUMBER...]";
  for (int i = 0; w->names[i] && isfinite(error->found); i++)
    if (ends_in(error->name, w->names[i])) name = w->names[i], form = w->forms[i];
  ethd__say(message, error->status, "%s; %s%s%s is allowed", plain, name, *form ? " " : "", form);
}

static bool is_called(const char *path, const char *end) {
  size_t n = strlen(path), m = strlen(end);
  return n > m && !strcasecmp(path + n - m, end);
}

/* Gives the remedy for a drawing instead of a scene; false: it is no drawing. */
static bool say_drawing(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]) {
  if (!is_called(path, ".dxf") && !is_called(path, ".svg") && error->name[0] != '<') return false;
  ethd__say(message, error->status,
            "%.200s: is a drawing, not a scene: ethd-scene convert --in DRAWING.svg --out NAME.scene makes one of it",
            path);
  return true;
}

static void refusal(const shape_words *w, const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]) {
  char shapes[160] = "", plain[ETHD_MESSAGE_MAX];
  ethd_error_text(path, error, plain);
  for (int i = 0; w->names[i]; i++) {
    strcat(shapes, w->names[i]);
    strcat(shapes, ", ");
  }
  if (error->status == ETHD_E_UNKNOWN && !strncmp(error->name, REFERENCE, strlen(REFERENCE)))
    ethd__say(message, error->status, "%s; a line \"material %.*s k_e=2500\" defines it", plain,
              (int)(sizeof error->name - strlen(REFERENCE)), error->name + strlen(REFERENCE));
  else if (error->status == ETHD_E_UNKNOWN)
    ethd__say(message, error->status, "%s; %smaterial are allowed", plain, shapes);
  else if (error->status == ETHD_E_SYNTAX)
    say_form(w, error, plain, message);
  else
    ethd__say(message, error->status, "%s", plain);
}

void ethd__scene_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]) {
  shape_words w = {{NULL}, {NULL}};
  _Static_assert(ETHD_SHAPE_COUNT < sizeof w.names / sizeof *w.names, "the shapes have room");
  if (say_drawing(path, error, message)) return;
  for (int i = 0; i < ETHD_SHAPE_COUNT; i++)
    w.names[i] = ethd_shape_name((ethd_shape)i), w.forms[i] = ethd_shape_form((ethd_shape)i);
  refusal(&w, path, error, message);
}

void ethd__solids_refusal(const char *path, const ethd_error *error, char message[ETHD_MESSAGE_MAX]) {
  static const shape_words w = {
      {"halfspace", "sphere", "capsule", "box", NULL},
      {"NX NY NZ C", "X Y Z R", "X1 Y1 Z1 X2 Y2 Z2 R", "X Y Z HALF_X HALF_Y HALF_Z [RX RY RZ]", NULL}};
  refusal(&w, path, error, message);
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
