/* The plant alone: the torques of taps of plant n are recorded in closed loop, and every method then
   applies them to the same plant. */
#ifndef ETHD_TESTS_BENCH_PROBLEM_H
#define ETHD_TESTS_BENCH_PROBLEM_H

#include <stdbool.h>

#include "bench/ode.h"
#include "sim/body.h"

/* The time between two events: a tick, an update of the torque, a kink of the path. */
typedef struct ethd__stretch {
  double begin, end, torque[2];
  bool tick; /* 1: it begins at a tick */
  ethd__piece piece;
} ethd__stretch;

typedef struct ethd__played {
  ethd__body body;
  ethd__sim_state start;
  ethd__stretch *stretches;
  int count;
} ethd__played;

/* What a method gives: coordinates at the end of each stretch. */
typedef double ethd__mark[4];

typedef struct ethd__problem {
  ethd__played *taps;
  int tap_count, mark_count; /* of all taps */
  double duration;           /* s, of all taps */
} ethd__problem;

/* Records taps under law `offset`, half of them at the low speed, half at the high one. Exits if it can't. */
ethd__problem ethd__problem_record(int taps);
void ethd__problem_free(ethd__problem *problem);

/* Plays all taps: `stretch` moves the state through one. */
typedef void ethd__play(void *user, ethd__body *body, const ethd__stretch *stretch, ethd__sim_state *state);
void ethd__problem_play(const ethd__problem *problem, ethd__play *stretch, void *user, ethd__mark *out);

/* Returns the largest distance of ring or finger from its place in `reference`, m. */
double ethd__problem_error(const ethd__problem *problem, ethd__mark *marks, ethd__mark *reference);

#endif
