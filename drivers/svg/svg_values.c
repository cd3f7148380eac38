#include <ctype.h>
#include <math.h>
#include <string.h>

#include "ethd/maths.h"
#include "svg/svg_parts.h"
#include "text/text.h"

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

static const char *blanks(const char *p) {
  while (is_space(*p)) p++;
  return p;
}

const char *ethd__svg_space(const char *p) {
  p = blanks(p);
  return *p == ',' ? blanks(p + 1) : p;
}

/* ---- attributes ---- */

const char *ethd__svg_attribute(ethd__attributes a, const char *name) {
  for (; a[0]; a += 2)
    if (strcmp(a[0], name) == 0) return a[1];
  return NULL;
}

static bool copy(const char *from, size_t n, char value[64]) {
  while (n && is_space(from[n - 1])) n--;
  if (n > 63) n = 63;
  memcpy(value, from, n);
  value[n] = 0;
  return true;
}

/* Finds a property in a style such as "name: value; name: value". */
static bool of_style(const char *style, const char *name, char value[64]) {
  size_t length = strlen(name);
  while (*(style = blanks(style))) {
    size_t n = strcspn(style, ";");
    const char *colon = memchr(style, ':', n), *end = style + n;
    size_t key = colon ? (size_t)(colon - style) : 0;
    while (key && is_space(style[key - 1])) key--;
    if (key == length && memcmp(style, name, key) == 0) {
      colon = blanks(colon + 1);
      return copy(colon, end > colon ? (size_t)(end - colon) : 0, value);
    }
    style = *end ? end + 1 : end;
  }
  return false;
}

bool ethd__svg_property(ethd__attributes a, const char *name, char value[64]) {
  const char *style = ethd__svg_attribute(a, "style"), *own = ethd__svg_attribute(a, name);
  if (style && of_style(style, name, value)) return true;
  if (!own) return false;
  own = blanks(own);
  return copy(own, strlen(own), value);
}

/* ---- numbers ---- */

/* Reads a number and leaves *p after it. It looks at no more of the text than this number, since there may be many. */
static bool number(const char **p, double *out) {
  char text[128];
  const char *start = *p, *limit = start + strnlen(start, sizeof text);
  const char *end = ethd__decimal(start + (*start == '+' || *start == '-'), limit);
  if (!end || (size_t)(end - start) >= sizeof text) return false;
  memcpy(text, start, (size_t)(end - start));
  text[end - start] = 0;
  *p = end;
  return ethd__number(text, (size_t)(end - start), out);
}

bool ethd__svg_number(const char **p, double *out) {
  if (!number(p, out)) return false;
  *p = ethd__svg_space(*p);
  return true;
}

bool ethd__svg_length(const char *text, bool in_metres, double *out) {
  static const struct {
    const char *name;
    double metres;
  } units[] = {{"", ETHD_SVG_PX}, {"px", ETHD_SVG_PX}, {"in", 0.0254},     {"cm", 0.01},
               {"mm", 0.001},     {"pt", 0.0254 / 72}, {"pc", 0.0254 / 6}, {"Q", 0.00025}};
  const char *p = blanks(text);
  if (!number(&p, out)) return false;
  size_t n = strlen(p);
  while (n && is_space(p[n - 1])) n--;
  for (size_t i = 0; i < sizeof units / sizeof *units; i++)
    if (strlen(units[i].name) == n && memcmp(units[i].name, p, n) == 0) {
      *out *= in_metres ? units[i].metres : units[i].metres / ETHD_SVG_PX;
      return true;
    }
  return false;
}

/* ---- transforms ---- */

ethd__matrix ethd__matrix_times(const ethd__matrix *a, const ethd__matrix *b) {
  ethd_vec u = ethd__matrix_turn(a, b->m[0], b->m[1]), v = ethd__matrix_turn(a, b->m[2], b->m[3]);
  ethd_vec o = ethd__matrix_put(a, b->m[4], b->m[5]);
  return (ethd__matrix){{u.x, u.y, v.x, v.y, o.x, o.y}};
}

static ethd__matrix moved(double x, double y) { return (ethd__matrix){{1, 0, 0, 1, x, y}}; }

/* Returns a rotation about (x, y); quarter turns are exact. */
static ethd__matrix rotated(double degrees, double x, double y) {
  double c, s, quarters = degrees / 90;
  if (quarters == rint(quarters)) {
    static const double sines[] = {0, 1, 0, -1};
    int q = (int)(fmod(fmod(quarters, 4) + 4, 4));
    s = sines[q], c = sines[(q + 1) % 4];
  } else {
    ethd_sincos(degrees * 3.14159265358979323846 / 180, &s, &c);
  }
  ethd__matrix to = moved(x, y), back = moved(-x, -y), turn = {{c, s, -s, c, 0, 0}};
  turn = ethd__matrix_times(&to, &turn);
  return ethd__matrix_times(&turn, &back);
}

static bool one_of(const char *name, size_t length, const double *v, int n, ethd__matrix *out) {
  const char *const names[] = {"matrix", "translate", "scale", "rotate"};
  int kind = 0;
  while (kind < 4 && !(strlen(names[kind]) == length && memcmp(names[kind], name, length) == 0)) kind++;
  if (kind == 0 && n == 6)
    memcpy(out->m, v, sizeof out->m);
  else if (kind == 1 && (n == 1 || n == 2))
    *out = moved(v[0], n == 2 ? v[1] : 0);
  else if (kind == 2 && (n == 1 || n == 2))
    *out = (ethd__matrix){{v[0], 0, 0, v[n - 1], 0, 0}};
  else if (kind == 3 && (n == 1 || n == 3))
    *out = rotated(v[0], n == 3 ? v[1] : 0, n == 3 ? v[2] : 0);
  else
    return false;
  return true;
}

bool ethd__svg_transform(const char *p, ethd__matrix *m) {
  for (p = blanks(p); *p; p = ethd__svg_space(p)) {
    const char *name = p;
    ethd__matrix next;
    double v[6];
    int n = 0;
    while (isalpha((unsigned char)*p)) p++;
    size_t length = (size_t)(p - name);
    p = blanks(p);
    if (*p++ != '(') return false;
    for (p = blanks(p); *p && *p != ')'; n++)
      if (n == 6 || !ethd__svg_number(&p, &v[n])) return false;
    if (*p++ != ')' || !one_of(name, length, v, n, &next)) return false;
    *m = ethd__matrix_times(m, &next);
  }
  double det = m->m[0] * m->m[3] - m->m[1] * m->m[2];
  return isfinite(det) && det != 0 && isfinite(m->m[4]) && isfinite(m->m[5]);
}
