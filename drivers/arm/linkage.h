/* The geometry of an arm of two to seven revolute joints: the tool's pose, and its motion with each joint.

   From the base on, each joint rotates the frame about its z by q + offset, moves it by (a, 0, d) along its own axes,
   and rotates it about its x by alpha. Both conventions of Denavit and Hartenberg are such chains:

     standard  Rz(q + offset) Tz(d) Tx(a) Rx(alpha)     a, alpha of a row belong behind its joint (Universal Robots)
     modified  Rx(alpha) Tx(a) Rz(q + offset) Tz(d)     a, alpha of a row belong before it (Craig 1986; Franka)

   All [any, rt-safe]. */
#ifndef ETHD__ARM_LINKAGE_H
#define ETHD__ARM_LINKAGE_H

#include <stdint.h>

#include "ethd/guard.h"

typedef enum ethd__dh { ETHD__DH_STANDARD, ETHD__DH_MODIFIED } ethd__dh;

/* A row of the table. */
typedef struct ethd__dh_row {
  double a, d;          /* m */
  double alpha, offset; /* rad */
} ethd__dh_row;

/* A right-handed frame in R_0: its axes and its origin, m. */
typedef struct ethd__axes {
  ethd_vec3 x, y, z, at;
} ethd__axes;

typedef struct ethd__linkage {
  uint32_t count; /* of joints, 1 to ETHD_JOINTS_MAX */
  ethd__axes base;
  struct {
    double a, d, sine, cosine, offset;
  } link[ETHD_JOINTS_MAX];
  ethd_vec3 tool;   /* m: the tool's point in the last link's frame */
  ethd_vec3 facing; /* unit vector in the same frame */
} ethd__linkage;

/* The tool's pose at some angles. */
typedef struct ethd__tool {
  ethd_vec3 x;                     /* m, its point in R_0 */
  ethd_vec3 facing;                /* unit vector */
  ethd_vec3 axis[ETHD_JOINTS_MAX]; /* of each joint, unit vectors: the tool's rate is the sum of axis dq */
  ethd_vec3 j[ETHD_JOINTS_MAX];    /* m/rad: the point's velocity is the sum of j dq */
} ethd__tool;

/* Returns a frame at x, y, z, m, rotated by roll, pitch, yaw, rad, about the fixed axes x, y, z in this order, as in a
   URDF. */
ethd__axes ethd__axes_at(const double place[3], const double turned[3]) ETHD_RT;

/* Makes a linkage. The tool's point, m, and facing, a unit vector, are given in the frame behind the last row. */
void ethd__linkage_make(ethd__dh convention, const ethd__dh_row *rows, uint32_t count, const ethd__axes *base,
                        ethd_vec3 tool, ethd_vec3 facing, ethd__linkage *out) ETHD_RT;

/* Fills `out` at the angles q, rad. */
void ethd__linkage_place(const ethd__linkage *linkage, const double *q, ethd__tool *out) ETHD_RT;

/* Returns a sum of j dq or axis dq, m/s or rad/s. */
ethd_vec3 ethd__linkage_sum(const ethd_vec3 *columns, const double *dq, uint32_t count) ETHD_RT;

#endif
