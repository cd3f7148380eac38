/* Methods that move the plant through a stretch, beside the library's own. */
#ifndef ETHD__APPS_BENCH_METHODS_H
#define ETHD__APPS_BENCH_METHODS_H

#include <stdbool.h>

#include "bench/problem.h"

/* The plant as a system of first order: y = 4 coordinates, 4 speeds. */
typedef struct ethd__plain {
  const ethd__body *body;
  const ethd__piece *piece;
  ethd__touch touch;
  bool live; /* 1: touch is worked out at every evaluation, and no events are watched */
} ethd__plain;

ethd__ode ethd__plain_ode(ethd__plain *plain);

/* A method with fixed steps (setting: the longest step, s) or with a tolerance. */
typedef struct ethd__method {
  const char *name;
  int adaptive, events;
  double settings[8]; /* end with 0 */
  /* Steps from y at t, whose rates are k1, to out; returns the largest estimated error, and k1 for the next
     step if the method has it (`fresh` 0: it doesn't). */
  double (*step)(const ethd__ode *ode, double t, double h, const double *y, const double *k1, double *out,
                 double *k_next, int *fresh);
} ethd__method;

extern const ethd__method ethd__methods[];
extern const int ethd__method_count;

/* One method at one setting, as the user of ethd__problem_play. */
typedef struct ethd__runner {
  const ethd__method *method;
  const ethd__peer_ode *peer;
  double setting, h; /* h: the length that the last step proposes for the next */
  ethd__plain plain;
  ethd__ode ode;
  void *peer_self;
} ethd__runner;

void ethd__runner_stretch(void *runner, ethd__body *body, const ethd__stretch *stretch, ethd__sim_state *state);

#endif
