/* What a peer's shared object exports: one table for each question it answers (C linkage, const). */
#ifndef ETHD_TESTS_BENCH_PEERS_H
#define ETHD_TESTS_BENCH_PEERS_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

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

/* `peer_linkage`: an arm in space. A row of `rows` is a, alpha, d and the angle at 0 of a joint, as Denavit and Hartenberg
   have them; the tool is the frame behind the last row. Each item of `in` is the angles, of `out` the tool's place, then
   for each joint how the place moves, 3 numbers, and how the tool turns, 3 numbers. */
enum { ETHD__PEER_JOINTS = 6, ETHD__PEER_LINKAGE = 3 + 6 * ETHD__PEER_JOINTS };
typedef struct ethd__peer_linkage {
  const char *name;
  void *(*create)(const double (*rows)[4]);
  void (*work)(void *self, const double (*in)[ETHD__PEER_JOINTS], double (*out)[ETHD__PEER_LINKAGE], size_t count);
  void (*destroy)(void *self);
} ethd__peer_linkage;

/* `peer_following`, ended by a row without a name: the joints of such an arm follow commanded speeds by a second order,
   critically damped, from rest at 0. Each item of `in` is the speeds that are held for a period, of `out` the angles and
   what a linkage gives, both after it. */
enum { ETHD__PEER_FOLLOWING = ETHD__PEER_JOINTS + ETHD__PEER_LINKAGE };
typedef struct ethd__peer_following {
  const char *name;
  void *(*create)(const double (*rows)[4], double frequency, double period);
  void (*work)(void *self, const double (*in)[ETHD__PEER_JOINTS], double (*out)[ETHD__PEER_FOLLOWING], size_t count);
  void (*destroy)(void *self);
} ethd__peer_following;

/* `peer_scene`: segments {x1, y1, x2, y2} of the plane; the array stays where it is. */
typedef struct ethd__peer_scene {
  const char *name;
  void *(*create)(const double (*segments)[4], size_t count);
  /* out: distance of the nearest segment, INFINITY if that is beyond `limit`, and the point there. `warm`: it may
     start from its last answer. */
  void (*nearest)(void *self, const double x[2], double limit, int warm, double out[3]);
  size_t (*bytes)(void *self); /* NULL: unknown */
  void (*destroy)(void *self);
} ethd__peer_scene;

/* `peer_mesh`: the surfaces within `range`, m, of x in a mesh that a file holds. */
struct ethd_surface;
typedef struct ethd__peer_mesh {
  const char *name;
  void *(*create)(const char *path); /* NULL: it can't be read */
  uint32_t (*surfaces)(void *self, const double x[3], double range, struct ethd_surface *out, uint32_t most);
  void (*destroy)(void *self);
} ethd__peer_mesh;

/* Returns the squared distance from x to a segment. */
static inline double ethd__peer_squared(const double s[4], const double x[2]) {
  double ex = s[2] - s[0], ey = s[3] - s[1], ux = x[0] - s[0], uy = x[1] - s[1];
  double along = ex * ux + ey * uy, ee = ex * ex + ey * ey;
  double across = ex * uy - ey * ux, wx = x[0] - s[2], wy = x[1] - s[3];
  return along <= 0 ? ux * ux + uy * uy : along >= ee ? wx * wx + wy * wy : across * across / ee;
}

/* Gives the distance from x to a segment, and the point there. */
static inline void ethd__peer_point(const double s[4], const double x[2], double out[3]) {
  double ex = s[2] - s[0], ey = s[3] - s[1], ux = x[0] - s[0], uy = x[1] - s[1];
  double along = ex * ux + ey * uy, ee = ex * ex + ey * ey;
  double t = along <= 0 ? 0 : along >= ee ? 1 : along / ee;
  out[0] = sqrt(ethd__peer_squared(s, x));
  out[1] = t == 1 ? s[2] : s[0] + t * ex;
  out[2] = t == 1 ? s[3] : s[1] + t * ey;
}

#ifdef __cplusplus
}
#endif

#endif
