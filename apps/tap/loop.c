#include "tap/loop.h"

#include <math.h>
#include <stdlib.h>

ethd_status ethd__tap_rows_room(ethd__tap_rows *rows) {
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

void ethd__tap_rows_free(ethd__tap_rows *rows) {
  free(rows->trace);
  free(rows->truth);
  *rows = (ethd__tap_rows){0};
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

ethd_status ethd__tapping_begin(ethd_sim *sim, ethd_control *control, const ethd_sim_tap *tap, const ethd__rule *rule,
                                ethd__tap_rows *rows, ethd__tapping *out) {
  *out = (ethd__tapping){.sim = sim, .control = control, .rule = rule, .rows = rows};
  out->last = ticks(ethd_path_end(&tap->path) + ETHD_TAP_LOST, rule->period);
  rows->count = 0;
  ethd_control_reset(control);
  return ethd_sim_start(sim, tap);
}

ethd_status ethd__tapping_step(ethd__tapping *t) {
  if (t->rows->count > t->last) return ETHD_STATUS_EMPTY;
  ethd_status status = ethd__tap_rows_room(t->rows);
  if (status) return status;
  ethd_trace *trace = &t->rows->trace[t->rows->count];
  ethd_truth *truth = &t->rows->truth[t->rows->count];
  tick(t->sim, t->control, trace, truth);
  if (ethd__approach_step(&t->approach, t->rule, trace, truth))
    t->last = t->rows->count + ticks(ETHD_TAP_AFTER, t->rule->period);
  t->rows->count++;
  return ETHD_OK;
}

ethd_status ethd__tap_run(ethd_sim *sim, ethd_control *control, const ethd_sim_tap *tap, const double *learned,
                          const ethd__rule *rule, ethd__tap_rows *rows) {
  ethd__tapping tapping;
  ethd_status status = ethd__tapping_begin(sim, control, tap, rule, rows, &tapping);
  ethd_control_set_memory(control, learned);
  while (!status) status = ethd__tapping_step(&tapping);
  return status < 0 ? status : ETHD_OK;
}
