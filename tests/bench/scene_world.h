/* What the scene's contenders are asked: segments of the plane and points. */
#ifndef ETHD_TESTS_BENCH_SCENE_WORLD_H
#define ETHD_TESTS_BENCH_SCENE_WORLD_H

#include <stddef.h>

#include "bench/peers.h"
#include "ethd/ethd.h"

enum { BENCH_POINTS = 20000 };

typedef enum ethd__world_kind { ETHD__RANDOM, ETHD__CONTOUR, ETHD__WORLDS } ethd__world_kind;
extern const char *const ethd__world_names[ETHD__WORLDS];

/* random: segments all over a square of 1 m, which are shorter the more there are. contour: the edges of one
   closed wavy outline, 0.1 to 0.3 m from the middle. */
typedef struct ethd__world {
  ethd__world_kind kind;
  size_t count;
  double (*segments)[4];
} ethd__world;

void ethd__world_create(ethd__world_kind kind, size_t count, ethd__world *out);
void ethd__world_destroy(ethd__world *world);

/* The first makes a path through the middle, with a point each ms, up to 1 m/s; the second points anywhere in the
   square. */
void ethd__world_path(ethd_vec *points);
void ethd__world_anywhere(ethd_vec *points);

/* A contender. `chain`: a contour as one polyline. NULL peer: ours. */
typedef struct ethd__scene_contender {
  const char *name;
  const ethd__peer_scene *peer;
  int chain;
  void *self;
  ethd_vec n; /* a peer's normal */

  ethd_scene_hint hint; /* ours: the last answer */
  ethd_vec asked;       /* where it was asked for */
  double clearance;     /* its distance */
} ethd__scene_contender;

/* Creates a contender and returns the seconds of processor time that this took. */
double ethd__contender_create(ethd__scene_contender *c, const ethd__world *world);
void ethd__contender_destroy(ethd__scene_contender *c);
size_t ethd__contender_bytes(const ethd__scene_contender *c); /* 0: unknown */

typedef enum ethd__ask {
  ETHD__COLD,    /* nothing is known */
  ETHD__WARM,    /* the last answer is known */
  ETHD__HORIZON, /* the last answer is known, and only what is within the horizon counts */
  ETHD__ASKS
} ethd__ask;
extern const char *const ethd__ask_names[ETHD__ASKS];

#define BENCH_HORIZON 0.04 /* m */

/* Returns the distance of the nearest segment, INFINITY beyond the horizon. */
double ethd__contender_nearest(ethd__scene_contender *c, ethd__ask ask, ethd_vec x);

#endif
