/* Two centres of the polygon whose vertices are the points: the mean of the vertices, and the centroid of the area. */
#include <math.h>

#include "estimate/fit_methods.h"

#define SLIM 1e-9 /* area over squared size under which a polygon counts as a line */

bool ethd__fit_vertex_mean(const ethd__points *points, ethd_vec *centre) {
  double count = ethd__count(points->used);
  two x = {0, 0}, y = {0, 0};
  if (count < 3) return false;
  for (int i = 0; i < ETHD__PAIRS; i++) x += points->x[i], y += points->y[i];
  *centre = ethd_vec_scale(1 / count, (ethd_vec){two_sum(x), two_sum(y)});
  return true;
}

/* The polygon is a fan of triangles (0, u, w) from its first vertex, with centroid (u + w) / 3 and area u x w / 2. */
bool ethd__fit_centroid(const ethd__points *points, ethd_vec *centre) {
  double area = 0, size = 0;
  ethd_vec sum = {0, 0}, u = {0, 0};
  if (!points->used) return false;
  ethd_vec first = ethd__point(points, __builtin_ctz(points->used));
  for (uint32_t rest = points->used & (points->used - 1); rest; rest &= rest - 1) {
    ethd_vec w = ethd_vec_sub(ethd__point(points, __builtin_ctz(rest)), first);
    double cross = ethd_vec_cross(u, w);
    area += cross;
    size = fmax(size, ethd_vec_dot(w, w));
    sum = ethd_vec_add(sum, ethd_vec_scale(cross / 3, ethd_vec_add(u, w)));
    u = w;
  }
  if (!(fabs(area) > SLIM * size)) return false;
  *centre = ethd_vec_add(first, ethd_vec_scale(1 / area, sum));
  return true;
}
