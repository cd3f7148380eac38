/* Ways to move the plant through a stretch, beside the library's own. */
#ifndef ETHD_APPS_BENCH_METHODS_H
#define ETHD_APPS_BENCH_METHODS_H

#include <stdbool.h>

#include "bench/problem.h"

/* The plant as a system of first order: y = 4 coordinates, 4 speeds. */
typedef struct ethd__plain {
  const ethd__body *body;
  const ethd__piece *piece;
  ethd__touch touch;
  bool live; /* 1: touch is asked for at every evaluation, nothing is watched */
} ethd__plain;

ethd__ode ethd__plain_ode(ethd__plain *plain);

/* A method of fixed steps (setting: longest step, s), or of a tolerance. */
typedef struct ethd__method {
  const char *name;
  int adaptive, events;
  double settings[8]; /* 0 ends them */
  /* From y at t, whose rates are k1, to out; returns the largest estimated error, and k1 for the next
     step where the method has it (`fresh` 0: it hasn't). */
  double (*step)(const ethd__ode *ode, double t, double h, const double *y, const double *k1, double *out,
                 double *k_next, int *fresh);
} ethd__method;

extern const ethd__method ethd__methods[];
extern const int ethd__method_count;

/* One method at one setting, as the user of ethd__problem_play. */
typedef struct ethd__runner {
  const ethd__method *method;
  const ethd__peer_ode *peer;
  double setting, h; /* h: what the last step would have as the next */
  ethd__plain plain;
  ethd__ode ode;
  void *peer_self;
} ethd__runner;

void ethd__runner_stretch(void *runner, ethd__body *body, const ethd__stretch *stretch, ethd__sim_state *state);

#endif
