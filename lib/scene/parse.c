/* Reads the text twice: the first pass counts lines and takes the materials, so that an object may name one that is
   defined below it; the second takes the objects. */
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "fp_mode.h"
#include "scene/check.h"
#include "scene/scene.h"

#define NUMBER_LENGTH 127 /* bytes of a number's text */

typedef struct scene_word {
  const char *at;
  size_t length;
} scene_word;

typedef struct scene_reader {
  const char *at, *end; /* what is left of the text */
  scene_word line;      /* what is left of the line */
  int number;           /* of the line, from 1 */
  ethd_error *error;
} scene_reader;

typedef struct draft {
  ethd_material materials[ETHD_MATERIALS_MAX];
  ethd_object_def *objects;
  double *numbers;
  size_t material_count, object_count, number_count;
  size_t lines, words; /* of objects: there are no more objects and numbers than these */
} draft;

static ethd_status refuse(scene_reader *r, ethd_status status, scene_word w, ethd__found found) {
  char name[64];
  size_t n = w.length < sizeof name - 1 ? w.length : sizeof name - 1;
  for (size_t i = 0; i < n; i++) name[i] = w.at[i] >= ' ' && w.at[i] < 127 ? w.at[i] : '?';
  name[n] = 0;
  ethd__refuse(r->error, status, name, found);
  if (r->error) r->error->line = r->number;
  return status;
}

static ethd_status refuse_word(scene_reader *r, ethd_status status, scene_word w) {
  return refuse(r, status, w, ethd__unsaid);
}

/* ---- lines and words ---- */

static bool next_line(scene_reader *r) {
  if (r->at == r->end) return false;
  size_t left = (size_t)(r->end - r->at);
  const char *stop = memchr(r->at, '\n', left);
  size_t length = stop ? (size_t)(stop - r->at) : left;
  r->line = (scene_word){r->at, length};
  r->at += length + (stop != NULL);
  r->number++;
  return true;
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

static bool next_word(scene_reader *r, scene_word *out) {
  scene_word *l = &r->line;
  while (l->length && is_space(*l->at)) l->at++, l->length--;
  size_t n = 0;
  while (n < l->length && !is_space(l->at[n]) && l->at[n] != '#') n++;
  *out = (scene_word){l->at, n};
  if (n == 0) l->length = 0;
  l->at += n;
  l->length -= n;
  return n > 0;
}

static bool is(scene_word w, const char *text) { return strlen(text) == w.length && !memcmp(w.at, text, w.length); }

/* Splits "key=value"; returns false if there is no '='. */
static bool split(scene_word w, scene_word *key, scene_word *value) {
  const char *sign = memchr(w.at, '=', w.length);
  if (!sign) return false;
  size_t n = (size_t)(sign - w.at);
  *key = (scene_word){w.at, n};
  *value = (scene_word){sign + 1, w.length - n - 1};
  return true;
}

/* ---- numbers ---- */

static size_t digits(const char *at, const char *end, char *out) {
  size_t n = 0;
  for (; at + n < end && at[n] >= '0' && at[n] <= '9'; n++)
    if (out) out[n] = at[n];
  return n;
}

/* Reads [+-] digits after an 'e'. One that is far too large stops growing, but stays far too large. */
static bool read_exponent(const char **at, const char *end, long *out) {
  bool minus = *at < end && **at == '-';
  if (*at < end && (**at == '+' || **at == '-')) ++*at;
  size_t places = digits(*at, end, NULL);
  for (size_t i = 0; i < places; i++)
    if (*out < 100000) *out = *out * 10 + ((*at)[i] - '0');
  *at += places;
  if (minus) *out = -*out;
  return places > 0;
}

static void write_exponent(char *to, long exponent) {
  char digits_of[24];
  size_t n = sizeof digits_of;
  unsigned long rest = (unsigned long)labs(exponent);
  digits_of[--n] = 0;
  do digits_of[--n] = (char)('0' + rest % 10);
  while (rest /= 10);
  *to++ = 'e';
  *to++ = exponent < 0 ? '-' : '+';
  memcpy(to, digits_of + n, sizeof digits_of - n);
}

/* Reads [+-] digits [. digits] [e [+-] digits], with a digit before or after the point. strtod expects the locale's
   decimal point, so it gets the digits without a point and a smaller exponent. */
static bool number(scene_word w, double *out) {
  char text[NUMBER_LENGTH + 32], *to = text;
  const char *at = w.at, *end = w.at + w.length;
  size_t whole, parts = 0;
  long exponent = 0;
  if (w.length == 0 || w.length > NUMBER_LENGTH) return false;
  if (*at == '+' || *at == '-') *to++ = *at++;
  whole = digits(at, end, to);
  at += whole, to += whole;
  if (at < end && *at == '.') {
    parts = digits(++at, end, to);
    at += parts, to += parts;
  }
  if (whole + parts == 0) return false;
  if (at < end && (*at == 'e' || *at == 'E')) {
    at++;
    if (!read_exponent(&at, end, &exponent)) return false;
  }
  if (at != end) return false;
  write_exponent(to, exponent - (long)parts);
  *out = strtod(text, NULL);
  return true;
}

/* ---- materials ---- */

static bool is_name(scene_word w) {
  for (size_t i = 0; i < w.length; i++) {
    char c = w.at[i];
    bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!letter && c != '_' && c != '-' && c != '.') return false;
  }
  return w.length >= 1 && w.length < ETHD_NAME_MAX;
}

static void copy_name(char name[ETHD_NAME_MAX], scene_word w) {
  memcpy(name, w.at, w.length);
  name[w.length] = 0;
}

static ethd_status read_value(scene_reader *r, scene_word w, ethd_material *m) {
  scene_word key, value;
  double number_read;
  if (!split(w, &key, &value) || !is_name(key) || !number(value, &number_read)) return refuse_word(r, ETHD_E_SYNTAX, w);
  if (m->count == ETHD_PARAMS_MAX)
    return refuse(r, ETHD_E_FULL, key, (ethd__found){ETHD_PARAMS_MAX + 1, 0, ETHD_PARAMS_MAX});
  if (!isfinite(number_read)) return refuse(r, ETHD_E_NOT_FINITE, key, (ethd__found){number_read, NAN, NAN});
  copy_name(m->values[m->count].name, key);
  m->values[m->count++].value = number_read;
  return ETHD_OK;
}

static ethd_status read_material(scene_reader *r, draft *d, scene_word keyword) {
  scene_word w;
  ethd_status status = ETHD_OK;
  if (!next_word(r, &w)) return refuse_word(r, ETHD_E_SYNTAX, keyword);
  if (!is_name(w)) return refuse_word(r, ETHD_E_SYNTAX, w);
  if (d->material_count == ETHD_MATERIALS_MAX)
    return refuse(r, ETHD_E_FULL, w, (ethd__found){ETHD_MATERIALS_MAX + 1, 0, ETHD_MATERIALS_MAX});
  ethd_material *m = &d->materials[d->material_count++];
  copy_name(m->name, w);
  m->line = r->number;
  while (!status && next_word(r, &w)) status = read_value(r, w, m);
  return status;
}

/* ---- objects ---- */

static ethd_status read_shape(scene_reader *r, scene_word w, ethd_shape *out) {
  for (int i = 0; i < ETHD_SHAPE_COUNT; i++) {
    *out = (ethd_shape)i;
    if (is(w, ethd_shape_name(*out))) return ETHD_OK;
  }
  return refuse_word(r, ETHD_E_UNKNOWN, w);
}

static ethd_status read_reference(scene_reader *r, const draft *d, scene_word w, ethd_object_def *o) {
  scene_word key, name, rest;
  if (!split(w, &key, &name) || !is(key, "material") || !is_name(name)) return refuse_word(r, ETHD_E_SYNTAX, w);
  if (next_word(r, &rest)) return refuse_word(r, ETHD_E_SYNTAX, rest);
  for (size_t i = 0; i < d->material_count; i++)
    if (is(name, d->materials[i].name)) o->material = (int32_t)i;
  return o->material < 0 ? refuse_word(r, ETHD_E_UNKNOWN, w) : ETHD_OK;
}

static ethd_status read_object(scene_reader *r, draft *d, scene_word keyword) {
  ethd_object_def *o = &d->objects[d->object_count++];
  double *numbers = d->numbers + d->number_count;
  *o = (ethd_object_def){.material = -1, .numbers = numbers, .line = r->number};
  ethd_status status = read_shape(r, keyword, &o->shape);
  if (status) return status;
  scene_word w;
  while (next_word(r, &w)) {
    if (!number(w, &numbers[o->count])) {
      status = read_reference(r, d, w, o);
      break;
    }
    o->count++;
  }
  d->number_count += o->count;
  if (!status) status = ethd__check_count(o->shape, o->count, ETHD_E_SYNTAX, r->error);
  if (status && r->error) r->error->line = r->number;
  return status;
}

/* ---- the whole ---- */

static ethd_status survey(scene_reader r, draft *d) {
  scene_word w;
  while (next_line(&r)) {
    if (memchr(r.line.at, 0, r.line.length)) return refuse_word(&r, ETHD_E_SYNTAX, (scene_word){"a NUL byte", 10});
    if (!next_word(&r, &w)) continue;
    if (is(w, "material")) {
      ethd_status status = read_material(&r, d, w);
      if (status) return status;
      continue;
    }
    d->lines++;
    while (next_word(&r, &w)) d->words++;
  }
  return ETHD_OK;
}

static ethd_status read_objects(scene_reader r, draft *d) {
  scene_word w;
  ethd_status status = ETHD_OK;
  while (!status && next_line(&r))
    if (next_word(&r, &w) && !is(w, "material")) status = read_object(&r, d, w);
  return status;
}

static ethd_status read_all(scene_reader r, draft *d) {
  ethd_status status = survey(r, d);
  if (status) return status;
  d->objects = malloc((d->lines + 1) * sizeof *d->objects);
  d->numbers = malloc((d->words + 1) * sizeof *d->numbers);
  if (!d->objects || !d->numbers) return ethd__error(r.error, ETHD_E_MEMORY, "scene");
  return read_objects(r, d);
}

ETHD__FP_APART static ethd_status parse(const char *text, size_t length, ethd_scene **out, ethd_error *error) {
  *out = NULL;
  if (!text && length) return ethd__error(error, ETHD_E_ARGUMENT, "text");
  if (!text) text = "";
  draft *d = calloc(1, sizeof *d);
  if (!d) return ethd__error(error, ETHD_E_MEMORY, "scene");
  ethd_status status = read_all((scene_reader){.at = text, .end = text + length, .error = error}, d);
  if (!status) {
    ethd_scene_def def = {d->objects, d->object_count, d->materials, d->material_count};
    status = ethd_scene_create(&def, out, error);
  }
  free(d->objects);
  free(d->numbers);
  free(d);
  return status;
}

ethd_status ethd_scene_parse(const char *text, size_t length, ethd_scene **out, ethd_error *error) {
  const uint64_t callers = ethd__fp_take();
  const ethd_status status = parse(text, length, out, error);
  ethd__fp_give(callers);
  return status;
}
