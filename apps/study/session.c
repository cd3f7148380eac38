#include "study/session.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "ethd/ethd.h"
#include "study/keep.h"
#include "study/row.h"
#include "text/csv.h"
#include "text/error_text.h"

static ethd_status no_memory(char *message) { return ethd__no_memory(message, NULL); }

/* ---- the journal ---- */

/* No clock is written for simulated hands, so that the same study leaves the same bytes. */
static void now(const ethd__sitting *s, char out[ETHD_UTC_MAX]) {
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
  now(s, utc);
  if (number) snprintf(block, sizeof block, "%zu", number);
  FILE *file = open_memstream(&text, &length);
  if (!file) return no_memory(message);
  fprintf(file, "%s,%s,%s,%s,", utc, participant, block, event);
  ethd__csv_put_word(file, detail);
  ethd_status status = fclose(file) ? no_memory(message) : ethd__sitting_put(s, "event", text, message);
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
  status = access(path, F_OK) == 0 ? ethd__journal_open(path, &out->journal, message)
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

/* ---- a tap ---- */

/* Makes the tap and keeps it, unless the folder holds it already. *row is the line for the journal. */
static ethd_status have_tap(ethd__sitting *s, const char *folder, const char *name, const ethd__turn *turn,
                            ethd__taken *taken, char **row, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  char words[128], begun[ETHD_UTC_MAX];
  ethd_status status = p->record ? ethd__tap_kept(folder, name, row, message) : ETHD_OK;
  if (status || *row) return status;
  now(s, begun);
  status = s->source.tap(s->source.self, turn, taken, message);
  if (status) return status;
  memcpy(taken->utc, begun, sizeof begun);
  *row = ethd__tap_row(p, taken);
  if (!*row) return no_memory(message);
  snprintf(words, sizeof words, "%s %s %s", name, p->strategies.word[turn->block.strategy],
           p->speeds.word[turn->block.speed]);
  return p->record ? ethd__tap_keep(folder, name, s->folder->loaded.config, taken, words, *row, message) : ETHD_OK;
}

static ethd_status run_tap(ethd__sitting *s, const char *id, const ethd__turn *turn, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  char name[64], *row = NULL, *folder = ethd__folder_path(s->folder->path, ETHD_STUDY_RECORDINGS);
  ethd__taken taken = {.speed = NULL};
  snprintf(name, sizeof name, "%s-%02zu-%03" PRIu32, id, turn->number, turn->attempt);
  ethd_status status = have_tap(s, folder, name, turn, &taken, &row, message);
  bool none = status == ETHD_EMPTY;
  if (!status) status = ethd__sitting_put(s, "tap", row, message);
  if (!status && taken.speed)
    s->front.verdict(s->front.self, id, &taken, s->progress.person[turn->person].at[turn->number - 1].valid,
                     turn->block.training ? 0 : p->taps);
  s->taps += !status;
  free(row);
  free(folder);
  return none ? ETHD_OK : status;
}

/* A device that has stopped itself goes on once somebody has seen to it. */
static ethd_status see_to_device(ethd__sitting *s, const char *id, const ethd__turn *turn, char *message) {
  const ethd__source *source = &s->source;
  const char *why;
  ethd_status status = ETHD_OK;
  while (!status && !ethd__stop && source->stopped && (why = source->stopped(source->self))) {
    status = ethd__sitting_event(s, id, turn->number, "fault", why, message);
    if (status) return status;
    if (!s->front.stopped(s->front.self, why))
      return ethd__say(message, ETHD_E_DEVICE, "the device stopped itself: %s", why);
    status = source->acknowledge(source->self, message);
    if (!status) status = ethd__sitting_event(s, id, turn->number, "acknowledged", "", message);
  }
  return status;
}

/* ---- what people say ---- */

/* The participant who was ended last will tap again after the others. */
static ethd_status undo(ethd__sitting *s, char *message) {
  char id[ETHD_STUDY_ID_MAX];
  if (!s->left) return ETHD_OK;
  ethd__participant_id(&s->folder->protocol, (uint32_t)(s->left - s->progress.person), id);
  s->left = NULL;
  s->undone = true;
  return ethd__sitting_event(s, id, 0, "undo", "", message);
}

/* *go: the next tap may come. */
static ethd_status hear(ethd__sitting *s, const char *id, const ethd__turn *turn, bool *go, bool *stop, char *message) {
  static const char *const kinds[ETHD_WISHES] = {[ETHD_WISH_NOTE] = "note",
                                                 [ETHD_WISH_PAUSE] = "pause",
                                                 [ETHD_WISH_ABORT] = "abort",
                                                 [ETHD_WISH_STOP] = "wish to stop"};
  char words[ETHD_MESSAGE_MAX] = "";
  ethd__wish wish = s->front.wish(s->front.self, words);
  *go = wish == ETHD_WISH_GO && !ethd__stop;
  *stop = wish == ETHD_WISH_STOP || ethd__stop;
  if (wish == ETHD_WISH_UNDO) return undo(s, message);
  if (!kinds[wish]) return ETHD_OK;
  if (wish == ETHD_WISH_ABORT) s->left = &s->progress.person[turn->person];
  return ethd__sitting_event(s, id, turn->number, kinds[wish], words, message);
}

/* Returns once the participant begins, refuses, or somebody stops the session. */
static ethd_status meet(ethd__sitting *s, const char *id, ethd__participant *who, bool *stop, char *message) {
  ethd_status status = ETHD_OK;
  ethd__wish wish = ETHD_WISH_UNDO;
  while (!status && wish == ETHD_WISH_UNDO && !ethd__stop) {
    const ethd__meeting meeting = {id, s->handed_over, who->consented, s->left != NULL};
    wish = s->front.meet(s->front.self, &meeting);
    if (wish == ETHD_WISH_UNDO) status = undo(s, message);
  }
  *stop = wish == ETHD_WISH_STOP || ethd__stop;
  s->handed_over = true;
  if (wish == ETHD_WISH_AGREE) status = ethd__sitting_event(s, id, 0, "consent", "", message);
  if (wish == ETHD_WISH_ABORT) status = ethd__sitting_event(s, id, 0, "refuse", "", message);
  return status;
}

/* ---- blocks, people ---- */

static bool block_due(const ethd__sitting *s, const ethd__turn *turn) {
  const ethd__participant *who = &s->progress.person[turn->person];
  const ethd__progress_of *at = &who->at[turn->number - 1];
  return who->standing == ETHD_STANDING_IN &&
         !ethd__block_over(&s->folder->protocol, &turn->block, at->taken, at->valid);
}

static ethd_status run_block(ethd__sitting *s, const char *id, ethd__turn *turn, bool *stop, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  ethd_status status = ETHD_OK;
  bool go, rest = p->rest && turn->number > 1 && (turn->number - 1) % p->rest == 0;
  if (block_due(s, turn)) s->front.block(s->front.self, id, turn, rest);
  while (!status && !*stop && block_due(s, turn)) {
    turn->attempt = s->progress.person[turn->person].at[turn->number - 1].taken + 1;
    go = false;
    status = see_to_device(s, id, turn, message);
    if (!status) status = hear(s, id, turn, &go, stop, message);
    if (!status && go) status = run_tap(s, id, turn, message);
  }
  return !status && !*stop && ethd__survey_due(s, turn) ? ethd__survey_run(s, id, turn, stop, message) : status;
}

static ethd_status run_person(ethd__sitting *s, uint32_t person, bool *stop, char *message) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  ethd__participant *who = &s->progress.person[person];
  char id[ETHD_STUDY_ID_MAX];
  size_t count = ethd__order_of(&s->folder->protocol, person, blocks);
  bool met = !ethd__hand_is_persons(s->source.hand);
  ethd_status status = ETHD_OK;
  ethd__participant_id(&s->folder->protocol, person, id);
  for (size_t i = 0; !status && !*stop && i < count; i++) {
    ethd__turn turn = {.person = person, .number = i + 1, .of = count, .block = blocks[i]};
    if (!block_due(s, &turn) && !ethd__survey_due(s, &turn)) continue;
    if (!met) status = meet(s, id, who, stop, message);
    met = true;
    if (!status && !*stop && who->standing == ETHD_STANDING_IN) status = run_block(s, id, &turn, stop, message);
  }
  return status;
}

ethd_status ethd__sitting_run(ethd__sitting *s, bool *over, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  bool stop = ethd__stop;
  if (s->journal.cut) status = ethd__sitting_event(s, "", 0, "cut", "a line that had been torn", message);
  if (!status) status = ethd__sitting_event(s, "", 0, "open", "libethd " ETHD_VERSION, message);
  do {
    s->undone = false;
    for (uint32_t person = s->first; !status && !stop && person < s->last; person++)
      status = run_person(s, person, &stop, message);
  } while (!status && !stop && s->undone);
  *over = !status && !stop;
  if (!status) status = ethd__sitting_event(s, "", 0, *over ? "over" : "stop", "", message);
  char left[ETHD_MESSAGE_MAX];
  ethd_status written = ethd__tables_write(s->folder, left);
  return status ? status : written ? ethd__say(message, written, "%s", left) : ETHD_OK;
}
