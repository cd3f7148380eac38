/* Reduces taps to one number for each person, with which tests within people begin. All [main]. */
#ifndef ETHD__APPS_TAP_PEOPLE_H
#define ETHD__APPS_TAP_PEOPLE_H

#include "tap/summary.h"

/* Returns a figure of a tap, NaN if the tap doesn't have it. */
typedef double ethd__tap_value(const ethd__metrics *metrics);

typedef enum ethd__person_figure {
  ETHD_PERSON_MEDIAN, /* of the person's valid taps in a cell */
  ETHD_PERSON_MEAN,
  ETHD_PERSON_MOST,     /* the largest of them */
  ETHD_PERSON_ATTEMPTS, /* the mean over all taps, valid or not */
} ethd__person_figure;

/* Returns whose tap result i is: the cell's person; in a cell without persons, finger i. */
uint32_t ethd__cell_person(const ethd__cell *cell, size_t i);

/* Fills out[p] for every person p below `people`; NaN without such a tap. A NULL cell has none. Exit 1 without
   memory. */
void ethd__people_figure(const ethd__cell *cell, ethd__tap_value *of, ethd__person_figure figure, size_t people,
                         double *out);

#endif
