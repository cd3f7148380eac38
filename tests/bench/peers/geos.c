// flags: -lgeos_c
// GEOS: distance to a prepared collection of lines. Knows no last answer; gives the distance alone.
#include <geos_c.h>
#include <math.h>
#include <stdlib.h>

#include "bench/peers.h"

typedef struct scene {
  GEOSContextHandle_t geos;
  GEOSGeometry *lines;
  const GEOSPreparedGeometry *prepared;
} scene;

static void *create(const double (*segments)[4], size_t n) {
  scene *s = malloc(sizeof *s);
  GEOSGeometry **all = malloc(n * sizeof *all);
  if (!s || !all) abort();
  s->geos = GEOS_init_r();
  for (size_t i = 0; i < n; i++) {
    GEOSCoordSequence *ends = GEOSCoordSeq_create_r(s->geos, 2, 2);
    GEOSCoordSeq_setXY_r(s->geos, ends, 0, segments[i][0], segments[i][1]);
    GEOSCoordSeq_setXY_r(s->geos, ends, 1, segments[i][2], segments[i][3]);
    all[i] = GEOSGeom_createLineString_r(s->geos, ends);
  }
  s->lines = GEOSGeom_createCollection_r(s->geos, GEOS_MULTILINESTRING, all, (unsigned)n);
  s->prepared = GEOSPrepare_r(s->geos, s->lines);
  free(all);
  /* It builds its index when it is first asked. */
  double out[3];
  GEOSGeometry *p = GEOSGeom_createPointFromXY_r(s->geos, 0, 0);
  GEOSPreparedDistance_r(s->geos, s->prepared, p, out);
  GEOSGeom_destroy_r(s->geos, p);
  return s;
}

static void nearest(void *self, const double x[2], double limit, int warm, double out[3]) {
  scene *s = self;
  (void)warm;
  GEOSGeometry *p = GEOSGeom_createPointFromXY_r(s->geos, x[0], x[1]);
  GEOSPreparedDistance_r(s->geos, s->prepared, p, out);
  GEOSGeom_destroy_r(s->geos, p);
  if (!(out[0] <= limit)) out[0] = INFINITY;
  out[1] = out[2] = NAN;
}

static void destroy(void *self) {
  scene *s = self;
  GEOSPreparedGeom_destroy_r(s->geos, s->prepared);
  GEOSGeom_destroy_r(s->geos, s->lines);
  GEOS_finish_r(s->geos);
  free(s);
}

extern const ethd__peer_scene peer_scene;
const ethd__peer_scene peer_scene = {"GEOS " GEOS_VERSION, create, nearest, NULL, destroy};
