/* Makes objects of a drawing's shapes. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "ethd/maths.h"
#include "svg/svg_parts.h"

#define QUARTER 1.57079632679489661923

/* ---- values ---- */

double ethd__svg_length_of(ethd__attributes a, const char *name, double otherwise, ethd__svg_wrong *wrong) {
  const char *text = ethd__svg_attribute(a, name);
  double v = otherwise;
  if (!text || ethd__svg_length(text, false, &v)) return v;
  snprintf(wrong->what, sizeof wrong->what, "%s: a length is needed, without %%", name);
  wrong->found = text;
  return NAN;
}

/* The canvas and the pen of one element. */
typedef struct shape {
  ethd__drawing *d;
  ethd__attributes a;
  const ethd__matrix *m;
  bool filled;
  ethd__svg_wrong *wrong;
} shape;

static double length_of(const shape *s, const char *name, double otherwise) {
  return ethd__svg_length_of(s->a, name, otherwise, s->wrong);
}

/* Returns true if a size is positive, so that the shape is drawn. */
static bool is_positive(const shape *s, double v, const char *name) {
  if (v > 0) return true;
  if (v < 0)
    snprintf(s->wrong->what, sizeof s->wrong->what, "%s is negative", name);
  else
    s->d->blank++;
  return false;
}

/* ---- shapes ---- */

/* What a unit along x and a unit along y become, m. */
typedef struct axes {
  ethd_vec u, v;
  bool square, alike; /* at right angles; and equally long */
} axes;

static axes axes_of(const ethd__matrix *m) {
  axes a = {ethd__matrix_turn(m, 1, 0), ethd__matrix_turn(m, 0, 1), false, false};
  double uu = ethd_vec_dot(a.u, a.u), vv = ethd_vec_dot(a.v, a.v);
  a.square = fabs(ethd_vec_dot(a.u, a.v)) <= 1e-12 * sqrt(uu * vv);
  a.alike = a.square && fabs(uu - vv) <= 2e-12 * uu;
  return a;
}

static void draw_ellipse(const shape *s, double x, double y, double rx, double ry) {
  axes a = axes_of(s->m);
  ethd_vec c = ethd__matrix_put(s->m, x, y);
  if (s->filled && a.alike && rx == ry) {
    double circle[] = {c.x, c.y, rx * ethd_vec_norm(a.u)};
    ethd__draw_object(s->d, ETHD_SHAPE_CIRCLE, circle, 3);
    return;
  }
  ethd__draw_arc(s->d, c, ethd_vec_scale(rx, a.u), ethd_vec_scale(ry, a.v), 0, 4 * QUARTER);
  ethd__draw_end(s->d, true, s->filled);
}

static void circle(const shape *s) {
  double x = length_of(s, "cx", 0), y = length_of(s, "cy", 0), radius = length_of(s, "r", 0);
  if (is_positive(s, radius, "r")) draw_ellipse(s, x, y, radius, radius);
}

static void ellipse(const shape *s) {
  double x = length_of(s, "cx", 0), y = length_of(s, "cy", 0);
  double rx = length_of(s, "rx", 0), ry = length_of(s, "ry", 0);
  if (is_positive(s, rx, "rx") && is_positive(s, ry, "ry")) draw_ellipse(s, x, y, rx, ry);
}

static void corner(const shape *s, double x, double y, double rx, double ry, int quarter) {
  static const double from[] = {2 * QUARTER, -QUARTER, 0, QUARTER};
  axes a = axes_of(s->m);
  ethd_vec c = ethd__matrix_put(s->m, x, y);
  if (rx > 0 && ry > 0)
    ethd__draw_arc(s->d, c, ethd_vec_scale(rx, a.u), ethd_vec_scale(ry, a.v), from[quarter], QUARTER);
  double ex = quarter == 0 || quarter == 2 ? 0
              : quarter == 1               ? rx
                                           : -rx,
         ey = quarter == 0   ? -ry
              : quarter == 2 ? ry
                             : 0;
  ethd__draw_point(s->d, ethd__matrix_put(s->m, x + ex, y + ey));
}

static void rect(const shape *s) {
  double x = length_of(s, "x", 0), y = length_of(s, "y", 0);
  double w = length_of(s, "width", 0), h = length_of(s, "height", 0);
  double rx = length_of(s, "rx", -1), ry = length_of(s, "ry", -1);
  if (!is_positive(s, w, "width") || !is_positive(s, h, "height")) return;
  rx = fmin(rx < 0 ? fmax(ry, 0) : rx, w / 2), ry = fmin(ry < 0 ? rx : ry, h / 2);
  axes b = axes_of(s->m);
  if (s->filled && b.square && !(rx > 0 && ry > 0)) {
    ethd_vec c = ethd__matrix_put(s->m, x + w / 2, y + h / 2);
    double box[] = {c.x, c.y, w / 2 * ethd_vec_norm(b.u), h / 2 * ethd_vec_norm(b.v), ethd_atan2(b.u.y, b.u.x)};
    ethd__draw_object(s->d, ETHD_SHAPE_BOX, box, 5);
    return;
  }
  corner(s, x + rx, y + ry, rx, ry, 0);
  corner(s, x + w - rx, y + ry, rx, ry, 1);
  corner(s, x + w - rx, y + h - ry, rx, ry, 2);
  corner(s, x + rx, y + h - ry, rx, ry, 3);
  ethd__draw_end(s->d, true, s->filled);
}

static void line(const shape *s) {
  double x1 = length_of(s, "x1", 0), y1 = length_of(s, "y1", 0);
  double x2 = length_of(s, "x2", 0), y2 = length_of(s, "y2", 0);
  ethd__draw_point(s->d, ethd__matrix_put(s->m, x1, y1));
  ethd__draw_point(s->d, ethd__matrix_put(s->m, x2, y2));
  ethd__draw_end(s->d, false, false);
}

static void points(const shape *s, bool closed) {
  const char *p = ethd__svg_attribute(s->a, "points");
  double x, y;
  for (p = ethd__svg_space(p ? p : ""); *p;) {
    const char *from = p;
    if (!ethd__svg_number(&p, &x) || !ethd__svg_number(&p, &y)) {
      strcpy(s->wrong->what, "points: an even count of numbers is needed");
      s->wrong->found = from;
      return;
    }
    ethd__draw_point(s->d, ethd__matrix_put(s->m, x, y));
  }
  ethd__draw_end(s->d, closed, closed && s->filled);
}

static void polyline(const shape *s) { points(s, false); }
static void polygon(const shape *s) { points(s, true); }

static void path(const shape *s) {
  const char *data = ethd__svg_attribute(s->a, "d");
  ethd__svg_path(s->d, s->m, data ? data : "", s->filled, s->wrong);
}

static void group(const shape *s) { (void)s; }

static const struct {
  const char *name;
  void (*draw)(const shape *); /* NULL: skipped */
} elements[] = {{"g", group},         {"path", path}, {"rect", rect},         {"circle", circle},
                {"ellipse", ellipse}, {"line", line}, {"polyline", polyline}, {"polygon", polygon},
                {"title", NULL},      {"desc", NULL}, {"metadata", NULL},     {"defs", NULL}};

int ethd__svg_shape(const char *name) {
  for (size_t i = 0; i < sizeof elements / sizeof *elements; i++)
    if (strcmp(elements[i].name, name) == 0) return elements[i].draw ? (int)i : ETHD_SVG_SKIPPED;
  return ETHD_SVG_UNKNOWN;
}

void ethd__svg_draw(int which, ethd__drawing *d, ethd__attributes a, const ethd__matrix *m, bool filled,
                    ethd__svg_wrong *wrong) {
  shape s = {d, a, m, filled, wrong};
  elements[which].draw(&s);
}
