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

/* `peer_filter`: Kalman filter of constant acceleration with 3x3 matrices, both axes alike, the finger
   filter's `ca`: what it starts from, how it fades, how a reading takes it from sample to sample. Items
   of `in` are a tick's reading x y and its age in s, NaN without one; of `out` x y now. A tick is
   `period`. */
typedef struct ethd__peer_filter {
  const char *name;
  void *(*create)(double period, double jerk, double memory, double noise);
  void (*work)(void *self, const double (*in)[3], double (*out)[2], size_t count); /* starts anew */
  void (*destroy)(void *self);
} ethd__peer_filter;

#ifdef __cplusplus
}
#endif

#endif
