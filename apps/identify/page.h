/* Writes the result: as a page, a plant file, a picture. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_PAGE_H
#define ETHD__APPS_IDENTIFY_PAGE_H

#include <stdio.h>

#include "identify/fit.h"
#include "identify/residual.h"
#include "identify/sensing.h"

typedef struct ethd__finding {
  const ethd__evidence *evidence;
  ethd__shooting problem;
  ethd__fit fit;
  ethd__sensing sensing;
  ethd__whiteness whiteness;
  double *residual; /* problem.rows, rad */
  ethd_plant plant; /* with all numbers: fitted, found from the sensors' data, or kept */
  const char *base; /* the source of the kept numbers */
} ethd__finding;

/* Puts the fitted numbers and those of the sensors into finding->plant, which holds the kept numbers. An impossible
   number, such as a friction below 0, becomes the nearest possible one. */
void ethd__finding_plant(ethd__finding *finding);

void ethd__page_print(FILE *out, const ethd__finding *finding);

/* Writes the plant file: each number with its interval, or with a note that it was kept. */
ETHD_MUST_CHECK ethd_status ethd__page_write(const ethd__finding *finding, const char *path,
                                             char message[ETHD_MESSAGE_MAX]);

/* Writes a table of a stretch of motion and of the residual's spectrum; draws it. */
ETHD_MUST_CHECK ethd_status ethd__page_csv(const ethd__finding *finding, const char *path,
                                           char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__identify_draw(const ethd__finding *finding, const char *csv, const char *png,
                                                char message[ETHD_MESSAGE_MAX]);

/* ---- judging a plant that wasn't fitted to these recordings ---- */

typedef struct ethd__judgement {
  double step[2], ahead[2]; /* rad rms of each joint: one tick, and ETHD__AHEAD, after the last tick that was fitted */
  size_t windows;
} ethd__judgement;

#define ETHD__AHEAD 0.05 /* s */

ethd__judgement ethd__prediction_judge(const ethd__evidence *evidence, const ethd_plant *plant);

#endif
