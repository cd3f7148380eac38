#include "tap/loop.h"

#include <math.h>
#include <stdlib.h>

static ethd_status make_room(ethd__rows *rows) {
  if (rows->count < rows->room) return ETHD_OK;
  size_t room = rows->room ? 2 * rows->room : 1024;
  ethd_trace *trace = realloc(rows->trace, room * sizeof *trace);
  if (trace) rows->trace = trace;
  ethd_truth *truth = realloc(rows->truth, room * sizeof *truth);
  if (truth) rows->truth = truth;
  if (!trace || !truth) return ETHD_E_MEMORY;
  rows->room = room;
  return ETHD_OK;
}

void ethd__rows_free(ethd__rows *rows) {
  free(rows->trace);
  free(rows->truth);
  *rows = (ethd__rows){0};
}

/* The next row of a tap. A fault's status is part of the row. */
static void tick(ethd_sim *sim, ethd_control *control, ethd_trace *trace, ethd_truth *truth) {
  ethd_sense sense;
  ethd_command command;
  ethd_sim_read(sim, &sense);
  ethd_sim_truth(sim, truth);
  (void)ethd_control_step(control, &sense, &command, trace);
  ethd_sim_write(sim, &command);
}

static size_t ticks(double seconds, double period) { return (size_t)floor(seconds / period + 0.5); }

ethd_status ethd__tap_run(ethd_sim *sim, ethd_control *control, const ethd_sim_tap *tap,
                          const ethd__rule *rule, ethd__rows *rows) {
  size_t last = ticks(ethd_path_end(&tap->path) + ETHD_TAP_LOST, rule->period);
  ethd__approach approach = {0};
  rows->count = 0;
  ethd_control_reset(control);
  ethd_status status = ethd_sim_start(sim, tap);
  while (!status && rows->count <= last) {
    status = make_room(rows);
    if (status) break;
    ethd_trace *trace = &rows->trace[rows->count];
    ethd_truth *truth = &rows->truth[rows->count];
    tick(sim, control, trace, truth);
    if (ethd__approach_step(&approach, rule, trace, truth))
      last = rows->count + ticks(ETHD_TAP_AFTER, rule->period);
    rows->count++;
  }
  return status;
}
