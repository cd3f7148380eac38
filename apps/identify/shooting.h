/* The least-squares problem: what is left between measured and predicted encoders over many short windows, each of which
   begins in a state of its own. The states are fitted within (variable projection), so that only the plant's unknowns
   are left. All [main]. */
#ifndef ETHD_APPS_IDENTIFY_SHOOTING_H
#define ETHD_APPS_IDENTIFY_SHOOTING_H

#include <stdbool.h>

#include "identify/predict.h"
#include "identify/unknowns.h"

#define ETHD__WINDOW 0.25       /* s */
#define ETHD__WINDOW_LEAST 0.03 /* s: shorter pieces are left out */

enum { ETHD__STATES = 18, ETHD__RESIDUALS_MOST = 2 * ETHD__WINDOW_MOST };

typedef struct ethd__fit_window {
  ethd__shot window;
  size_t row; /* of its first residual */
  int rows;
  double state[ETHD__STATES];              /* at its beginning, */
  double turn[ETHD__STATES][ETHD__STATES]; /* state = turn of what the basis sees in the residual */
  int rank;
  int64_t predicted; /* ticks so far */
} ethd__fit_window;

/* A plant and a state that are tried on a window. out: its residuals, `rows` numbers. */
typedef struct ethd__trial {
  const ethd_plant *plant;
  const double *state;
  double *out;
} ethd__trial;

struct ethd__shooting;

/* What is predicted: the arm alone, or the finger that touches it. */
typedef struct ethd__fit_subject {
  int (*states)(const ethd_plant *plant);
  double (*step)(int state); /* for slopes by differences */
  /* Up to ETHD__ARMS trials of one window; those beside the first differ from it little. */
  void (*try_all)(const struct ethd__shooting *shooting, const ethd__fit_window *window, const ethd__trial *trials,
                  int count);
  /* Whether a device can be so, and the simulator run it. */
  bool (*is_possible)(const struct ethd__shooting *shooting, const ethd_plant *plant);
} ethd__fit_subject;

typedef struct ethd__shooting {
  const ethd__evidence *evidence;
  const ethd__fit_subject *subject;
  ethd__fit_window *windows;
  size_t window_count, rows; /* residuals: 2 a tick */
  size_t passed_over;        /* windows, evenly among those that are kept, when a recording is very long */
  double *basis;             /* orthonormal: ETHD__STATES * rows, of each window its vectors one after another */
  ethd_plant plant;          /* the unknowns that aren't chosen stand as here */
  ethd__chosen chosen;
  double tolerance; /* m/s, of the simulator */
} ethd__shooting;

/* Cuts the stretches into windows of the arm alone, at most `most`. tolerance: the simulator's. */
void ethd__shooting_open(const ethd__evidence *evidence, size_t most, double tolerance, ethd__shooting *out);

/* Begins with no windows; adds one of `rows` residuals; and makes ready for what follows when all are there. */
void ethd__shooting_begin(const ethd__evidence *evidence, const ethd__fit_subject *subject, double tolerance,
                          ethd__shooting *out);
ethd__fit_window *ethd__shooting_add(ethd__shooting *shooting, const ethd__shot *window, int rows);
void ethd__shooting_ready(ethd__shooting *shooting);
void ethd__shooting_close(ethd__shooting *shooting);

/* The states are found anew for this plant, and what they can explain. */
void ethd__shooting_settle(ethd__shooting *shooting);

/* rows residuals, rad, of the coordinates of shooting->chosen, with the best states near the settled ones. */
void ethd__shooting_residual(ethd__shooting *shooting, const double *coordinates, double *out);

/* Settles at these coordinates; their derivatives: rows numbers a column. */
void ethd__shooting_slopes(ethd__shooting *shooting, const double *coordinates, double *out);

/* Simulated seconds so far, of all predictions. */
double ethd__shooting_simulated(const ethd__shooting *shooting);

/* Numbers that the states take away, of `rows`. */
size_t ethd__shooting_states(const ethd__shooting *shooting);

#endif
