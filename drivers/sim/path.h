/* The smooth pieces of the hand's path. An integration step never spans two. */
#ifndef ETHD__SIM_PATH_H
#define ETHD__SIM_PATH_H

#include "ethd/sim.h"
#include "sim/two.h"

/* Position a + b s + c s^2 + d s^3 - e sin(w s) with s = t - origin, and in x also f s^4 + g s^5; c, d, f and g are 0
   or w is. */
typedef struct ethd__piece {
  double begin, end; /* s, -INFINITY and INFINITY outside of the path */
  double origin, w;
  ethd_vec a, b, c, d, e;
  double f, g;
} ethd__piece;

enum { ETHD__PATH_TERMS = 6 };

/* Fills the piece that contains t and the time right after it. [any, rt-safe] */
void ethd__path_piece(const ethd_path *path, double t, ethd__piece *out) ETHD_RT;

typedef struct ethd__sim_motion {
  double s; /* of the piece */
  ethd_vec x, v, a;
} ethd__sim_motion;

/* Returns position, velocity and acceleration on the piece, also at its end. [any, rt-safe] */
ethd__sim_motion ethd__piece_at(const ethd__piece *piece, double t) ETHD_RT;

/* Fills the first terms of the position as a power series about the instant of `at`, which comes from
   ethd__piece_at. Term k beyond these is -w^2 / (k (k - 1)) times term k - 2. */
void ethd__piece_terms(const ethd__piece *piece, const ethd__sim_motion *at, ethd__two out[ETHD__PATH_TERMS]) ETHD_RT;

/* Returns a bound on the path's travel, |x| + |y|, within h of the instant of `at`, if the piece lasts until then. */
double ethd__piece_travel(const ethd__piece *piece, const ethd__sim_motion *at, double h) ETHD_RT;

#endif
