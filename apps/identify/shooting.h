/* The least-squares problem: what is left between measured and predicted encoders over many short windows, each of which
   begins in a state of its own. The states are fitted within (variable projection), so that only the plant's unknowns
   are left. All [main]. */
#ifndef ETHD_APPS_IDENTIFY_SHOOTING_H
#define ETHD_APPS_IDENTIFY_SHOOTING_H

#include "identify/predict.h"
#include "identify/unknowns.h"

#define ETHD__WINDOW 0.25       /* s */
#define ETHD__WINDOW_LEAST 0.03 /* s: shorter pieces are left out */

typedef struct ethd__fit_window {
  ethd__shot window;
  size_t row;                                      /* of its first residual */
  double state[ETHD__STATE_MOST];                  /* at its beginning, */
  double turn[ETHD__STATE_MOST][ETHD__STATE_MOST]; /* state = turn of what the basis sees in the residual */
  int rank;
  int64_t predicted; /* ticks so far */
} ethd__fit_window;

typedef struct ethd__shooting {
  const ethd__evidence *evidence;
  ethd__fit_window *windows;
  size_t window_count, rows; /* residuals: 2 a tick */
  size_t passed_over;        /* windows, evenly among those that are kept, when a recording is very long */
  double *basis;             /* orthonormal: ETHD__STATE_MOST * rows, of each window its vectors one after another */
  ethd_plant plant;          /* the unknowns that aren't chosen stand as here */
  ethd__chosen chosen;
  double tolerance; /* m/s, of the simulator */
} ethd__shooting;

/* Cuts the stretches into windows, at most `most`. tolerance: the simulator's. */
void ethd__shooting_open(const ethd__evidence *evidence, size_t most, double tolerance, ethd__shooting *out);
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
