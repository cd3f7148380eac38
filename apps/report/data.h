/* The taps of a table, by cell. All [main]. */
#ifndef ETHD_REPORT_DATA_H
#define ETHD_REPORT_DATA_H

#include "report/sheet.h"
#include "tap/summary.h"

#define ETHD_REPORT_CELLS 64

/* The participant of a result, and where its ticks may be. */
typedef struct ethd__who {
  uint32_t person;
  size_t row; /* of the sheet */
} ethd__who;

/* All test taps of one strategy at one speed. */
typedef struct ethd__group {
  ethd__cell cell;
  ethd__speed speed;
  ethd__who *who; /* of each result */
} ethd__group;

typedef struct ethd__data {
  ethd__sheet sheet;
  size_t *row, *first;                  /* rows of point p: row[first[p]] up to row[first[p + 1]] */
  bool borrowed;                        /* sheet, row and first are another's */
  ethd__group group[ETHD_REPORT_CELLS]; /* speeds in order of the table, strategies within */
  size_t group_count;
  const char **people; /* ids */
  size_t people_count, points, training;
} ethd__data;

/* path: a taps.csv of ethd-study; of a grid, only `point` goes into the groups. */
ETHD_MUST_CHECK ethd_status ethd__data_read(const char *path, const ethd_plant *plant, size_t point, ethd__data *out,
                                            char message[ETHD_MESSAGE_MAX]);
/* The same at another point, on the sheet of `whole`, which outlives it. */
ETHD_MUST_CHECK ethd_status ethd__data_at(const ethd__data *whole, const ethd_plant *plant, size_t point,
                                          ethd__data *out, char message[ETHD_MESSAGE_MAX]);
void ethd__data_free(ethd__data *data);

/* Copies of the groups' cells; how many. */
size_t ethd__data_cells(const ethd__data *data, ethd__cell out[ETHD_REPORT_CELLS]);

/* A figure of a tap as people read it. */
typedef struct ethd__quantity {
  const char *key, *title, *unit;
  double (*of)(const ethd__metrics *metrics);
  int digits;
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
  ETHD_QUANTITIES
};
extern const ethd__quantity ethd__quantities[ETHD_QUANTITIES];

/* Values of the valid taps that have it, and whose they are (may be NULL); out has room for cell.count. */
size_t ethd__group_values(const ethd__group *group, const ethd__quantity *quantity, double *out, uint32_t *person);

#endif
