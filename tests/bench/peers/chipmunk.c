// flags: -lchipmunk
// Chipmunk2D: nearest point among static segments; the last answer's distance limits the search. Debian's
// library checks its assertions.
#include <chipmunk/chipmunk.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "bench/peers.h"

#define STRING(x) #x
#define TEXT(x) STRING(x)

typedef struct space_scene {
  cpSpace *space;
  const double (*segments)[4];
  size_t nearest;
} space_scene;

/* It greets on stdout. */
static cpSpace *quiet_space(void) {
  fflush(stdout);
  int copy = dup(1), nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, 1);
  cpSpace *space = cpSpaceNew();
  fflush(stdout);
  dup2(copy, 1);
  close(nowhere);
  close(copy);
  return space;
}

static void *create(const double (*segments)[4], size_t n) {
  space_scene *s = malloc(sizeof *s);
  if (!s) abort();
  s->space = quiet_space();
  s->segments = segments;
  s->nearest = 0;
  for (size_t i = 0; i < n; i++) {
    cpVect a = cpv(segments[i][0], segments[i][1]), b = cpv(segments[i][2], segments[i][3]);
    cpShape *shape = cpSegmentShapeNew(cpSpaceGetStaticBody(s->space), a, b, 0);
    cpShapeSetUserData(shape, (void *)i);
    cpSpaceAddShape(s->space, shape);
  }
  cpSpaceReindexStatic(s->space);
  return s;
}

static void nearest(void *self, const double x[2], double limit, int warm, double out[3]) {
  space_scene *s = self;
  double most = limit, known[3];
  if (warm) {
    ethd__peer_point(s->segments[s->nearest], x, known);
    most = fmin(limit, known[0] * (1 + 1e-15) + 1e-300);
  }
  cpPointQueryInfo info;
  const cpShape *shape = cpSpacePointQueryNearest(s->space, cpv(x[0], x[1]), most, CP_SHAPE_FILTER_ALL, &info);
  out[0] = INFINITY;
  if (shape) s->nearest = (size_t)cpShapeGetUserData(shape);
  if (shape || (warm && known[0] <= limit)) ethd__peer_point(s->segments[s->nearest], x, out);
}

static void free_shape(cpBody *body, cpShape *shape, void *space) {
  (void)body;
  cpSpaceRemoveShape(space, shape);
  cpShapeFree(shape);
}

static void destroy(void *self) {
  space_scene *s = self;
  cpBodyEachShape(cpSpaceGetStaticBody(s->space), free_shape, s->space);
  cpSpaceFree(s->space);
  free(s);
}

extern const ethd__peer_scene peer_scene;
const ethd__peer_scene peer_scene = {
    "Chipmunk2D " TEXT(CP_VERSION_MAJOR) "." TEXT(CP_VERSION_MINOR) "." TEXT(CP_VERSION_RELEASE), create, nearest, NULL,
    destroy};
