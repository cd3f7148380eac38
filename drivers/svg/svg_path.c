/* Reads path data. Points are in user units until they are drawn. */
#include <ctype.h>
#include <math.h>
#include <search.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/maths.h"
#include "svg/svg_parts.h"

#define TURN 6.28318530717958647692

/* The bounding box of a closed part that is filled. */
typedef struct box {
  double x_min, x_max, y_min, y_max;
} box;

typedef struct path {
  ethd__drawing *d;
  const ethd__matrix *m;
  const char *p;
  const char *word;            /* where the command began */
  ethd_vec at, start, control; /* control: the last curve's second last point */
  char last;                   /* the last command, in capitals */
  bool filled, open;           /* open: a part is being drawn */
  size_t objects;              /* how many there were before this path */
  const char *wrong;
} path;

static ethd_vec to_metres(const path *q, ethd_vec p) { return ethd__matrix_put(q->m, p.x, p.y); }

static bool refuse(path *q, const char *wrong) {
  if (!q->wrong) q->wrong = wrong;
  return false;
}

static bool numbers(path *q, double *v, int n) {
  for (int i = 0; i < n; i++)
    if (!ethd__svg_number(&q->p, &v[i])) return refuse(q, "a number is missing in a path");
  return true;
}

static ethd_vec place(const path *q, const double *v, bool relative) {
  ethd_vec p = {v[0], v[1]};
  return relative ? ethd_vec_add(q->at, p) : p;
}

/* ---- parts ---- */

static void end(path *q, bool closed) {
  if (q->open) ethd__draw_end(q->d, closed, q->filled);
  q->open = false;
}

/* A part begins with the first thing that is drawn. */
static void begin(path *q) {
  if (q->open) return;
  q->open = true;
  q->start = q->at;
  ethd__draw_point(q->d, to_metres(q, q->at));
}

static void line_to(path *q, ethd_vec to) {
  begin(q);
  ethd__draw_point(q->d, to_metres(q, to));
  q->at = to;
}

static void curve_to(path *q, const ethd_vec *p, int degree) {
  ethd_vec metres[4];
  begin(q);
  for (int i = 0; i <= degree; i++) metres[i] = to_metres(q, p[i]);
  ethd__draw_curve(q->d, metres, degree);
  q->control = p[degree - 1];
  q->at = p[degree];
}

/* ---- arcs ---- */

/* Finds the centre from the two ends. In the ellipse's own frame it is a unit circle about (cx, cy), half of the vector
   between the ends is (hx, hy), and the centre lies beside the middle. Radii that are too small grow. */
static void arc_to(path *q, const double *v, ethd_vec to) {
  double rx = fabs(v[0]), ry = fabs(v[1]), c, s;
  begin(q);
  ethd_sincos(v[2] * TURN / 360, &s, &c);
  ethd_vec h = ethd_vec_scale(0.5, ethd_vec_sub(q->at, to));
  double hx = (c * h.x + s * h.y) / rx, hy = (c * h.y - s * h.x) / ry, hh = hx * hx + hy * hy;
  if (!(rx > 0 && ry > 0) || !(hh > 0) || !isfinite(hh)) { /* a straight line, or nothing */
    line_to(q, to);
    return;
  }
  double grow = hh > 1 ? sqrt(hh) : 1, aside = hh > 1 ? 0 : sqrt((1 - hh) / hh);
  if (v[3] == v[4]) aside = -aside;
  rx *= grow, ry *= grow, hx /= grow, hy /= grow;
  double cx = aside * hy, cy = -aside * hx, from = ethd_atan2(hy - cy, hx - cx);
  double turn = ethd_atan2(-hy - cy, -hx - cx) - from;
  if (v[4] != 0 && turn < 0) turn += TURN;
  if (v[4] == 0 && turn > 0) turn -= TURN;
  ethd_vec middle = ethd_vec_scale(0.5, ethd_vec_add(q->at, to)), u = {rx * c, rx * s}, w = {-ry * s, ry * c};
  ethd_vec centre = ethd_vec_add(middle, ethd_vec_add(ethd_vec_scale(cx, u), ethd_vec_scale(cy, w)));
  ethd__draw_arc(q->d, to_metres(q, centre), ethd__matrix_turn(q->m, u.x, u.y), ethd__matrix_turn(q->m, w.x, w.y), from,
                 turn);
  ethd__draw_point(q->d, to_metres(q, to));
  q->at = to;
}

/* Reads a flag, which is one digit and needs no separator. */
static bool flag(path *q, double *out) {
  if (*q->p != '0' && *q->p != '1') return refuse(q, "a flag of an arc isn't 0 or 1");
  *out = *q->p - '0';
  q->p = ethd__svg_space(q->p + 1);
  return true;
}

static bool arc(path *q, bool relative) {
  double v[7];
  if (!numbers(q, v, 3) || !flag(q, &v[3]) || !flag(q, &v[4]) || !numbers(q, v + 5, 2)) return false;
  arc_to(q, v, place(q, v + 5, relative));
  return true;
}

/* ---- commands ---- */

/* Returns the control point of the last curve turned about its end, or the end if the last command wasn't such a
   curve. */
static ethd_vec mirrored(const path *q, const char *after) {
  return strchr(after, q->last) ? ethd_vec_sub(ethd_vec_scale(2, q->at), q->control) : q->at;
}

static bool curve(path *q, char command, bool relative) {
  double v[6];
  bool smooth = command == 'S' || command == 'T', cubic = command == 'C' || command == 'S';
  int degree = cubic ? 3 : 2, given = degree - smooth;
  ethd_vec p[4] = {q->at};
  if (!numbers(q, v, 2 * given)) return false;
  if (smooth) p[1] = mirrored(q, cubic ? "CS" : "QT");
  for (int i = 0; i < given; i++) p[1 + smooth + i] = place(q, v + 2 * i, relative);
  curve_to(q, p, degree);
  return true;
}

/* Reads and draws one set of a command's numbers. */
static bool once(path *q, char command, bool relative) {
  double v[2];
  switch (command) {
  case 'M':
    if (!numbers(q, v, 2)) return false;
    end(q, false);
    q->at = q->start = place(q, v, relative);
    return true;
  case 'L':
    if (!numbers(q, v, 2)) return false;
    line_to(q, place(q, v, relative));
    return true;
  case 'H':
    if (!numbers(q, v, 1)) return false;
    line_to(q, (ethd_vec){relative ? q->at.x + v[0] : v[0], q->at.y});
    return true;
  case 'V':
    if (!numbers(q, v, 1)) return false;
    line_to(q, (ethd_vec){q->at.x, relative ? q->at.y + v[0] : v[0]});
    return true;
  case 'A': return arc(q, relative);
  default: return curve(q, command, relative);
  }
}

static void close_part(path *q) {
  end(q, true);
  q->at = q->start;
}

static bool command(path *q) {
  char letter = *q->p, capital = (char)toupper((unsigned char)letter);
  q->word = q->p;
  if (!letter || !strchr("MLHVCSQTAZ", capital)) return refuse(q, "not a command of a path, which are MLHVCSQTAZ");
  if (q->last == 0 && capital != 'M') return refuse(q, "a path must begin with M");
  q->p = ethd__svg_space(q->p + 1);
  if (capital == 'Z') {
    close_part(q);
    q->last = 'Z';
    return true;
  }
  do {
    if (!once(q, capital, letter != capital)) return false;
    q->last = capital;
    if (capital == 'M') capital = 'L', letter = letter == 'm' ? 'l' : 'L'; /* more pairs are lines */
  } while (*q->p && !isalpha((unsigned char)*q->p) && !q->d->status);
  return true;
}

/* ---- holes ---- */

static box box_of(const ethd__drawing *d, const ethd__drawn *o) {
  box b = {INFINITY, -INFINITY, INFINITY, -INFINITY};
  for (const double *p = d->numbers + o->first, *last = p + o->count; p < last; p += 2) {
    b.x_min = fmin(b.x_min, p[0]), b.x_max = fmax(b.x_max, p[0]);
    b.y_min = fmin(b.y_min, p[1]), b.y_max = fmax(b.y_max, p[1]);
  }
  return b;
}

/* Where a box begins or ends in x. */
typedef struct box_edge {
  double x;
  const box *of;
  bool ends;
} box_edge;

/* Orders edges so that one of two boxes that touch begins before the other ends. */
static int by_x(const void *a, const void *b) {
  const box_edge *p = a, *q = b;
  if (p->x != q->x) return p->x < q->x ? -1 : 1;
  return (int)p->ends - (int)q->ends;
}

/* Orders boxes by height; boxes that share a height are equal here. */
static int by_y(const void *a, const void *b) {
  const box *p = a, *q = b;
  return p->y_max < q->y_min ? -1 : p->y_min > q->y_max;
}

static void keep(void *of) { (void)of; }

/* Sweeps from left to right with a tree of the boxes that have begun and not ended. These lie apart in height, or else
   two overlap. Returns true also if there is no memory. */
static bool any_overlap(box_edge *edges, size_t count) {
  void *tree = NULL;
  bool overlap = false;
  qsort(edges, count, sizeof *edges, by_x);
  for (size_t i = 0; i < count && !overlap; i++) {
    if (edges[i].ends) {
      tdelete(edges[i].of, &tree, by_y);
    } else {
      const box **there = tsearch(edges[i].of, &tree, by_y);
      overlap = !there || *there != edges[i].of;
    }
  }
  tdestroy(tree, keep);
  return overlap;
}

/* Returns true if a part may be a hole. Parts of one filled path that lie side by side are solids of their own. */
static bool may_have_holes(const path *q) {
  const ethd__drawing *d = q->d;
  size_t n = 0, count = d->object_count - q->objects;
  if (!q->filled || count < 2 || d->status) return false;
  box *boxes = malloc(count * sizeof *boxes);
  box_edge *edges = malloc(2 * count * sizeof *edges);
  for (size_t i = 0; boxes && edges && i < count; i++) {
    const ethd__drawn *o = &d->objects[q->objects + i];
    if (o->shape != ETHD_SHAPE_POLYGON) continue;
    boxes[n] = box_of(d, o);
    edges[2 * n] = (box_edge){boxes[n].x_min, &boxes[n], false};
    edges[2 * n + 1] = (box_edge){boxes[n].x_max, &boxes[n], true};
    n++;
  }
  bool holes = !boxes || !edges || any_overlap(edges, 2 * n);
  free(boxes);
  free(edges);
  return holes;
}

void ethd__svg_path(ethd__drawing *d, const ethd__matrix *m, const char *text, bool filled, ethd__svg_wrong *wrong) {
  path q = {.d = d, .m = m, .p = ethd__svg_space(text), .filled = filled, .objects = d->object_count};
  q.word = q.p;
  while (*q.p && !q.wrong && !d->status) command(&q);
  end(&q, false);
  if (q.wrong)
    wrong->found = q.word;
  else if (may_have_holes(&q))
    q.wrong = "filled parts overlap, and objects have no holes; fill=\"none\" makes walls of them";
  if (q.wrong) strcpy(wrong->what, q.wrong);
}
