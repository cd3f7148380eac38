/* Pieces of the hand's path, within which it is smooth: an integration step never spans two. */
#ifndef ETHD_SIM_PATH_H
#define ETHD_SIM_PATH_H

#include "ethd/sim.h"

/* Position x = a + b s + c s^2 + d s^3 - e sin(w s) with s = t - origin. */
typedef struct ethd__piece {
  double begin, end; /* s, -INFINITY and INFINITY outside of the path */
  double origin, w;
  ethd_vec a, b, c, d, e;
} ethd__piece;

/* The piece that holds at t and right after it. [any, rt-safe] */
void ethd__path_piece(const ethd_path *path, double t, ethd__piece *out) ETHD_RT;

typedef struct ethd__motion {
  ethd_vec x, v, a;
} ethd__motion;

/* Position, velocity and acceleration by that piece, also at its end. [any, rt-safe] */
ethd__motion ethd__piece_at(const ethd__piece *piece, double t) ETHD_RT;

#endif
