#include "study/sitting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "text/csv.h"
#include "text/error_text.h"
#include "text/file.h"

/* ---- the journal ---- */

void ethd__sitting_now(const ethd__sitting *s, char out[ETHD_UTC_MAX]) {
  time_t t = time(NULL);
  struct tm utc;
  *out = 0;
  if (ethd__hand_is_persons(s->source.hand) && gmtime_r(&t, &utc))
    strftime(out, ETHD_UTC_MAX, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

ethd_status ethd__sitting_put(ethd__sitting *s, const char *kind, const char *text, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__journal_append(&s->journal, kind, text, message);
  if (!status && !ethd__progress_take(&s->progress, kind, text))
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: not a line of this study: %s %s", s->journal.path, kind, text);
  return status;
}

ethd_status ethd__sitting_event(ethd__sitting *s, const char *participant, size_t number, const char *event,
                                const char *detail, char message[ETHD_MESSAGE_MAX]) {
  char utc[ETHD_UTC_MAX], block[24] = "", *text = NULL;
  size_t length;
  ethd__sitting_now(s, utc);
  if (number) snprintf(block, sizeof block, "%zu", number);
  FILE *file = open_memstream(&text, &length);
  if (!file) return ethd__no_memory(message, NULL);
  fprintf(file, "%s,%s,%s,%s,", utc, participant, block, event);
  ethd__csv_put_word(file, detail);
  ethd_status status = fclose(file) ? ethd__no_memory(message, NULL) : ethd__sitting_put(s, "event", text, message);
  free(text);
  return status;
}

/* ---- opening ---- */

static ethd_status refuse_hand(const ethd__sitting *s, char *message) {
  const char *folder = s->folder->path;
  int hands = 0, whose = 0;
  for (int i = 0; i < ETHD_HAND_SOURCES; i++)
    if (s->progress.hand[i]) hands++, whose = i;
  if (hands > 1)
    return ethd__say(message, ETHD_E_ARGUMENT,
                     "%s: holds several stations' taps, of different hands; go on in their own folders and merge again",
                     folder);
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: its taps are led by a %s hand; ethd-study --resume %s%s goes on",
                   folder, ethd__hand_words[whose], folder, whose == ETHD_HAND_MOUSE ? " --screen" : "");
}

/* A program that was killed early may have left out the first lines; they are written now. */
static ethd_status take_journal(ethd__sitting *s, ethd__hand_source hand, char *message) {
  char begun[ETHD_SHA256_TEXT + 8];
  snprintf(begun, sizeof begun, "hash %s", s->folder->hash);
  ethd_status status = s->journal.count ? ethd__progress_read(&s->journal, s->folder->hash, &s->progress, message)
                                        : ethd__journal_append(&s->journal, "begin", begun, message);
  if (!status && s->journal.count < 2) status = ethd__sitting_put(s, "hand", ethd__hand_words[hand], message);
  if (status) return status;
  for (int i = 0; i < ETHD_HAND_SOURCES; i++)
    if (s->progress.hand[i] != (i == (int)hand)) return refuse_hand(s, message);
  return ETHD_OK;
}

ethd_status ethd__sitting_open(ethd__folder *folder, ethd__hand_source hand, ethd__sitting *out,
                               char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__sitting){
      .folder = folder, .journal = {.fd = -1}, .source = {.hand = hand}, .last = folder->protocol.participants};
  ethd_status status = ethd__progress_begin(&folder->protocol, &out->progress, message);
  if (status) return status;
  char *path = ethd__folder_path(folder->path, ETHD_STUDY_JOURNAL);
  status = ethd__file_taken(path) ? ethd__journal_open(path, &out->journal, message)
                                  : ethd__journal_create(path, &out->journal, message);
  free(path);
  if (!status) status = take_journal(out, hand, message);
  if (status) ethd__sitting_close(out);
  return status;
}

void ethd__sitting_close(ethd__sitting *s) {
  ethd__journal_close(&s->journal);
  ethd__progress_free(&s->progress);
}
