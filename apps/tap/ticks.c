#include "tap/ticks.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "record/limits_event.h"
#include "record/npy_parts.h"
#include "record/recording_parts.h"
#include "text/error_text.h"
#include "text/text.h"

#define TRUTH "truth.npy"
#define LETTER_double 'f'
#define COLUMN(type, name, count, unit, brief) {#name, unit, count, offsetof(ethd_truth, name), LETTER_##type, false},
const ethd_column ethd__truth_columns[] = {ETHD_TRUTH_FIELDS(COLUMN){NULL, NULL, 0, 0, 0, false}};
#undef COLUMN

/* ---- writing ---- */

static ethd_status in_folder(const char *folder, const char *name, char **out, char *message) {
  *out = ethd__path_join(folder, name);
  return *out ? ETHD_OK : ethd__no_memory(message, folder);
}

static ethd_status said(const ethd__ticks *ticks, ethd_status status, char *message) {
  if (!status) return ETHD_OK;
  const char *failure = ethd_recording_failure(ticks->recording);
  return ethd__say(message, status, "%s", *failure ? failure : ethd_status_sentence(status));
}

ethd_status ethd__ticks_open(const char *folder, const ethd_config *config, bool replace, ethd__ticks *out,
                             char message[ETHD_MESSAGE_MAX]) {
  char *truth = NULL, unsaid[ETHD_MESSAGE_MAX];
  *out = (ethd__ticks){0};
  ethd_status status = ethd_recording_create(folder, config, replace, &out->recording, message);
  if (!status) status = in_folder(folder, TRUTH, &truth, message);
  if (!status) status = ethd_npy_create(truth, ethd__truth_columns, sizeof(ethd_truth), &out->truth, message);
  free(truth);
  if (status) (void)!ethd__ticks_close(out, unsaid);
  return status;
}

ethd_status ethd__ticks_stage(ethd__ticks *ticks, const ethd__stage *stage, char message[ETHD_MESSAGE_MAX]) {
  char detail[192];
  ethd_recording *recording = ticks->recording;
  ethd_status status = ethd_recording_event(recording, "setup", stage->law);
  for (size_t i = 0; !status && i < stage->study->gain_count; i++) {
    const ethd__gain *gain = &stage->study->gains[i];
    if (!ethd__gain_applies(stage->study, stage->law, gain)) continue;
    snprintf(detail, sizeof detail, "%s %s", gain->key, gain->value);
    status = ethd_recording_event(recording, "set", detail);
  }
  const ethd_setup *was = &stage->study->config->setup, *is = &stage->setup;
  if (!status) status = ethd__section_events(recording, &ethd__front_plane, "limits", was, is);
  if (!status && ETHD_LAW_HAS(is->transition, range))
    status = ethd__section_events(recording, &ethd__front_plane, "arm", was, is);
  snprintf(detail, sizeof detail, "%.17g %.17g", stage->heat[0], stage->heat[1]);
  if (!status && (stage->heat[0] > 0 || stage->heat[1] > 0)) status = ethd_recording_event(recording, "heat", detail);
  return said(ticks, status, message);
}

/* If it isn't empty. */
static ethd_status tell_learned(ethd_recording *recording, const double learned[ETHD_MEMORY]) {
  char text[32 * ETHD_MEMORY] = "";
  bool any = false;
  for (size_t i = 0; i < ETHD_MEMORY; i++) {
    any |= learned[i] != 0;
    snprintf(text + strlen(text), sizeof text - strlen(text), "%s%.17g", i ? " " : "", learned[i]);
  }
  return any ? ethd_recording_event(recording, "learned", text) : ETHD_OK;
}

ethd_status ethd__ticks_tap(ethd__ticks *ticks, const char *words, const ethd__stage *stage,
                            char message[ETHD_MESSAGE_MAX]) {
  const ethd__tap_rows *rows = &stage->rows;
  ethd_status status = ethd_recording_event(ticks->recording, "start", words);
  if (!status) status = tell_learned(ticks->recording, stage->learned);
  for (size_t i = 0; !status && i < rows->count; i++) status = ethd_recording_tick(ticks->recording, &rows->trace[i]);
  if (!status && (ethd_npy_append(ticks->truth, rows->truth, rows->count) || ethd_npy_flush(ticks->truth)))
    status = ethd__recording_fail(ticks->recording, TRUTH, ethd__npy_reason(ticks->truth));
  return said(ticks, status, message);
}

/* If the truth is incomplete, the recording stays unfinished too. */
ethd_status ethd__ticks_close(ethd__ticks *ticks, char message[ETHD_MESSAGE_MAX]) {
  errno = 0;
  if (ethd_npy_close(ticks->truth)) (void)!ethd__recording_fail(ticks->recording, TRUTH, errno ? errno : EIO);
  ethd_status status = ethd_recording_close(ticks->recording, message);
  *ticks = (ethd__ticks){0};
  return status;
}
