#include "tap/output.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "text/error_text.h"
#include "text/text.h"

static ethd_status open_csv(const char *path, ethd_csv_out **out, char *message) {
  *out = ethd_csv_create(path, ETHD_TAP_HEADER, message);
  return *out ? ETHD_OK : ETHD_E_FILE;
}

static ethd_status open_ticks(const ethd__output_paths *paths, const ethd_config *config, ethd__output *out,
                              char *message) {
  const char *folder = paths->folder;
  ethd_status status = ethd__ticks_open(folder, config, paths->replace, &out->ticks, message);
  if (status) return status;
  char *taps = ethd__path_join(folder, "taps.csv");
  status = taps ? open_csv(taps, &out->taps, message) : ethd__no_memory(message, folder);
  free(taps);
  return status;
}

ethd_status ethd__output_open(const ethd__output_paths *paths, const ethd_config *config, ethd__output *out,
                              char message[ETHD_MESSAGE_MAX]) {
  char unsaid[ETHD_MESSAGE_MAX];
  *out = (ethd__output){0};
  ethd_status status = paths->csv ? open_csv(paths->csv, &out->csv, message) : ETHD_OK;
  if (!status && paths->folder) status = open_ticks(paths, config, out, message);
  if (!status) return ETHD_OK;
  ethd_csv_abandon(out->csv);
  out->csv = NULL;
  (void)!ethd__output_close(out, unsaid);
  return status;
}

ethd_status ethd__output_law(ethd__output *output, const ethd__stage *stage, char message[ETHD_MESSAGE_MAX]) {
  return output->ticks.recording ? ethd__ticks_stage(&output->ticks, stage, message) : ETHD_OK;
}

/* ---- a tap ---- */

static void write_row(ethd_csv_out *csv, const ethd__stage *stage, const char *law, const ethd__speed *speed,
                      uint64_t tap, const ethd__metrics *m) {
  char seed[24];
  snprintf(seed, sizeof seed, "%" PRIu64, stage->study->seed);
  ethd_csv_integer(csv, (int64_t)tap);
  ethd_csv_word(csv, law);
  ethd_csv_word(csv, speed->word);
  ethd_csv_word(csv, seed);
  ethd_csv_integer(csv, m->reason == ETHD_TAP_OK);
  ethd_csv_word(csv, ethd__reason_words[m->reason]);
  const double figures[] = {m->v_rvo,       m->v_of,     m->d_max,     m->v_rmin,     m->delta_s,
                            m->eps,         m->t_rvo,    m->t_of,      m->peak_force, m->v_hand,
                            m->touch_depth, m->eps_felt, m->v_of_tick, m->d_max_ring};
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_row(csv);
}

ethd_status ethd__output_tap(ethd__output *output, const ethd__stage *stage, const char *law, const ethd__speed *speed,
                             uint64_t tap, const ethd__result *result, char message[ETHD_MESSAGE_MAX]) {
  if (output->csv) write_row(output->csv, stage, law, speed, tap, &result->metrics);
  if (output->taps) write_row(output->taps, stage, law, speed, tap, &result->metrics);
  if (!output->ticks.recording) return ETHD_OK;
  char words[128];
  snprintf(words, sizeof words, "tap %" PRIu64 " %s %s%s", tap, law, speed->word,
           speed->touchdown.never_fast ? " never that fast" : "");
  return ethd__ticks_tap(&output->ticks, words, stage, message);
}

ethd_status ethd__output_close(ethd__output *output, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK, next;
  if (output->csv) status = ethd_csv_close(output->csv, message);
  if (output->taps && (next = ethd_csv_close(output->taps, message))) status = next;
  if ((next = ethd__ticks_close(&output->ticks, message))) status = next;
  *output = (ethd__output){0};
  return status;
}
