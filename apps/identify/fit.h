/* Fits a plant to evidence: starts by regression, Levenberg and Marquardt's method (cminpack) on the windows, the
   choice of a model by an information criterion, and an interval for each number. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_FIT_H
#define ETHD__APPS_IDENTIFY_FIT_H

#include "identify/shooting.h"

#define ETHD__STARTS 3

/* Fills rigid plants from which a fit may start, the likeliest first, and returns how many there are. They come from a
   regression of accelerations over spans of ticks on the commands, for a grid of delays and torque limits. `plant` has
   the numbers that aren't fitted. */
int ethd__fit_starts(const ethd__evidence *evidence, const ethd_plant *plant, ethd_plant out[ETHD__STARTS]);

/* Returns the largest commanded force at the ring, N. */
double ethd__fit_force(const ethd__evidence *evidence);

/* Minimises the squares from shooting->plant on, which becomes the best plant; returns the sum of squares, rad^2. About
   `most` evaluations at most; `what`: the word shown as progress. */
double ethd__fit_squares(ethd__shooting *shooting, int most, const char *what);

/* Fills the standard errors of the coordinates of shooting->chosen, valid for residuals that are correlated within a
   window (cluster sandwich); INFINITY for a coordinate without effect. `step`, unless it is NULL, becomes the step that
   Gauss and Newton would take from here. */
void ethd__fit_errors(ethd__shooting *shooting, double errors[ETHD__UNKNOWNS], double step[ETHD__UNKNOWNS]);

/* Returns whether one of several recordings has other masses than the first; fills its index and the relative
   difference. */
bool ethd__fit_stranger(const ethd__shooting *shooting, uint32_t *recording, double *shift);

typedef struct ethd__fit {
  ethd_plant plant;
  ethd__chosen chosen;
  double low[ETHD__UNKNOWNS], high[ETHD__UNKNOWNS]; /* intervals of 95 %; NaN: not determined, or not fitted */
  bool unseen[ETHD__UNKNOWNS];                      /* fitted, but not determined by the recordings */
  double sum;                                       /* of squares, rad^2 */
  double freedom;                                   /* number of independent residuals */
  double criterion[2];                              /* of the rigid plant, and of one with an elastic transmission */
  double simulated, seconds;                        /* simulated time of the evaluations, processor time, s */
  double force;                                     /* N: the largest command */
} ethd__fit;

/* Runs the whole fit. `plant` has the numbers that aren't fitted; `count` is the encoders', rad. The windows stay open,
   settled at the result, for the page and the picture. */
void ethd__fit_run(const ethd__evidence *evidence, const ethd_plant *plant, double count, ethd__shooting *shooting,
                   ethd__fit *out);

#endif
