/* Centres of the polygon whose vertices are the points. */
#include <math.h>

#include "fit_methods.h"

#define SLIM 1e-9 /* area over squared size under which a polygon has none */

int ethd__fit_vertex_mean(const ethd__points *points, ethd_vec *centre) {
  ethd_vec sum = {0, 0};
  if (points->count < 3) return 0;
  for (uint32_t i = 0; i < points->count; i++) sum = ethd_vec_add(sum, points->p[i]);
  *centre = ethd_vec_scale(1.0 / points->count, sum);
  return 1;
}

/* As a fan of triangles (0, u, w) from the first vertex: centroids (u + w) / 3, areas u x w / 2. */
int ethd__fit_centroid(const ethd__points *points, ethd_vec *centre) {
  double area = 0, size = 0;
  ethd_vec sum = {0, 0}, u = {0, 0};
  for (uint32_t i = 1; i < points->count; i++) {
    ethd_vec w = ethd_vec_sub(points->p[i], points->p[0]);
    double cross = ethd_vec_cross(u, w);
    area += cross;
    size = fmax(size, ethd_vec_dot(w, w));
    sum = ethd_vec_add(sum, ethd_vec_scale(cross / 3, ethd_vec_add(u, w)));
    u = w;
  }
  if (!(fabs(area) > SLIM * size)) return 0;
  *centre = ethd_vec_add(points->p[0], ethd_vec_scale(1 / area, sum));
  return 1;
}
