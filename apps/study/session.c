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

bool ethd__block_over(const ethd__protocol *protocol, const ethd__block *block, uint32_t taken, uint32_t valid) {
  if (block->training) return taken >= protocol->training;
  return valid >= protocol->taps || taken >= protocol->attempts;
}

static ethd_status no_memory(char *message) { return ethd__no_memory(message, NULL); }

/* ---- the journal ---- */

/* Simulated sessions have no clock: the same study leaves the same bytes. */
static void now(const ethd__sitting *s, char out[32]) {
  time_t t = time(NULL);
  struct tm utc;
  *out = 0;
  if (!s->source.simulated && gmtime_r(&t, &utc)) strftime(out, 32, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

static ethd_status event(ethd__sitting *s, const char *participant, size_t number, const char *kind, const char *detail,
                         char *message) {
  char utc[32], block[24] = "", *text = NULL;
  size_t length;
  now(s, utc);
  if (number) snprintf(block, sizeof block, "%zu", number);
  FILE *file = open_memstream(&text, &length);
  if (!file) return no_memory(message);
  fprintf(file, "%s,%s,%s,%s,", utc, participant, block, kind);
  ethd__csv_put_word(file, detail);
  ethd_status status = fclose(file) ? no_memory(message) : ethd__journal_append(&s->journal, "event", text, message);
  free(text);
  return status;
}

static ethd_status damaged(const ethd__sitting *s, size_t line, char *message) {
  return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: not a line of this study", s->journal.path, line + 1);
}

/* participant, block of a row; false: of no participant of this study. */
static bool place_of(const ethd__sitting *s, const char *row, uint32_t *person, size_t *number) {
  char id[ETHD_STUDY_ID_MAX], block[8];
  if (!ethd__row_cell(&row, id, sizeof id) || !ethd__row_cell(&row, block, sizeof block)) return false;
  *person = (uint32_t)strtoul(id + 1, NULL, 10) - 1;
  *number = strtoul(block, NULL, 10);
  return id[0] == 'P' && *person < s->folder->protocol.participants && *number <= ETHD_STUDY_BLOCKS;
}

static bool take_tap(ethd__sitting *s, const char *row) {
  ethd__tap_key key;
  if (!ethd__tap_row_key(row, &key) || key.person >= s->folder->protocol.participants) return false;
  ethd__progress_of *at = &s->at[key.person][key.number - 1];
  if (key.attempt != ++at->taken) return false;
  at->valid += key.valid;
  return true;
}

static bool take_survey(ethd__sitting *s, const char *row) {
  uint32_t person;
  size_t number;
  if (!place_of(s, row, &person, &number) || !number) return false;
  s->at[person][number - 1].surveyed = true;
  return true;
}

static bool take_event(ethd__sitting *s, const char *row) {
  uint32_t person;
  size_t number;
  row += strcspn(row, ",");
  if (*row++ && strstr(row, ",abort,") && place_of(s, row, &person, &number)) s->aborted[person] = true;
  return true;
}

static ethd_status take_lines(ethd__sitting *s, char *message) {
  char begun[ETHD_SHA256_TEXT + 8];
  snprintf(begun, sizeof begun, "hash %s", s->folder->hash);
  if (!s->journal.count || strcmp(s->journal.lines[0].kind, "begin") || strcmp(s->journal.lines[0].text, begun))
    return ethd__say(message, ETHD_E_SYNTAX,
                     "%s: begun with other files than %s, config.ini, scene.scene, device.plant of now; put them back",
                     s->journal.path, ETHD_STUDY_FILE);
  for (size_t i = 1; i < s->journal.count; i++) {
    const ethd__journal_line *line = &s->journal.lines[i];
    bool taken = !strcmp(line->kind, "tap")      ? take_tap(s, line->text)
                 : !strcmp(line->kind, "survey") ? take_survey(s, line->text)
                 : !strcmp(line->kind, "event")  ? take_event(s, line->text)
                                                 : false;
    if (!taken) return damaged(s, i, message);
  }
  return ETHD_OK;
}

/* ---- opening ---- */

static ethd_status begin(ethd__sitting *s, const char *path, char *message) {
  char begun[ETHD_SHA256_TEXT + 8];
  ethd_status status = ethd__journal_create(path, &s->journal, message);
  if (status) return status;
  snprintf(begun, sizeof begun, "hash %s", s->folder->hash);
  status = ethd__journal_append(&s->journal, "begin", begun, message);
  if (status) unlink(path);
  return status;
}

/* A program that was ended before its first line has left an empty journal. */
static ethd_status go_on(ethd__sitting *s, const char *path, char *message) {
  char begun[ETHD_SHA256_TEXT + 8];
  ethd_status status = ethd__journal_open(path, &s->journal, message);
  if (status) return status;
  if (s->journal.count) return take_lines(s, message);
  snprintf(begun, sizeof begun, "hash %s", s->folder->hash);
  return ethd__journal_append(&s->journal, "begin", begun, message);
}

ethd_status ethd__sitting_open(ethd__folder *folder, ethd__sitting *out, char message[ETHD_MESSAGE_MAX]) {
  const ethd__protocol *p = &folder->protocol;
  *out = (ethd__sitting){.folder = folder, .journal = {.fd = -1}, .last = p->participants};
  if (p->participants > ETHD_STUDY_SESSION_PEOPLE)
    return ethd__say(message, ETHD_E_RANGE,
                     "%s: study.participants: found %" PRIu32
                     "; at most %u are allowed in a session, more with --simulate",
                     p->path, p->participants, ETHD_STUDY_SESSION_PEOPLE);
  out->at = calloc(p->participants, sizeof *out->at);
  out->aborted = calloc(p->participants, sizeof *out->aborted);
  if (!out->at || !out->aborted) {
    ethd__sitting_close(out);
    return no_memory(message);
  }
  char *path = ethd__folder_path(folder->path, ETHD_STUDY_JOURNAL);
  ethd_status status = access(path, F_OK) == 0 ? go_on(out, path, message) : begin(out, path, message);
  free(path);
  if (status) ethd__sitting_close(out);
  return status;
}

void ethd__sitting_close(ethd__sitting *s) {
  ethd__journal_close(&s->journal);
  free(s->at);
  free(s->aborted);
  s->at = NULL;
  s->aborted = NULL;
}

/* ---- a tap ---- */

/* Keeps the tap, unless the folder holds it already. *row: what the journal shall tell. */
static ethd_status have_tap(ethd__sitting *s, const char *folder, const char *name, const ethd__turn *turn,
                            ethd__taken *taken, char **row, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  char words[128];
  ethd_status status = p->record ? ethd__tap_kept(folder, name, row, message) : ETHD_OK;
  if (status || *row) return status;
  status = s->source.tap(s->source.self, turn, taken, message);
  if (status) return status;
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
  if (!status) status = ethd__journal_append(&s->journal, "tap", row, message);
  if (!status && !take_tap(s, row))
    status = ethd__say(message, ETHD_E_SYNTAX, "%s/%s: not the row of that tap", folder, name);
  if (!status && taken.speed)
    s->front.verdict(s->front.self, id, &taken, s->at[turn->person][turn->number - 1].valid,
                     turn->block.training ? 0 : p->taps);
  s->taps += !status;
  free(row);
  free(folder);
  return none ? ETHD_OK : status;
}

/* ---- a block ---- */

/* A device that has stopped itself goes on once somebody has seen to it. */
static ethd_status see_to_device(ethd__sitting *s, const char *id, const ethd__turn *turn, char *message) {
  const ethd__source *source = &s->source;
  const char *why;
  ethd_status status = ETHD_OK;
  while (!status && !ethd__stop && source->stopped && (why = source->stopped(source->self))) {
    status = event(s, id, turn->number, "fault", why, message);
    if (status) return status;
    if (!s->front.stopped(s->front.self, why))
      return ethd__say(message, ETHD_E_DEVICE, "the device stopped itself: %s", why);
    status = source->acknowledge(source->self, message);
    if (!status) status = event(s, id, turn->number, "acknowledged", "", message);
  }
  return status;
}

/* *go: the next tap may come. */
static ethd_status hear(ethd__sitting *s, const char *id, const ethd__turn *turn, bool *go, bool *stop, char *message) {
  static const char *const kinds[] = {[ETHD_WISH_NOTE] = "note",
                                      [ETHD_WISH_PAUSE] = "pause",
                                      [ETHD_WISH_ABORT] = "abort",
                                      [ETHD_WISH_STOP] = "wish to stop"};
  char words[ETHD_MESSAGE_MAX] = "";
  ethd__wish wish = s->front.wish(s->front.self, words);
  *go = wish == ETHD_WISH_GO && !ethd__stop;
  *stop = wish == ETHD_WISH_STOP || ethd__stop;
  if (wish == ETHD_WISH_GO) return ETHD_OK;
  s->aborted[turn->person] |= wish == ETHD_WISH_ABORT;
  return event(s, id, turn->number, kinds[wish], words, message);
}

static ethd_status run_survey(ethd__sitting *s, const char *id, const ethd__turn *turn, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  int answers[3];
  char row[160], given[16] = ",,";
  if (!s->source.simulated && s->front.survey(s->front.self, turn, answers))
    snprintf(given, sizeof given, "%d,%d,%d", answers[0], answers[1], answers[2]);
  snprintf(row, sizeof row, "%s,%zu,%s,%s,%s", id, turn->number, p->strategies.word[turn->block.strategy],
           p->speeds.word[turn->block.speed], given);
  s->at[turn->person][turn->number - 1].surveyed = true;
  return ethd__journal_append(&s->journal, "survey", row, message);
}

static ethd_status run_block(ethd__sitting *s, const char *id, ethd__turn *turn, bool *stop, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  ethd__progress_of *at = &s->at[turn->person][turn->number - 1];
  ethd_status status = ETHD_OK;
  bool go, shown = false;
  while (!status && !*stop && !s->aborted[turn->person] && !ethd__block_over(p, &turn->block, at->taken, at->valid)) {
    if (!shown) s->front.block(s->front.self, id, turn);
    shown = true;
    turn->attempt = at->taken + 1;
    go = false;
    status = see_to_device(s, id, turn, message);
    if (!status) status = hear(s, id, turn, &go, stop, message);
    if (!status && go) status = run_tap(s, id, turn, message);
  }
  bool asked = p->survey && !turn->block.training && !at->surveyed && !s->aborted[turn->person];
  return !status && !*stop && asked ? run_survey(s, id, turn, message) : status;
}

static ethd_status run_person(ethd__sitting *s, uint32_t person, bool *stop, char *message) {
  ethd__block blocks[ETHD_STUDY_BLOCKS];
  char id[ETHD_STUDY_ID_MAX];
  size_t count = ethd__order_of(&s->folder->protocol, person, blocks);
  ethd_status status = ETHD_OK;
  ethd__participant_id(&s->folder->protocol, person, id);
  for (size_t i = 0; !status && !*stop && i < count; i++) {
    ethd__turn turn = {.person = person, .number = i + 1, .block = blocks[i]};
    status = run_block(s, id, &turn, stop, message);
  }
  return status;
}

ethd_status ethd__sitting_run(ethd__sitting *s, bool *over, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  bool stop = ethd__stop;
  if (s->journal.cut) status = event(s, "", 0, "cut", "a line that had been torn", message);
  if (!status) status = event(s, "", 0, "open", "libethd " ETHD_VERSION, message);
  for (uint32_t person = s->first; !status && !stop && person < s->last; person++)
    status = run_person(s, person, &stop, message);
  *over = !status && !stop;
  if (!status) status = event(s, "", 0, *over ? "over" : "stop", "", message);
  char left[ETHD_MESSAGE_MAX];
  ethd_status written = ethd__tables_write(s->folder->path, left);
  return status ? status : written ? ethd__say(message, written, "%s", left) : ETHD_OK;
}
