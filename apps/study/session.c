#include "study/session.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "clock.h"
#include "ethd/ethd.h"
#include "study/keep.h"
#include "study/sums.h"
#include "study/survey.h"
#include "study/tables.h"
#include "text/error_text.h"

/* ---- a tap ---- */

static ethd__about about(const ethd__turn *turn) { return (ethd__about){turn->person + 1, turn->number, 0}; }

static const ethd__about nothing;

/* Sends a marker at the loop's present time. */
static void mark(const ethd__sitting *s, const char *event, const ethd__turn *turn, const char *reason) {
  const ethd__source *source = &s->source;
  ethd__markers_send(s->markers, event, turn, source->now ? source->now(source->self) : ethd__clock_now(), reason);
}

/* Makes the tap, keeps its ticks, and then puts its figures into the store. */
static ethd_status have_tap(ethd__sitting *s, const char *id, const ethd__turn *turn, ethd__taken *taken,
                            char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  char name[64], words[128], begun[ETHD_UTC_MAX];
  ethd__sitting_now(s, begun);
  ethd_status status = s->source.tap(s->source.self, turn, taken, message);
  if (status == ETHD_OK || status == ETHD_STATUS_EMPTY)
    mark(s, "trial-end", turn, status ? "none" : ethd__reason_words[taken->result.metrics.reason]);
  if (status) return status;
  memcpy(taken->utc, begun, sizeof begun);
  snprintf(name, sizeof name, "%s-%02zu-%03" PRIu32, id, turn->number, turn->attempt);
  snprintf(words, sizeof words, "%s %s %s", name, p->strategies.word[turn->block.strategy],
           p->speeds.word[turn->block.speed]);
  ETHD__FREED char *folder = ethd__folder_path(s->folder->path, ETHD_STUDY_RECORDINGS);
  if (p->record) status = ethd__tap_keep(folder, name, s->folder->loaded.config, taken, words, message);
  return status ? status : ethd__tap_put(&s->store, 0, taken, message);
}

/* Shows the latest tap's result. */
static void tell(ethd__sitting *s) {
  const ethd__turn *turn = &s->latest.turn;
  const ethd__progress_of *at = &s->who.at[turn->number];
  char id[ETHD_STUDY_ID_MAX];
  ethd__participant_id(&s->folder->protocol, turn->person, id);
  s->front.verdict(s->front.self, id, &s->latest,
                   &(ethd__tally){.taken = at->taken,
                                  .valid = at->valid,
                                  .wanted = turn->block.training ? 0 : ethd__block_taps(&s->folder->protocol),
                                  .accepted = at->accepted,
                                  .rejected = at->rejected,
                                  .checked = s->checked});
}

static ethd_status run_tap(ethd__sitting *s, const char *id, const ethd__turn *turn, char *message) {
  ethd__taken taken;
  ethd_status status = have_tap(s, id, turn, &taken, message);
  if (status) return status == ETHD_STATUS_EMPTY ? ETHD_OK : status;
  s->taps++;
  s->latest = taken;
  s->checked = NULL;
  status = ethd__sitting_turn(s, turn->person, message);
  if (!status) tell(s);
  return status;
}

/* A device that has stopped itself continues once somebody has checked it. */
static ethd_status see_to_device(ethd__sitting *s, const ethd__turn *turn, char *message) {
  const ethd__source *source = &s->source;
  const char *why;
  ethd_status status = ETHD_OK;
  while (!status && !ethd__stop && source->stopped && (why = source->stopped(source->self))) {
    status = ethd__sitting_event(s, about(turn), "fault", why, message);
    if (status) return status;
    if (!s->front.stopped(s->front.self, why))
      return ethd__say(message, ETHD_E_DEVICE, "the device stopped itself: %s", why);
    status = source->acknowledge(source->self, message);
    if (!status) status = ethd__sitting_event(s, about(turn), "acknowledged", "", message);
  }
  return status;
}

/* ---- what people say ---- */

/* Accepts or rejects the latest tap, or undoes this. A finished block may then need taps again. */
static ethd_status check(ethd__sitting *s, const ethd__turn *turn, const char *event, const char *why, char *message) {
  const ethd__turn *tap = &s->latest.turn;
  if (!tap->attempt || s->latest.result.metrics.reason != ETHD_TAP_OK) return ETHD_OK;
  const ethd__about of = {tap->person + 1, tap->number, tap->attempt};
  s->checked = strcmp(event, "uncheck") ? event : NULL;
  s->again |= tap->number != turn->number;
  ethd_status status = ethd__sitting_event(s, of, event, why, message);
  if (status) return status;
  mark(s, event, tap, "-");
  tell(s);
  return ETHD_OK;
}

/* The participant who was ended last will tap again after the others. */
static ethd_status undo(ethd__sitting *s, char *message) {
  const ethd__about who = {.participant = s->left};
  if (!s->left) return ETHD_OK;
  s->left = 0;
  s->undone = true;
  return ethd__sitting_event(s, who, "undo", "", message);
}

/* *go: the next tap may begin, or, if this block is `over`, the next block. */
static ethd_status hear(ethd__sitting *s, const ethd__turn *turn, bool over, bool *go, bool *stop, char *message) {
  static const char *const kinds[ETHD_WISHES] = {[ETHD_WISH_NOTE] = "note",
                                                 [ETHD_WISH_PAUSE] = "pause",
                                                 [ETHD_WISH_ABORT] = "abort",
                                                 [ETHD_WISH_STOP] = "wish to stop"};
  char words[ETHD_MESSAGE_MAX] = "";
  ethd__wish wish = s->front.wish(s->front.self, over, words);
  *go = wish == ETHD_WISH_GO && !ethd__stop;
  *stop = wish == ETHD_WISH_STOP || ethd__stop;
  if (wish == ETHD_WISH_UNDO) return s->checked ? check(s, turn, "uncheck", "", message) : undo(s, message);
  if (wish == ETHD_WISH_ACCEPT) return check(s, turn, "accept", words, message);
  if (wish == ETHD_WISH_REJECT) return check(s, turn, "reject", words, message);
  if (!kinds[wish]) return ETHD_OK;
  if (wish == ETHD_WISH_ABORT) s->left = turn->person + 1;
  return ethd__sitting_event(s, about(turn), kinds[wish], words, message);
}

/* Returns once the participant begins, refuses, or somebody stops the session. */
static ethd_status meet(ethd__sitting *s, const char *id, bool *stop, char *message) {
  const ethd__about who = {.participant = s->who.person + 1};
  ethd_status status = ETHD_OK;
  ethd__wish wish = ETHD_WISH_UNDO;
  while (!status && wish == ETHD_WISH_UNDO && !ethd__stop) {
    const ethd__meeting meeting = {id, s->handed_over, s->who.consented, s->left != 0};
    wish = s->front.meet(s->front.self, &meeting);
    if (wish == ETHD_WISH_UNDO) status = undo(s, message);
  }
  *stop = wish == ETHD_WISH_STOP || ethd__stop;
  s->handed_over = true;
  if (wish == ETHD_WISH_AGREE) status = ethd__sitting_event(s, who, "consent", "", message);
  if (wish == ETHD_WISH_ABORT) status = ethd__sitting_event(s, who, "refuse", "", message);
  return status;
}

/* ---- blocks, people ---- */

static bool block_due(const ethd__sitting *s, const ethd__turn *turn) {
  const ethd__progress_of *at = &s->who.at[turn->number];
  return s->who.in && !ethd__block_over(&s->folder->protocol, &turn->block, at->taken, at->valid);
}

/* After the last tap people see its result, and the experimenter may reject it: then one more is needed. */
static ethd_status run_block(ethd__sitting *s, const char *id, ethd__turn *turn, bool *stop, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  ethd_status status = ETHD_OK;
  size_t every = p->rest * p->taps / ethd__block_taps(p);
  bool rest = every && turn->number > 1 && (turn->number - 1) % every == 0, left = !block_due(s, turn);
  if (!left) s->front.block(s->front.self, id, turn, rest);
  bool begun = !left;
  turn->attempt = 0;
  if (begun) mark(s, "block-begin", turn, "-");
  while (!status && !*stop && !left && s->who.in) {
    bool over = !block_due(s, turn), go = false;
    turn->attempt = s->who.at[turn->number].taken + 1;
    if (!over) status = see_to_device(s, turn, message);
    if (!status) status = hear(s, turn, over, &go, stop, message);
    if (!status && go && !over) status = run_tap(s, id, turn, message);
    left = over && go;
  }
  turn->attempt = s->who.at[turn->number].taken;
  if (begun) mark(s, "block-end", turn, "-");
  return !status && !*stop && ethd__survey_due(s, turn) ? ethd__survey_run(s, id, turn, stop, message) : status;
}

static ethd_status run_person(ethd__sitting *s, uint32_t person, bool *stop, char *message) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  char id[ETHD_STUDY_ID_MAX];
  size_t count = ethd__order_of(&s->folder->protocol, person, blocks);
  bool met = !ethd__hand_is_persons(s->source.hand);
  ethd_status status = ethd__sitting_turn(s, person, message);
  ethd__participant_id(&s->folder->protocol, person, id);
  s->latest = (ethd__taken){.turn = {.attempt = 0}};
  s->checked = NULL;
  do {
    s->again = false;
    for (size_t i = 0; !status && !*stop && i < count + 2 && !(i > count && s->again); i++) {
      bool taps = i >= 1 && i <= count; /* or only questions, before and after */
      ethd__turn turn = {.person = person, .number = i, .of = count, .block = blocks[taps ? i - 1 : 0]};
      if (!(taps && block_due(s, &turn)) && !ethd__survey_due(s, &turn)) continue;
      if (!met) status = meet(s, id, stop, message);
      met = true;
      if (status || *stop || !s->who.in) continue;
      status = taps ? run_block(s, id, &turn, stop, message) : ethd__survey_run(s, id, &turn, stop, message);
    }
  } while (!status && !*stop && s->again);
  return status;
}

/* The store is closed before the sums are computed, because it has one until then. */
static ethd_status export(ethd__sitting *s, char *message) {
  ethd_status status = ethd__tables_write(s->folder, &s->store, message);
  ethd__store_close(&s->store);
  return status ? status : ethd__sums_write(s->folder->path, message);
}

ethd_status ethd__sitting_run(ethd__sitting *s, bool *over, char message[ETHD_MESSAGE_MAX]) {
  bool stop = ethd__stop;
  ethd_status status = ethd__sitting_event(s, nothing, "open", "libethd " ETHD_VERSION, message);
  do {
    s->undone = false;
    for (uint32_t person = s->first; !status && !stop && person < s->last; person++)
      status = run_person(s, person, &stop, message);
  } while (!status && !stop && s->undone);
  *over = !status && !stop;
  if (!status) status = ethd__sitting_event(s, nothing, *over ? "over" : "stop", "", message);
  char left[ETHD_MESSAGE_MAX];
  ethd_status written = export(s, left);
  return status ? status : written ? ethd__say(message, written, "%s", left) : ETHD_OK;
}

/* ---- decisions ---- */

/* The event gets a clock if one of the hands is a person's. */
static ethd_status decide(ethd__sitting *s, ethd__about about, const char *event, const char *reason, char *message) {
  bool is[ETHD_HAND_SOURCES];
  ethd_status status = ethd__hands_of(&s->store, is, message);
  int hand = 0;
  while (hand < ETHD_HAND_SIMULATED && !is[hand]) hand++;
  s->source.hand = (ethd__hand_source)hand;
  if (!status) status = ethd__sitting_event(s, about, event, reason, message);
  return status ? status : export(s, message);
}

/* Only a valid tap can be accepted or rejected. */
static ethd_status find_tap(ethd__study_store *store, ethd__about about, char *message) {
  sqlite3_stmt *row =
      ethd__store_query(store, "SELECT valid, reason FROM tap WHERE participant = ? AND block = ? AND attempt = ?");
  sqlite3_bind_int64(row, 1, about.participant);
  sqlite3_bind_int64(row, 2, (int64_t)about.block);
  sqlite3_bind_int64(row, 3, about.attempt);
  bool there = ethd__store_next(row), valid = there && sqlite3_column_int(row, 0);
  char what[64] = "isn't in this session";
  if (there) snprintf(what, sizeof what, "isn't valid (%.20s)", ethd__store_text(row, 1));
  ethd_status status = ethd__store_end(store, row, message);
  if (status || valid) return status;
  return ethd__say(message, ETHD_E_RANGE, "participant %u, block %zu, attempt %u: the tap %s; a valid one is allowed",
                   about.participant, about.block, about.attempt, what);
}

ethd_status ethd__session_decide(const char *path, ethd__about about, const char *event, const char *reason,
                                 char message[ETHD_MESSAGE_MAX]) {
  ethd__folder folder;
  ethd_status status = ethd__folder_read(path, &folder, message);
  if (status) return status;
  ethd__sitting s = {.folder = &folder};
  if (folder.simulated)
    status = ethd__say(message, ETHD_E_ARGUMENT, "%s: holds a simulation, whose participants all stay", path);
  else if (about.participant > folder.protocol.participants)
    status = ethd__say(message, ETHD_E_RANGE, "participant %u: 1 to %u are allowed", about.participant,
                       folder.protocol.participants);
  if (!status) status = ethd__progress_open(&folder, ETHD_STUDY_STORE, true, &s.store, message);
  if (!status && about.attempt) status = find_tap(&s.store, about, message);
  if (!status) status = decide(&s, about, event, reason, message);
  ethd__sitting_close(&s);
  ethd__folder_close(&folder);
  return status;
}
