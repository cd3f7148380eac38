/* The taps of a table, by cell. All [main]. */
#ifndef ETHD__APPS_REPORT_DATA_H
#define ETHD__APPS_REPORT_DATA_H

#include "report/gather.h"
#include "statistics/clusters.h"
#include "tap/people.h"

#define ETHD_REPORT_CELLS 64

/* All test taps of one strategy at one speed. */
typedef struct ethd__group {
  ethd__cell cell; /* with the person of each result */
  ethd__speed speed;
  size_t *row; /* of the sheet, of each result */
} ethd__group;

typedef struct ethd__data {
  ethd__sheet sheet;
  size_t *row, *first; /* rows of point p: row[first[p]] up to row[first[p + 1]] */
  ethd__absent absent;
  bool borrowed;                        /* sheet, row, first and absent are another's */
  ethd__group group[ETHD_REPORT_CELLS]; /* speeds in order of the table, strategies within */
  size_t group_count;
  const char **people;                             /* ids */
  size_t people_count, points, training, left_out; /* left_out: test taps of participants who aren't analysed */
} ethd__data;

/* Reads a taps.csv of ethd-study; of a grid, only `point` goes into the groups. */
ETHD_MUST_CHECK ethd_status ethd__data_read(const char *path, const ethd_plant *plant, size_t point, ethd__data *out,
                                            char message[ETHD_MESSAGE_MAX]);
/* Does the same with a sheet, which becomes the data's own. participants: a table whose column `analysed` is 0 for
   those whose taps are left out; NULL or empty: no taps are. */
ETHD_MUST_CHECK ethd_status ethd__data_of(ethd__sheet *sheet, const ethd__sheet *participants, const ethd_plant *plant,
                                          size_t point, ethd__data *out, char message[ETHD_MESSAGE_MAX]);
/* Does the same at another point, on the sheet of `whole`, which outlives it. */
ETHD_MUST_CHECK ethd_status ethd__data_at(const ethd__data *whole, const ethd_plant *plant, size_t point,
                                          ethd__data *out, char message[ETHD_MESSAGE_MAX]);
void ethd__data_free(ethd__data *data);

/* Fills copies of the groups' cells, and returns how many there are. */
size_t ethd__data_cells(const ethd__data *data, ethd__cell out[ETHD_REPORT_CELLS]);

/* A figure of a tap as people read it. */
typedef struct ethd__quantity {
  const char *key, *title, *unit;
  ethd__tap_value *of;
  int digits;
  double grain; /* in which it is counted, 0: it is continuous */
} ethd__quantity;

enum {
  ETHD_Q_V_RVO,
  ETHD_Q_V_OF,
  ETHD_Q_D_MAX,
  ETHD_Q_V_RMIN,
  ETHD_Q_DELTA_S,
  ETHD_Q_EPS,
  ETHD_Q_DELAY,
  ETHD_Q_FORCE,
  ETHD_Q_V_HAND,
  ETHD_Q_TOUCH_DEPTH,
  ETHD_Q_EPS_FELT,
  ETHD_QUANTITIES
};
extern const ethd__quantity ethd__quantities[ETHD_QUANTITIES];

/* Fills the values of the valid taps that have the quantity, and returns how many; out has room for cell.count. */
size_t ethd__group_values(const ethd__group *group, const ethd__quantity *quantity, double *out);

/* Returns the median of each person's valid taps, NaN without any; the caller frees it. */
double *ethd__group_medians(const ethd__data *data, const ethd__group *group, const ethd__quantity *quantity);

/* Fills the valid taps of one group, or of two as sides 0 and 1, which the caller frees; returns how many. */
size_t ethd__group_taps(const ethd__group *a, const ethd__group *b, const ethd__quantity *quantity, ethd__tapped **out);

#endif
