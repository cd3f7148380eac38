/* The motion as a power series in time; series.c explains the idea. Each term follows from those before it, so a step
   may have any order. */
#ifndef ETHD__SIM_SERIES_H
#define ETHD__SIM_SERIES_H

#include "sim/body.h"

enum { ETHD__TERMS = ETHD__ORDER_MAX + 2 };

/* Term k belongs to (t' - t)^k. Speeds have terms 0 to order, positions one more. */
typedef struct ethd__series {
  int order;
  double step;      /* s within which it keeps the tolerance */
  double clearance; /* of the state at its end */
  int watched;      /* order of the terms below; 0: pad and ring stay apart */
  ethd__two link[ETHD__TERMS], link_v[ETHD__TERMS];
  ethd__two motor[ETHD__TERMS], motor_v[ETHD__TERMS];
  ethd__two aside[ETHD__TERMS], aside_v[ETHD__TERMS]; /* of the finger from its path */
  ethd__two hand[ETHD__TERMS];
  ethd__two beyond[ETHD__TERMS];  /* apart: (distance^2 - gap^2)/2; touching: p; each twice */
  ethd__two leaving[ETHD__TERMS]; /* touching: the terms of 1 + c p_dot */
} ethd__series;

/* Computes the motion from this state on, for `step` or the part of it that the tolerance allows. `hand` is the path's
   motion at that instant. */
void ethd__series_expand(const ethd__body *body, const ethd__piece *piece, const ethd__sim_motion *hand, double step,
                         const ethd__sim_state *state, ethd__series *out) ETHD_RT;

/* One step: the motion from `begin` to `end` and the state at its end. */
typedef struct ethd__leg {
  double begin, end;
  ethd__sim_motion hand; /* the path at `end` */
  ethd__sim_state from, to;
  ethd__series series;
} ethd__leg;

/* A leg of length 0, to start from. */
void ethd__leg_begin(const ethd__piece *piece, double t, const ethd__sim_state *state, ethd__leg *out) ETHD_RT;

/* Makes the next leg, which ends at `end`, where touch changes, or where the tolerance is used up. `cell` is the length
   of an uncut step. */
void ethd__leg_next(const ethd__body *body, const ethd__piece *piece, double end, double cell, ethd__leg *leg) ETHD_RT;

/* Fill the angles of links and motors, or the whole state, at an instant within the leg. */
void ethd__leg_angles(const ethd__body *body, const ethd__leg *leg, double t, double out[ETHD__DOF_MAX]) ETHD_RT;
void ethd__leg_at(const ethd__body *body, const ethd__piece *piece, const ethd__leg *leg, double t,
                  ethd__sim_state *out) ETHD_RT;

#endif
