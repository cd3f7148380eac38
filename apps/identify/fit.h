/* Fits a plant to evidence: starts by regression, Levenberg and Marquardt's method (cminpack) on the windows, the
   choice of a model by an information criterion, and an interval for each number. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_FIT_H
#define ETHD__APPS_IDENTIFY_FIT_H

#include "identify/shooting.h"

#define ETHD__STARTS 3

/* Fills rigid plants from which a fit may start, the likeliest first, and returns how many there are. They come from a
   regression of accelerations over spans of ticks on the commands, for a grid of delays and torque limits. `plant` has
   the numbers that a fit leaves alone. */
int ethd__fit_starts(const ethd__evidence *evidence, const ethd_plant *plant, ethd_plant out[ETHD__STARTS]);

/* Returns the largest force that was commanded at the ring, N. */
double ethd__fit_force(const ethd__evidence *evidence);

/* Minimises the squares from shooting->plant on, which becomes the best plant; returns the sum of squares, rad^2. It
   takes about `most` evaluations at most; `what` is the word for progress. */
double ethd__fit_squares(ethd__shooting *shooting, int most, const char *what);

/* Fills the standard errors of the coordinates of shooting->chosen, which allow for residuals that depend on one
   another within a window (the cluster sandwich); INFINITY for a coordinate on which nothing depends. `step`, unless it
   is NULL, becomes the step that Gauss and Newton would take from here. */
void ethd__fit_errors(ethd__shooting *shooting, double errors[ETHD__UNKNOWNS], double step[ETHD__UNKNOWNS]);

/* Returns whether one of several recordings asks for other masses than the first; fills which one, and by what share
   they differ. */
bool ethd__fit_stranger(const ethd__shooting *shooting, uint32_t *recording, double *shift);

typedef struct ethd__fit {
  ethd_plant plant;
  ethd__chosen chosen;
  double low[ETHD__UNKNOWNS], high[ETHD__UNKNOWNS]; /* intervals of 95 %; NaN: not seen, or not asked for */
  bool unseen[ETHD__UNKNOWNS];                      /* asked for, but the recordings can't tell */
  double sum;                                       /* of squares, rad^2 */
  double freedom;                                   /* how many independent residuals it is the sum of */
  double criterion[2];                              /* of the rigid plant, and of one whose transmission gives way */
  double simulated, seconds;                        /* s that the evaluations simulated, s of processor time */
  double force;                                     /* N: the largest that was commanded */
} ethd__fit;

/* Runs the whole fit. `plant` has the numbers that aren't fitted; `count` is the encoders', rad. The windows stay open,
   settled at the result, for the page and the picture. */
void ethd__fit_run(const ethd__evidence *evidence, const ethd_plant *plant, double count, ethd__shooting *shooting,
                   ethd__fit *out);

#endif
