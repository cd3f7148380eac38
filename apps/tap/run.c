#include "tap/run.h"

#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "text/error_text.h"
#include "text/file_name.h"
#include "text/text.h"

static size_t cell_count(const ethd__tap_plan *plan) { return plan->law_count * plan->study->speed_count; }

ethd__cell *ethd__cells_create(const ethd__tap_plan *plan) {
  size_t count = cell_count(plan), speeds = plan->study->speed_count;
  ethd__cell *cells = calloc(count, sizeof *cells);
  ethd__result *results = calloc(count * plan->taps, sizeof *results);
  if (!cells || !results) {
    free(cells);
    free(results);
    return NULL;
  }
  for (size_t i = 0; i < count; i++)
    cells[i] = (ethd__cell){
        .law = plan->laws[i / speeds], .speed = &plan->study->speeds[i % speeds], .results = results + i * plan->taps};
  return cells;
}

void ethd__cells_free(ethd__cell *cells) {
  if (cells) free(cells->results);
  free(cells);
}

/* ---- running ---- */

static ethd_status check_law(const ethd__tap_plan *plan, const char *law, char *message) {
  ethd__stage stage;
  ethd_sim_tap tap;
  ethd_status status = ethd__stage_open(plan->study, law, &stage, message);
  if (status) return status;
  for (size_t i = 0; !status && i < plan->study->speed_count; i++) {
    status = ethd__stage_draw(&stage, &plan->study->speeds[i], 0, &tap);
    if (status)
      (void)ethd__say(message, status, "speed %s: the touch: %s", plan->study->speeds[i].word,
                      ethd_status_sentence(status));
  }
  ethd__stage_close(&stage);
  return status;
}

/* A key counts for the laws that have it; a key that no law has is an error. */
static ethd_status check_gain(const ethd__tap_plan *plan, const ethd__gain *gain, char *message) {
  const ethd_config *config = plan->study->config;
  ethd_setup setup = config->setup;
  for (size_t law = 0; law < plan->law_count; law++)
    if (ethd__gain_applies(plan->study, plan->laws[law], gain)) return ETHD_OK;
  ethd_status status = ethd_config_transition(config, plan->laws[0], &setup, message);
  return status ? status : ethd_config_set(config, gain->key, gain->value, &setup, message);
}

ethd_status ethd__plan_check(const ethd__tap_plan *plan, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (size_t law = 0; !status && law < plan->law_count; law++) status = check_law(plan, plan->laws[law], message);
  for (size_t i = 0; !status && i < plan->study->gain_count; i++)
    status = check_gain(plan, &plan->study->gains[i], message);
  return status;
}

static ethd_status run_cell(const ethd__tap_plan *plan, ethd__stage *stage, ethd__output *output, ethd__cell *cells,
                            size_t index, char *message) {
  ethd__cell *cell = &cells[index];
  ethd_status status = ETHD_OK;
  while (!status && cell->count < plan->taps && !ethd__stop) {
    ethd__result *result = &cell->results[cell->count];
    uint64_t tap = cell->count;
    ethd__progress(index * plan->taps + tap, cell_count(plan) * plan->taps, cell->law);
    status = ethd__stage_run(stage, cell->speed, tap, result, message);
    if (!status) status = ethd__output_tap(output, stage, cell->law, cell->speed, tap, result, message);
    cell->count += !status;
  }
  return status;
}

static ethd_status run_law(const ethd__tap_plan *plan, size_t law, ethd__output *output, ethd__cell *cells,
                           char *message) {
  ethd__stage stage;
  size_t speeds = plan->study->speed_count;
  ethd_status status = ethd__stage_open(plan->study, plan->laws[law], &stage, message);
  if (status) return status;
  status = ethd__output_law(output, &stage, message);
  for (size_t i = law * speeds; !status && i < (law + 1) * speeds && !ethd__stop; i++)
    status = run_cell(plan, &stage, output, cells, i, message);
  ethd__stage_close(&stage);
  return status;
}

ethd_status ethd__cells_run(const ethd__tap_plan *plan, ethd__output *output, ethd__cell *cells,
                            char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (size_t law = 0; !status && law < plan->law_count && !ethd__stop; law++)
    status = run_law(plan, law, output, cells, message);
  ethd__progress(1, 1, "");
  return status;
}

/* ---- typical taps ---- */

static ethd_status trace_cell(const ethd__tap_plan *plan, const char *folder, const ethd__cell *cell, char *message) {
  ethd__stage stage;
  ethd__result result;
  char name[ETHD_FILE_NAME_MAX];
  const char *words[] = {cell->law, cell->speed->word, NULL};
  ethd__cell judged = *cell; /* if the ring stops before the wall, hardly a tap is valid by the paper's rule */
  judged.by_finger = ethd__cell_stops(cell);
  uint64_t number = ethd__cell_typical(&judged);
  ethd__file_name(words, ".csv", name);
  char *path = ethd__path_join(folder, name);
  if (!path) return ethd__no_memory(message, folder);
  ethd_status status = ethd__stage_open(plan->study, cell->law, &stage, message);
  if (!status) {
    status = ethd__stage_run(&stage, cell->speed, number, &result, message);
    if (!status) {
      const ethd__view view = ethd__stage_view(&stage, cell->speed, result.finger_radius);
      status = ethd__trace_write(path, &view, &stage.rows, message);
    }
    ethd__stage_close(&stage);
  }
  free(path);
  return status;
}

ethd_status ethd__cells_trace(const ethd__tap_plan *plan, const char *folder, const ethd__cell *cells,
                              char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < cell_count(plan); i++)
    if (cells[i].count) status = trace_cell(plan, folder, &cells[i], message);
  return status;
}
