/* The fits behind ethd_fit_step. */
#ifndef ETHD_LIB_FIT_METHODS_H
#define ETHD_LIB_FIT_METHODS_H

#include "ethd/finger_fit.h"

/* Rows of robust's table. */
enum { ROBUST_GATE };

/* Where the rays met the finger, counter-clockwise, relative to the ring's centre. */
typedef struct ethd__points {
  ethd_vec p[ETHD_RAYS];
  uint32_t ray[ETHD_RAYS];
  uint32_t count;
  uint32_t used; /* bits of the rays; a fit takes away what it leaves out */
} ethd__points;

/* 0: the points don't determine a centre. robust sets points->used. [rt] */
int ethd__fit_kasa(const ethd__points *points, ethd_vec *centre) ETHD_RT;
int ethd__fit_robust(const ethd_fit *fit, ethd__points *points, ethd_vec *centre) ETHD_RT;
int ethd__fit_vertex_mean(const ethd__points *points, ethd_vec *centre) ETHD_RT;
int ethd__fit_centroid(const ethd__points *points, ethd_vec *centre) ETHD_RT;

#endif
