#include "tap/output.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "file/error_text.h"
#include "file/text.h"

#define LETTER_double 'f'
#define COLUMN(type, name, count, unit, brief) \
  {#name, unit, count, offsetof(ethd_truth, name), LETTER_##type},
const ethd_column ethd__truth_columns[] = {ETHD_TRUTH_FIELDS(COLUMN){NULL, NULL, 0, 0, 0}};
#undef COLUMN

static ethd_status in_folder(const char *folder, const char *name, char **out, char *message) {
  *out = ethd__path_join(folder, name);
  return *out ? ETHD_OK : ethd__say(message, ETHD_E_MEMORY, "%s: %s", folder,
                                    ethd_status_sentence(ETHD_E_MEMORY));
}

static ethd_status open_csv(const char *path, ethd_csv_out **out, char *message) {
  *out = ethd_csv_create(path, ETHD_TAP_HEADER, message);
  return *out ? ETHD_OK : ETHD_E_FILE;
}

static ethd_status open_recording(const char *folder, const ethd_config *config, ethd__output *out,
                                  char *message) {
  char *taps = NULL, *truth = NULL;
  ethd_status status = ethd_recording_create(folder, config, &out->recording, message);
  if (!status) status = in_folder(folder, "taps.csv", &taps, message);
  if (!status) status = open_csv(taps, &out->taps, message);
  if (!status) status = in_folder(folder, "truth.npy", &truth, message);
  if (!status)
    status = ethd_npy_create(truth, ethd__truth_columns, sizeof(ethd_truth), &out->truth, message);
  free(taps);
  free(truth);
  return status;
}

ethd_status ethd__output_open(const char *csv, const char *folder, const ethd_config *config,
                              ethd__output *out, char message[ETHD_MESSAGE_MAX]) {
  char unsaid[ETHD_MESSAGE_MAX];
  *out = (ethd__output){0};
  ethd_status status = csv ? open_csv(csv, &out->csv, message) : ETHD_OK;
  if (!status && folder) status = open_recording(folder, config, out, message);
  if (!status) return ETHD_OK;
  ethd_csv_abandon(out->csv);
  out->csv = NULL;
  (void)!ethd__output_close(out, unsaid);
  return status;
}

ethd_status ethd__output_law(ethd__output *output, const char *law, const ethd_setup *setup,
                             char message[ETHD_MESSAGE_MAX]) {
  char torque[64];
  if (!output->recording) return ETHD_OK;
  snprintf(torque, sizeof torque, "limits.torque %.17g", setup->limits.torque);
  ethd_status status = ethd_recording_event(output->recording, "setup", law);
  if (!status) status = ethd_recording_event(output->recording, "set", torque);
  return status ? ethd__say(message, status, "the recording: %s", ethd_status_sentence(status)) : ETHD_OK;
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
  const double figures[] = {m->v_rvo, m->v_of, m->d_max, m->v_rmin, m->delta_s,
                            m->eps,   m->t_rvo, m->t_of, m->peak_force};
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_row(csv);
}

static ethd_status write_ticks(ethd__output *output, const ethd__rows *rows) {
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < rows->count; i++)
    status = ethd_recording_tick(output->recording, &rows->trace[i]);
  if (!status) status = ethd_npy_append(output->truth, rows->truth, rows->count);
  return status ? status : ethd_npy_flush(output->truth);
}

static ethd_status record(ethd__output *output, const ethd__stage *stage, const char *law,
                          const ethd__speed *speed, uint64_t tap) {
  char words[128];
  snprintf(words, sizeof words, "tap %" PRIu64 " %s %s%s", tap, law, speed->word,
           speed->touchdown.never_fast ? " never that fast" : "");
  ethd_status status = ethd_recording_event(output->recording, "start", words);
  return status ? status : write_ticks(output, &stage->rows);
}

ethd_status ethd__output_tap(ethd__output *output, const ethd__stage *stage, const char *law,
                             const ethd__speed *speed, uint64_t tap, const ethd__result *result,
                             char message[ETHD_MESSAGE_MAX]) {
  if (output->csv) write_row(output->csv, stage, law, speed, tap, &result->metrics);
  if (output->taps) write_row(output->taps, stage, law, speed, tap, &result->metrics);
  ethd_status status = output->recording ? record(output, stage, law, speed, tap) : ETHD_OK;
  return status ? ethd__say(message, status, "the recording: %s", ethd_status_sentence(status)) : ETHD_OK;
}

ethd_status ethd__output_close(ethd__output *output, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK, next;
  if (output->csv) status = ethd_csv_close(output->csv, message);
  if (output->taps && (next = ethd_csv_close(output->taps, message))) status = next;
  if (output->truth && (next = ethd_npy_close(output->truth)))
    status = ethd__say(message, next, "the recording's truth.npy: %s", ethd_status_sentence(next));
  if (output->recording && (next = ethd_recording_close(output->recording)))
    status = ethd__say(message, next, "the recording: %s", ethd_status_sentence(next));
  *output = (ethd__output){0};
  return status;
}

/* ---- a trace for plots ---- */

#define TRACE_HEADER                                                                                  \
  "t_s,since_wall_s,ring_m,finger_m,hand_m,offset_wall_m,v_ring_mps,v_finger_mps,state,beta,fe_n,fd_n," \
  "pad_force_n,tau1_nm,tau2_nm"

static double along(ethd_vec n, const double v[2]) { return n.x * v[0] + n.y * v[1]; }

/* How deep a disc of this radius is behind the tangent line of the wall. */
static double depth(const ethd__study *study, const double centre[2], double radius) {
  double wall = ethd_vec_dot(study->n, study->meet) + study->config->setup.ring_radius;
  return along(study->n, centre) + radius - wall;
}

static void trace_row(ethd_csv_out *csv, const ethd__stage *stage, double finger_radius, double meeting,
                      const ethd_trace *trace, const ethd_truth *truth) {
  const ethd__study *study = stage->study;
  ethd_csv_number(csv, truth->t);
  ethd_csv_number(csv, truth->t - meeting);
  ethd_csv_number(csv, depth(study, truth->ring, stage->setup.ring_radius));
  ethd_csv_number(csv, depth(study, truth->finger, finger_radius));
  ethd_csv_number(csv, depth(study, truth->hand, finger_radius));
  ethd_csv_number(csv, trace->eps != 0 ? trace->eps : NAN);
  ethd_csv_number(csv, along(study->n, study->plant.metrics_side ? truth->motor_v : truth->ring_v));
  ethd_csv_number(csv, along(study->n, truth->finger_v));
  ethd_csv_integer(csv, trace->state);
  ethd_csv_number(csv, trace->beta);
  ethd_csv_number(csv, along(study->n, trace->fe));
  ethd_csv_number(csv, along(study->n, trace->fd));
  ethd_csv_number(csv, truth->pad_force);
  ethd_csv_number(csv, trace->tau[0]);
  ethd_csv_number(csv, trace->tau[1]);
  ethd_csv_row(csv);
}

ethd_status ethd__output_trace(const char *path, const ethd__stage *stage, const ethd__speed *speed,
                               const ethd_sim_tap *tap, char message[ETHD_MESSAGE_MAX]) {
  const ethd__rows *rows = &stage->rows;
  const ethd__rule rule = ethd__stage_rule(stage, speed);
  size_t meeting = ethd__metrics_meeting(rows, &rule);
  double t = meeting < rows->count ? rows->truth[meeting].t : NAN;
  ethd_csv_out *csv = ethd_csv_create(path, TRACE_HEADER, message);
  if (!csv) return ETHD_E_FILE;
  for (size_t i = 0; i < rows->count; i++)
    trace_row(csv, stage, tap->finger_radius, t, &rows->trace[i], &rows->truth[i]);
  return ethd_csv_close(csv, message);
}
