/* What the tests of numerical stress, which have analytic answers, share.

   A test measures the library's own code and compares the figure with one that it works out from a formula. Results
   with the same words make one line on the terminal, the worst of them; the CSV holds them all. */
#ifndef ETHD_TESTS_STRESS_STRESS_H
#define ETHD_TESTS_STRESS_STRESS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef enum ethd__effort { ETHD__QUICK, ETHD__NORMAL, ETHD__LONG } ethd__effort;

typedef struct ethd__stress_result {
  char what[96];
  const char *unit;
  double measured, analytic, allowed; /* allowed: the distance; a bound's is 0 */
  bool bound;                         /* 1: measured <= analytic */
  uint64_t count;                     /* results of which this is the worst */
} ethd__stress_result;

#define ETHD__STRESS_LINES 64

typedef struct ethd__stress_log {
  ethd__effort effort;
  const char *folder; /* of data for pictures; NULL: none are written */
  FILE *csv;          /* NULL: none */
  const char *test;
  uint64_t failures;
  ethd__stress_result lines[ETHD__STRESS_LINES]; /* of this test, not yet printed */
  int count;
} ethd__stress_log;

typedef struct ethd__stress {
  const char *name, *brief;
  void (*run)(ethd__stress_log *log);
} ethd__stress;

/* Logs a result that must keep |measured - analytic| <= share |analytic|. Words are printf's. */
void ethd__stress_near(ethd__stress_log *log, const char *unit, double measured, double analytic, double share,
                       const char *what, ...) __attribute__((format(printf, 6, 7)));

/* Logs a result that must keep |measured - analytic| <= distance. */
void ethd__stress_within(ethd__stress_log *log, const char *unit, double measured, double analytic, double distance,
                         const char *what, ...) __attribute__((format(printf, 6, 7)));

/* Logs a result that must keep measured <= bound. */
void ethd__stress_bound(ethd__stress_log *log, const char *unit, double measured, double bound, const char *what, ...)
    __attribute__((format(printf, 5, 6)));

/* Prints a figure without a verdict below the lines so far. */
void ethd__stress_note(ethd__stress_log *log, const char *text, ...) __attribute__((format(printf, 2, 3)));

/* Prints the lines so far. */
void ethd__stress_flush(ethd__stress_log *log);

/* Opens folder/name for writing and writes the header row; returns NULL if there is no folder, and exits if it can't.
   At most two are open at a time; a file takes its place when it is closed. */
FILE *ethd__stress_data(const ethd__stress_log *log, const char *name, const char *header);
void ethd__stress_close(FILE *data);

/* Returns the value for the effort that was asked for. */
static inline int64_t ethd__stress_pick(const ethd__stress_log *log, int64_t quick, int64_t normal, int64_t most) {
  return log->effort == ETHD__QUICK ? quick : log->effort == ETHD__NORMAL ? normal : most;
}

extern const ethd__stress ethd__stress_boundary, ethd__stress_braking, ethd__stress_viscous, ethd__stress_stop,
    ethd__stress_touch, ethd__stress_lag, ethd__stress_press, ethd__stress_creep, ethd__stress_energy, ethd__stress_arm,
    ethd__stress_parameters, ethd__stress_denormals, ethd__stress_drift, ethd__stress_inputs, ethd__stress_jitter,
    ethd__stress_map, ethd__stress_hold;

#endif
