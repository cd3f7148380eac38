#include "scene/text.h"

#include <stdlib.h>
#include <string.h>

#define NUMBER_LENGTH 127 /* bytes of a number's text */

typedef struct text_word {
  const char *at;
  size_t length;
} text_word;

typedef struct text_reader {
  const char *at, *end; /* the rest of the text */
  text_word line;       /* the rest of the line */
  int number;           /* of the line, from 1 */
  ethd_error *error;
} text_reader;

struct ethd__text {
  text_reader reader;
  const ethd__world *world;
  ethd_material materials[ETHD_MATERIALS_MAX];
  double *numbers;
  size_t material_count, number_count;
  size_t lines, words; /* of objects: bounds on the numbers of objects and of numbers */
};

static ethd_status refuse(text_reader *r, ethd_status status, text_word w, ethd__found found) {
  char name[64];
  size_t n = w.length < sizeof name - 1 ? w.length : sizeof name - 1;
  for (size_t i = 0; i < n; i++) name[i] = w.at[i] >= ' ' && w.at[i] < 127 ? w.at[i] : '?';
  name[n] = 0;
  ethd__refuse(r->error, status, name, found);
  if (r->error) r->error->line = r->number;
  return status;
}

static ethd_status refuse_word(text_reader *r, ethd_status status, text_word w) {
  return refuse(r, status, w, ethd__unsaid);
}

/* ---- lines and words ---- */

static bool next_line(text_reader *r) {
  if (r->at == r->end) return false;
  size_t left = (size_t)(r->end - r->at);
  const char *stop = memchr(r->at, '\n', left);
  size_t length = stop ? (size_t)(stop - r->at) : left;
  r->line = (text_word){r->at, length};
  r->at += length + (stop != NULL);
  r->number++;
  return true;
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

static bool next_word(text_reader *r, text_word *out) {
  text_word *l = &r->line;
  while (l->length && is_space(*l->at)) l->at++, l->length--;
  size_t n = 0;
  while (n < l->length && !is_space(l->at[n]) && l->at[n] != '#') n++;
  *out = (text_word){l->at, n};
  if (n == 0) l->length = 0;
  l->at += n;
  l->length -= n;
  return n > 0;
}

static bool is(text_word w, const char *text) { return strlen(text) == w.length && !memcmp(w.at, text, w.length); }

/* Splits "key=value"; returns false if there is no '='. */
static bool split(text_word w, text_word *key, text_word *value) {
  const char *sign = memchr(w.at, '=', w.length);
  if (!sign) return false;
  size_t n = (size_t)(sign - w.at);
  *key = (text_word){w.at, n};
  *value = (text_word){sign + 1, w.length - n - 1};
  return true;
}

/* ---- numbers ---- */

static size_t digits(const char *at, const char *end, char *out) {
  size_t n = 0;
  for (; at + n < end && at[n] >= '0' && at[n] <= '9'; n++)
    if (out) out[n] = at[n];
  return n;
}

/* Reads [+-] digits after an 'e'. A far too large exponent stops growing, and stays far too large. */
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
static bool number(text_word w, double *out) {
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

static bool is_name(text_word w) {
  for (size_t i = 0; i < w.length; i++) {
    char c = w.at[i];
    bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!letter && c != '_' && c != '-' && c != '.') return false;
  }
  return w.length >= 1 && w.length < ETHD_NAME_MAX;
}

static void copy_name(char name[ETHD_NAME_MAX], text_word w) {
  memcpy(name, w.at, w.length);
  name[w.length] = 0;
}

static ethd_status read_value(text_reader *r, text_word w, ethd_material *m) {
  text_word key, value;
  double number_read;
  if (!split(w, &key, &value) || !is_name(key) || !number(value, &number_read)) return refuse_word(r, ETHD_E_SYNTAX, w);
  if (m->count == ETHD_PARAMS_MAX)
    return refuse(r, ETHD_E_FULL, key, (ethd__found){ETHD_PARAMS_MAX + 1, 0, ETHD_PARAMS_MAX});
  if (!isfinite(number_read)) return refuse(r, ETHD_E_NOT_FINITE, key, (ethd__found){number_read, NAN, NAN});
  copy_name(m->values[m->count].name, key);
  m->values[m->count++].value = number_read;
  return ETHD_OK;
}

static ethd_status read_material(text_reader *r, ethd__text *t, text_word keyword) {
  text_word w;
  ethd_status status = ETHD_OK;
  if (!next_word(r, &w)) return refuse_word(r, ETHD_E_SYNTAX, keyword);
  if (!is_name(w)) return refuse_word(r, ETHD_E_SYNTAX, w);
  if (t->material_count == ETHD_MATERIALS_MAX)
    return refuse(r, ETHD_E_FULL, w, (ethd__found){ETHD_MATERIALS_MAX + 1, 0, ETHD_MATERIALS_MAX});
  ethd_material *m = &t->materials[t->material_count++];
  copy_name(m->name, w);
  m->line = r->number;
  while (!status && next_word(r, &w)) status = read_value(r, w, m);
  return status;
}

/* ---- objects ---- */

/* Returns the number of the shape of this name in a world; the world's count if there is none. */
static size_t find_shape(const ethd__world *world, text_word w) {
  size_t i = 0;
  while (i < world->count && !is(w, world->form(i)->name)) i++;
  return i;
}

/* The message names a shape of the other world: "circle, a shape of the plane". */
static ethd_status refuse_shape(ethd__text *t, text_word w) {
  const ethd__world *other = t->world == &ethd__plane ? &ethd__space : &ethd__plane;
  char name[64];
  size_t shape = find_shape(other, w), n;
  if (shape == other->count) return refuse_word(&t->reader, ETHD_E_UNKNOWN, w);
  n = ethd__append(name, 0, other->form(shape)->name);
  n = ethd__append(name, n, ", a shape of ");
  n = ethd__append(name, n, other->name);
  return refuse_word(&t->reader, ETHD_E_UNKNOWN, (text_word){name, n});
}

static ethd_status read_shape(ethd__text *t, text_word w, size_t *out) {
  *out = find_shape(t->world, w);
  return *out < t->world->count ? ETHD_OK : refuse_shape(t, w);
}

static ethd_status read_reference(ethd__text *t, text_word w, int32_t *out) {
  text_word key, name, rest;
  if (!split(w, &key, &name) || !is(key, "material") || !is_name(name))
    return refuse_word(&t->reader, ETHD_E_SYNTAX, w);
  if (next_word(&t->reader, &rest)) return refuse_word(&t->reader, ETHD_E_SYNTAX, rest);
  for (size_t i = 0; i < t->material_count; i++)
    if (is(name, t->materials[i].name)) *out = (int32_t)i;
  return *out < 0 ? refuse_word(&t->reader, ETHD_E_UNKNOWN, w) : ETHD_OK;
}

static ethd_status read_object(ethd__text *t, text_word keyword, ethd__written *o) {
  double *numbers = t->numbers + t->number_count;
  *o = (ethd__written){.material = -1, .numbers = numbers, .line = t->reader.number};
  ethd_status status = read_shape(t, keyword, &o->shape);
  if (status) return status;
  text_word w;
  while (next_word(&t->reader, &w)) {
    if (!number(w, &numbers[o->count])) {
      status = read_reference(t, w, &o->material);
      break;
    }
    o->count++;
  }
  t->number_count += o->count;
  if (!status) status = ethd__check_count(t->world->form(o->shape), o->count, ETHD_E_SYNTAX, t->reader.error);
  if (status && t->reader.error) t->reader.error->line = o->line;
  return status;
}

/* ---- the whole ---- */

static ethd_status survey(text_reader r, ethd__text *t) {
  text_word w;
  while (next_line(&r)) {
    if (memchr(r.line.at, 0, r.line.length)) return refuse_word(&r, ETHD_E_SYNTAX, (text_word){"a NUL byte", 10});
    if (!next_word(&r, &w)) continue;
    if (is(w, "material")) {
      ethd_status status = read_material(&r, t, w);
      if (status) return status;
      continue;
    }
    t->lines++;
    while (next_word(&r, &w)) t->words++;
  }
  return ETHD_OK;
}

ethd_status ethd__text_open(const char *text, size_t length, const ethd__world *world, ethd__text **out,
                            ethd_error *error) {
  *out = NULL;
  if (!text && length) return ethd__error(error, ETHD_E_ARGUMENT, "text");
  if (!text) text = "";
  ethd__text *t = calloc(1, sizeof *t);
  if (!t) return ethd__error(error, ETHD_E_MEMORY, "scene");
  t->reader = (text_reader){.at = text, .end = text + length, .error = error};
  t->world = world;
  ethd_status status = survey(t->reader, t);
  if (!status) t->numbers = malloc((t->words + 1) * sizeof *t->numbers);
  if (!status && !t->numbers) status = ethd__error(error, ETHD_E_MEMORY, "scene");
  if (status) {
    ethd__text_close(t);
    return status;
  }
  *out = t;
  return ETHD_OK;
}

ethd_status ethd__text_next(ethd__text *t, ethd__written *out) {
  text_word w;
  while (next_line(&t->reader))
    if (next_word(&t->reader, &w) && !is(w, "material")) return read_object(t, w, out);
  return ETHD_STATUS_EMPTY;
}

size_t ethd__text_lines(const ethd__text *t) { return t->lines; }

const ethd_material *ethd__text_materials(const ethd__text *t, size_t *count) {
  *count = t->material_count;
  return t->materials;
}

void ethd__text_close(ethd__text *t) {
  if (t) free(t->numbers);
  free(t);
}
