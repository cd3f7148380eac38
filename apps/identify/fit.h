/* From evidence to a plant: starts by regression, Levenberg and Marquardt's method (cminpack) on the windows, the model
   by an information criterion, and how sure each number is. All [main]. */
#ifndef ETHD_APPS_IDENTIFY_FIT_H
#define ETHD_APPS_IDENTIFY_FIT_H

#include "identify/shooting.h"

#define ETHD__STARTS 3

/* Plants from which a fit may start, rigid ones, the likeliest first: accelerations over spans of ticks regressed on the
   commands for a grid of delays and torque limits. `plant` has what a fit leaves alone. Returns how many. */
int ethd__fit_starts(const ethd__evidence *evidence, const ethd_plant *plant, ethd_plant out[ETHD__STARTS]);

/* The largest force that was commanded at the ring, N. */
double ethd__fit_force(const ethd__evidence *evidence);

/* The least squares from shooting->plant on, in which it leaves the best; the sum of squares, rad^2. At most so many
   evaluations, about; `what` for progress. */
double ethd__fit_squares(ethd__shooting *shooting, int most, const char *what);

/* How sure the coordinates of shooting->chosen are: standard errors that allow for residuals which depend on one another
   within a window (the sandwich of clusters); of a coordinate that nothing depends on INFINITY. step: how far Gauss and
   Newton would go from here; NULL: nobody asks. */
void ethd__fit_errors(ethd__shooting *shooting, double errors[ETHD__UNKNOWNS], double step[ETHD__UNKNOWNS]);

/* Whether one of several recordings asks for other masses than the first: which, and by what share they differ. */
bool ethd__fit_stranger(const ethd__shooting *shooting, uint32_t *recording, double *shift);

typedef struct ethd__fit {
  ethd_plant plant;
  ethd__chosen chosen;
  double low[ETHD__UNKNOWNS], high[ETHD__UNKNOWNS]; /* each lies between them by 95 %; NaN: not seen, or not asked */
  bool unseen[ETHD__UNKNOWNS];                      /* asked, but the recordings can't tell */
  double sum;                                       /* of squares, rad^2, */
  double freedom;                                   /* of so many independent ones */
  double criterion[2];                              /* of the rigid plant and of that whose transmission gives way */
  double simulated, seconds;                        /* s of simulated time in the evaluations, s of the processor */
  double force;                                     /* N: the largest that was commanded */
} ethd__fit;

/* The whole: `plant` has what isn't fitted; count: of the encoders, rad. The windows stay open, settled at the result, for what is said and drawn of
   it. */
void ethd__fit_run(const ethd__evidence *evidence, const ethd_plant *plant, double count, ethd__shooting *shooting,
                   ethd__fit *out);

#endif
