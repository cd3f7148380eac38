#include "study/session.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "ethd/ethd.h"
#include "study/keep.h"
#include "study/row.h"
#include "study/survey.h"
#include "study/tables.h"
#include "text/error_text.h"

/* ---- a tap ---- */

/* Makes the tap and keeps it, unless the folder holds it already. *row is the line for the journal. */
static ethd_status have_tap(ethd__sitting *s, const char *folder, const char *name, const ethd__turn *turn,
                            ethd__taken *taken, char **row, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  char words[128], begun[ETHD_UTC_MAX];
  ethd_status status = p->record ? ethd__tap_kept(folder, name, row, message) : ETHD_OK;
  if (status || *row) return status;
  ethd__sitting_now(s, begun);
  status = s->source.tap(s->source.self, turn, taken, message);
  if (status) return status;
  memcpy(taken->utc, begun, sizeof begun);
  *row = ethd__tap_row(p, taken);
  if (!*row) return ethd__no_memory(message, NULL);
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
  bool none = status == ETHD_STATUS_EMPTY;
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

/* ---- decisions ---- */

/* The event gets a clock if one of the hands is a person's. */
static ethd__hand_source hand_of(const ethd__session_progress *progress) {
  for (int i = 0; i < ETHD_HAND_SOURCES; i++)
    if (progress->hand[i]) return (ethd__hand_source)i;
  return ETHD_HAND_SIMULATED;
}

static ethd_status decide(ethd__sitting *s, uint32_t person, const char *event, const char *reason, char *message) {
  char id[ETHD_STUDY_ID_MAX];
  ethd_status status = ethd__progress_read(&s->journal, s->folder->hash, &s->progress, message);
  if (status) return status;
  s->source.hand = hand_of(&s->progress);
  ethd__participant_id(&s->folder->protocol, person, id);
  status = ethd__sitting_event(s, id, 0, event, reason, message);
  return status ? status : ethd__tables_write(s->folder, message);
}

ethd_status ethd__session_decide(const char *path, uint32_t person, const char *event, const char *reason,
                                 char message[ETHD_MESSAGE_MAX]) {
  ethd__folder folder;
  ethd_status status = ethd__folder_read(path, &folder, message);
  if (status) return status;
  ethd__sitting s = {.folder = &folder, .journal = {.fd = -1}};
  char *journal = ethd__folder_path(path, ETHD_STUDY_JOURNAL);
  if (person >= folder.protocol.participants)
    status = ethd__say(message, ETHD_E_RANGE, "participant %u: 1 to %u are allowed", person + 1,
                       folder.protocol.participants);
  if (!status) status = ethd__progress_begin(&folder.protocol, &s.progress, message);
  if (!status) status = ethd__journal_open(journal, &s.journal, message);
  if (!status) status = decide(&s, person, event, reason, message);
  ethd__sitting_close(&s);
  ethd__folder_close(&folder);
  free(journal);
  return status;
}
