/* What a peer's shared object exports: one table for each question it answers (C linkage, const). */
#ifndef ETHD_APPS_BENCH_PEERS_H
#define ETHD_APPS_BENCH_PEERS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* `peer_kinematics`: a planar serial arm. Each item of `in` is q1 q2 fx fy ex ey, of `out` x y (forward
   kinematics), J^T f, J^-1 e. */
typedef struct ethd__peer_kinematics {
  const char *name;
  void *(*create)(double link1, double link2);
  void (*work)(void *self, const double (*in)[6], double (*out)[6], size_t count);
  void (*destroy)(void *self);
} ethd__peer_kinematics;

/* `peer_filter`: Kalman filter of constant acceleration, two axes. P0 = diag(xx, vv, aa) of each; every
   tick of T s predicts with Q = jerk^2 g g^T, g = (T^3/6, T^2/2, T); a reading, where there is one,
   corrects with noise^2. Items of `in`: a reading's x and y, NaN none; of `out`: x y vx vy. */
typedef struct ethd__peer_filter {
  const char *name;
  void *(*create)(double period, double jerk, double noise, const double p0[3]);
  void (*start)(void *self, double x, double y);
  void (*work)(void *self, const double (*in)[2], double (*out)[4], size_t count);
  void (*destroy)(void *self);
} ethd__peer_filter;

#ifdef __cplusplus
}
#endif

#endif
