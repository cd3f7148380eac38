/* The least-squares problem (multiple shooting): its residuals are measured minus predicted encoders over many short
   windows, each with its own initial state. The states are fitted for every plant (variable projection), so that only
   the plant's unknowns remain. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_SHOOTING_H
#define ETHD__APPS_IDENTIFY_SHOOTING_H

#include <stdbool.h>

#include "identify/predict.h"
#include "identify/unknowns.h"

#define ETHD__WINDOW 0.25       /* s */
#define ETHD__WINDOW_LEAST 0.03 /* s: shorter pieces are left out */

enum { ETHD__STATES = ETHD__STATE_MOST, ETHD__RESIDUALS_MOST = 2 * ETHD__WINDOW_MOST };

typedef struct ethd__fit_window {
  ethd__shot window;
  size_t row; /* index of its first residual */
  int rows;
  double state[ETHD__STATES];              /* at its beginning */
  double turn[ETHD__STATES][ETHD__STATES]; /* correction of the state = turn * (basis * residual) */
  int rank;
  int64_t predicted; /* ticks that were predicted so far */
} ethd__fit_window;

/* A plant and a state to try on a window; `out` becomes the residuals, `rows` numbers. */
typedef struct ethd__trial {
  const ethd_plant *plant;
  const double *state;
  double *out;
} ethd__trial;

typedef struct ethd__shooting {
  const ethd__evidence *evidence;
  ethd__fit_window *windows;
  size_t window_count, rows; /* rows: residuals of all windows */
  size_t passed_over;        /* windows of a very long recording that aren't used, spread evenly over it */
  double *basis;             /* ETHD__STATES * rows: each window's orthonormal vectors one after another */
  ethd_plant plant;          /* has the unknowns that aren't chosen */
  ethd__chosen chosen;
  double tolerance; /* m/s, the simulator's */
} ethd__shooting;

/* Cuts the passages into at most `most` windows. tolerance, m/s: the simulator's. */
void ethd__shooting_open(const ethd__evidence *evidence, size_t most, double tolerance, ethd__shooting *out);

/* Opens a problem with the windows of one recording only, starting from the states of `shooting`. */
void ethd__shooting_part(const ethd__shooting *shooting, uint32_t recording, ethd__shooting *out);

void ethd__shooting_close(ethd__shooting *shooting);

/* Finds the states and their basis again for shooting->plant. */
void ethd__shooting_settle(ethd__shooting *shooting);

/* Fills the residuals, rad, at these coordinates of shooting->chosen, with the best states near the settled ones. */
void ethd__shooting_residual(ethd__shooting *shooting, const double *coordinates, double *out);

/* Settles at these coordinates, and fills the residuals' derivatives by them: a column of `rows` numbers for each. */
void ethd__shooting_slopes(ethd__shooting *shooting, const double *coordinates, double *out);

/* Returns the simulated time of all predictions so far, s. */
double ethd__shooting_simulated(const ethd__shooting *shooting);

/* Returns the number of states of all windows, by which the degrees of freedom decrease. */
size_t ethd__shooting_states(const ethd__shooting *shooting);

/* ---- the arm's predictions in a window [in arm_alone.c] ---- */

/* Return the size of this plant's state, and the step of a state for its slope by differences. */
int ethd__arm_states(const ethd_plant *plant);
double ethd__arm_step(int state);

/* Makes up to ETHD__ARMS trials of one window; all differ little from the first. */
void ethd__arm_try_all(const ethd__shooting *shooting, const ethd__fit_window *window, const ethd__trial *trials,
                       int count);

/* Returns whether this plant is possible, and the simulator can run it. */
bool ethd__arm_is_possible(const ethd__shooting *shooting, const ethd_plant *plant);

#endif
