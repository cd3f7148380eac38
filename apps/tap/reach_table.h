/* Taps on an arm in cells of a law at a speed: their table, CSV, traces of typical taps, and the sensitivity. [main] */
#ifndef ETHD__APPS_TAP_REACH_TABLE_H
#define ETHD__APPS_TAP_REACH_TABLE_H

#include <stdio.h>

#include "tap/reach.h"

typedef struct ethd__reach_cell {
  const char *law;
  const ethd__speed *speed;
  ethd__reach *taps;
  size_t count;
} ethd__reach_cell;

/* The printed figures of a cell; NaN: none. */
typedef struct ethd__reach_figures {
  size_t valid, early; /* taps */
  double early_share;  /* of all touches of a fast enough hand */
  double felt, felt_sd,
      deepest;           /* m: mean, standard deviation and largest of the plate's place at the touch, over the */
  double speed, fastest; /* valid taps; m/s: mean and largest of its absolute speed there */
} ethd__reach_figures;

/* The plan: every law at each speed, `taps` times. */
typedef struct ethd__reach_plan {
  ethd__reaches reaches;
  const char *const *laws;
  size_t law_count;
  const ethd__speed *speeds;
  size_t speed_count, taps;
} ethd__reach_plan;

/* Makes room for all cells; NULL: no memory. */
ethd__reach_cell *ethd__reach_cells_create(const ethd__reach_plan *plan);
void ethd__reach_cells_free(ethd__reach_cell *cells);

/* Fills the cells, laws outermost, and returns the error of ethd__reach_open. Ends early, with ETHD_OK, once ethd__stop
   is set. */
ETHD_MUST_CHECK ethd_status ethd__reach_cells_run(const ethd__reach_plan *plan, ethd__reach_cell *cells,
                                                  char message[ETHD_MESSAGE_MAX]);

ethd__reach_figures ethd__reach_figures_of(const ethd__reach_cell *cell);

void ethd__reach_print(FILE *file, const ethd__reach_plan *plan, const ethd__reach_cell *cells);

#define ETHD_REACH_HEADER "tap,transition,speed,seed,valid,reason,felt_m,v_plate_mps"
ETHD_MUST_CHECK ethd_status ethd__reach_write(const ethd__reach_plan *plan, const ethd__reach_cell *cells,
                                              const char *path, char message[ETHD_MESSAGE_MAX]);

/* Writes folder/LAW-SPEED.csv for every cell: the valid tap whose felt offset is nearest to the mean, run again, a row a
   tick; positions are from the wall into it. */
#define ETHD_REACH_TRACE "t_s,since_touch_s,plate_m,commanded_m,finger_m,v_plate_mps,v_commanded_mps,v_finger_mps,state"
ETHD_MUST_CHECK ethd_status ethd__reach_trace(const ethd__reach_plan *plan, const ethd__reach_cell *cells,
                                              const char *folder, char message[ETHD_MESSAGE_MAX]);

/* Runs each law at the first speed for delays, gaps and biases around the plan's, and writes a row for each. */
#define ETHD_REACH_SWEEP \
  "transition,speed,varied,value,taps,valid,early_share,felt_m,felt_sd_m,deepest_m,v_plate_mps,fastest_mps"
ETHD_MUST_CHECK ethd_status ethd__reach_sweep(const ethd__reach_plan *plan, const char *name, const char *path,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
