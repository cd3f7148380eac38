/* What the files of the reader of drawings share: the text of attributes, and the drawing. All [main]. */
#ifndef ETHD__SVG_SVG_PARTS_H
#define ETHD__SVG_SVG_PARTS_H

#include <stdbool.h>

#include "svg/svg.h"

#define ETHD_SVG_POINTS_MAX 20000000 /* of a drawing */

/* ---- attributes: svg_values.c ---- */

/* Names and values by turns, then NULL. */
typedef const char *const *ethd__attributes;

/* Returns the value of an attribute, NULL if there is none of this name. */
const char *ethd__svg_attribute(ethd__attributes a, const char *name);

/* Gives a property of the style or else the attribute; returns false if there is neither. */
bool ethd__svg_property(ethd__attributes a, const char *name, char value[64]);

/* Skips spaces and at most one comma; returns where that leads. */
const char *ethd__svg_space(const char *p);

/* Reads the number at *p and what separates it from the next. */
bool ethd__svg_number(const char **p, double *out);

/* Reads a length with its unit: px, which may be left out, mm, cm, in, pt, pc or Q; 96 px are an inch. */
bool ethd__svg_length(const char *text, bool in_metres, double *out);

#define ETHD_SVG_PX (0.0254 / 96) /* m */

/* The map x' = m[0] x + m[2] y + m[4], y' = m[1] x + m[3] y + m[5]. */
typedef struct ethd__matrix {
  double m[6];
} ethd__matrix;

/* Returns the matrix that applies first b, then a. */
ethd__matrix ethd__matrix_times(const ethd__matrix *a, const ethd__matrix *b);

static inline ethd_vec ethd__matrix_turn(const ethd__matrix *m, double x, double y) {
  return (ethd_vec){m->m[0] * x + m->m[2] * y, m->m[1] * x + m->m[3] * y};
}

static inline ethd_vec ethd__matrix_put(const ethd__matrix *m, double x, double y) {
  return ethd_vec_add(ethd__matrix_turn(m, x, y), (ethd_vec){m->m[4], m->m[5]});
}

/* Applies a list of transforms to `m`; returns false if one isn't supported. */
bool ethd__svg_transform(const char *text, ethd__matrix *m);

/* ---- what is drawn, in metres: svg_draw.c ---- */

typedef struct ethd__drawn {
  ethd_shape shape;
  size_t first, count; /* of the numbers */
  int line;
} ethd__drawn;

typedef struct ethd__drawing {
  double *numbers;
  ethd__drawn *objects;
  size_t number_count, number_room, object_count, object_room;
  size_t chain; /* the first number of the chain that is being drawn */
  size_t blank;
  double tolerance;
  int line;
  ethd_status status; /* of the first failure: E_MEMORY or E_FULL */
} ethd__drawing;

void ethd__draw_object(ethd__drawing *d, ethd_shape shape, const double *numbers, size_t count);

/* Adds a point to the chain. */
void ethd__draw_point(ethd__drawing *d, ethd_vec p);
/* Adds a Bezier curve from p[0], where the chain is, to p[degree]. */
void ethd__draw_curve(ethd__drawing *d, const ethd_vec *p, int degree);
/* Adds the arc centre + u cos a + v sin a, where a runs from `from` to `from` + `turn`; the first point is drawn, the
   last isn't. */
void ethd__draw_arc(ethd__drawing *d, ethd_vec centre, ethd_vec u, ethd_vec v, double from, double turn);
/* Makes the chain an object, if it has a length. */
void ethd__draw_end(ethd__drawing *d, bool closed, bool filled);

/* ---- elements: svg_shapes.c, svg_path.c ---- */

typedef struct ethd__svg_wrong {
  char what[112];    /* "": nothing is wrong */
  const char *found; /* NULL: nothing to show */
} ethd__svg_wrong;

/* Returns the attribute's length, `otherwise` if there is none, NaN if it is wrong. */
double ethd__svg_length_of(ethd__attributes a, const char *name, double otherwise, ethd__svg_wrong *wrong);

enum { ETHD_SVG_UNKNOWN = -1, ETHD_SVG_SKIPPED = -2 };

/* Returns which element this is. */
int ethd__svg_shape(const char *name);

void ethd__svg_draw(int which, ethd__drawing *d, ethd__attributes a, const ethd__matrix *m, bool filled,
                    ethd__svg_wrong *wrong);

void ethd__svg_path(ethd__drawing *d, const ethd__matrix *m, const char *text, bool filled, ethd__svg_wrong *wrong);

#endif
