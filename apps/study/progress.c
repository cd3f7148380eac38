#include "study/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/row.h"
#include "text/error_text.h"

const char *const ethd__standing_words[ETHD_STANDINGS] = {"", "aborted", "refused", "withdrawn", "excluded"};

bool ethd__block_over(const ethd__protocol *protocol, const ethd__study_block *block, uint32_t taken, uint32_t valid) {
  if (block->training) return taken >= protocol->training;
  return valid >= protocol->taps || taken >= protocol->attempts;
}

bool ethd__participant_over(const ethd__session_progress *progress, uint32_t person) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  size_t count = ethd__order_of(progress->protocol, person, blocks);
  for (size_t i = 0; i < count; i++) {
    const ethd__progress_of *at = &progress->person[person].at[i];
    if (!ethd__block_over(progress->protocol, &blocks[i], at->taken, at->valid)) return false;
  }
  return true;
}

ethd_status ethd__progress_begin(const ethd__protocol *p, ethd__session_progress *out, char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__session_progress){.protocol = p};
  if (p->participants > ETHD_STUDY_SESSION_PEOPLE)
    return ethd__say(message, ETHD_E_RANGE,
                     "%s: study.participants: found %" PRIu32
                     "; at most %u are allowed in a session, more with --simulate",
                     p->path, p->participants, ETHD_STUDY_SESSION_PEOPLE);
  out->person = calloc(p->participants, sizeof *out->person);
  if (!out->person) return ethd__no_memory(message, NULL);
  for (uint32_t i = 0; i < p->participants; i++)
    for (size_t b = 0; b < ETHD_STUDY_BLOCKS; b++)
      memset(out->person[i].at[b].answer, ETHD_ANSWER_UNASKED, sizeof out->person[i].at[b].answer);
  return ETHD_OK;
}

void ethd__progress_free(ethd__session_progress *progress) {
  for (uint32_t i = 0; progress->person && i < progress->protocol->participants; i++) free(progress->person[i].reason);
  free(progress->person);
  progress->person = NULL;
  for (ethd__said *said = progress->said, *before; said; said = before) {
    before = said->before;
    free(said->words);
    free(said);
  }
  progress->said = NULL;
}

/* ---- lines ---- */

/* Reads the participant from the row's first cell and advances past it; NULL if the study has no such participant. */
static ethd__participant *person_of(ethd__session_progress *progress, const char **row) {
  char id[ETHD_STUDY_ID_MAX], again[ETHD_STUDY_ID_MAX];
  if (!ethd__row_cell(row, id, sizeof id) || id[0] != 'P') return NULL;
  unsigned long person = strtoul(id + 1, NULL, 10) - 1;
  if (person >= progress->protocol->participants) return NULL;
  ethd__participant_id(progress->protocol, (uint32_t)person, again);
  return strcmp(id, again) ? NULL : &progress->person[person];
}

/* Reads a whole number from `low` to `high` from the next cell. */
static bool take_number(const char **row, long low, long high, long *out) {
  char cell[8], *end;
  if (!ethd__row_cell(row, cell, sizeof cell)) return false;
  *out = strtol(cell, &end, 10);
  return *cell && !*end && *out >= low && *out <= high;
}

static bool take_tap(ethd__session_progress *progress, const char *row) {
  ethd__tap_key key;
  if (!ethd__tap_row_key(row, &key) || key.person >= progress->protocol->participants) return false;
  ethd__participant *person = &progress->person[key.person];
  ethd__progress_of *at = &person->at[key.number - 1];
  if (key.attempt != at->taken + 1 || (person->tapped && person->hand != key.hand)) return false;
  at->taken++;
  at->valid += key.valid;
  if (!person->tapped) memcpy(person->first, key.utc, sizeof person->first);
  memcpy(person->last, key.utc, sizeof person->last);
  person->tapped = true;
  person->hand = key.hand;
  person->taps += !key.training;
  person->valid += !key.training && key.valid;
  return true;
}

/* Returns a row's last cell without its quotes; NULL without memory. */
static char *unquoted(const char *cell) {
  char *text = strdup(*cell == '"' ? cell + 1 : cell), *to = text;
  if (!text || *cell != '"') return text;
  for (const char *from = text; *from && !(*from == '"' && from[1] != '"'); from++) {
    from += *from == '"';
    *to++ = *from;
  }
  *to = 0;
  return text;
}

static bool say(ethd__session_progress *progress, const ethd__progress_of *at, size_t question, const char *cell) {
  ethd__said *said = malloc(sizeof *said);
  if (!said) return false;
  *said = (ethd__said){at, question, unquoted(cell), progress->said};
  progress->said = said;
  return said->words != NULL;
}

const char *ethd__progress_words(const ethd__session_progress *progress, const ethd__progress_of *at, size_t question) {
  for (const ethd__said *said = progress->said; said; said = said->before)
    if (said->at == at && said->question == question) return said->words;
  return "";
}

/* The row is participant,block,question,answer; the answer is empty where the participant chose to give none. */
static bool take_answer(ethd__session_progress *progress, const char *row) {
  ethd__participant *person = person_of(progress, &row);
  long number, question, answer = ETHD_ANSWER_NONE;
  if (!person || !take_number(&row, 1, ETHD_STUDY_BLOCKS, &number) ||
      !take_number(&row, 1, (long)ethd__question_count(&progress->protocol->questionnaire), &question))
    return false;
  const ethd__question *asked = &progress->protocol->questionnaire.question[question - 1];
  ethd__progress_of *at = &person->at[number - 1];
  if (ethd__question_is_text(asked)) {
    answer = *row ? 1 : ETHD_ANSWER_NONE;
    if (!say(progress, at, (size_t)question - 1, row)) return false;
  } else if (*row && !take_number(&row, 1, (long)ethd__answer_count(asked), &answer)) {
    return false;
  }
  at->answer[question - 1] = (int16_t)answer;
  return true;
}

static bool take_survey(ethd__session_progress *progress, const char *row) {
  ethd__participant *person = person_of(progress, &row);
  long number;
  if (!person || !take_number(&row, 1, ETHD_STUDY_BLOCKS, &number)) return false;
  person->at[number - 1].surveyed = true;
  return true;
}

static bool stand(ethd__participant *person, ethd__standing standing, const char *reason) {
  free(person->reason);
  person->standing = standing;
  person->reason = unquoted(reason);
  return person->reason != NULL;
}

/* utc,participant,block,event,detail: only the fourth cell says what happened, whatever stands in the fifth. */
static bool take_event(ethd__session_progress *progress, const char *row) {
  static const struct {
    const char *event;
    ethd__standing standing;
  } kinds[] = {{"abort", ETHD_STANDING_ABORTED},    {"undo", ETHD_STANDING_IN},
               {"refuse", ETHD_STANDING_REFUSED},   {"withdraw", ETHD_STANDING_WITHDRAWN},
               {"exclude", ETHD_STANDING_EXCLUDED}, {"include", ETHD_STANDING_IN}};
  char cell[ETHD_UTC_MAX], kind[24];
  if (!ethd__row_cell(&row, cell, sizeof cell)) return false;
  if (*row == ',') return true; /* the event belongs to no participant */
  ethd__participant *person = person_of(progress, &row);
  if (!person || !ethd__row_cell(&row, cell, sizeof cell) || !ethd__row_cell(&row, kind, sizeof kind)) return false;
  person->consented |= !strcmp(kind, "consent");
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (!strcmp(kind, kinds[i].event)) return stand(person, kinds[i].standing, row);
  return true;
}

static bool take_hand(ethd__session_progress *progress, const char *word) {
  for (int i = 0; i < ETHD_HAND_SOURCES; i++)
    if (!strcmp(word, ethd__hand_words[i])) return progress->hand[i] = true;
  return false;
}

bool ethd__progress_take(ethd__session_progress *progress, const char *kind, const char *text) {
  static const struct {
    const char *kind;
    bool (*take)(ethd__session_progress *progress, const char *text);
  } kinds[] = {
      {"tap", take_tap}, {"answer", take_answer}, {"survey", take_survey}, {"event", take_event}, {"hand", take_hand}};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (!strcmp(kind, kinds[i].kind)) return kinds[i].take(progress, text);
  return false;
}

ethd_status ethd__progress_read(const ethd__journal *journal, const char *hash, ethd__session_progress *progress,
                                char message[ETHD_MESSAGE_MAX]) {
  char begun[ETHD_SHA256_TEXT + 8];
  snprintf(begun, sizeof begun, "hash %s", hash);
  if (!journal->count || strcmp(journal->lines[0].kind, "begin") || strcmp(journal->lines[0].text, begun))
    return ethd__say(message, ETHD_E_SYNTAX,
                     "%s: begun with other files than %s, config.ini, scene.scene, device.plant and movements of now; "
                     "put them back",
                     journal->path, ETHD_STUDY_FILE);
  if (journal->count > 1 && strcmp(journal->lines[1].kind, "hand"))
    return ethd__say(message, ETHD_E_SYNTAX,
                     "%s: of an earlier version, which didn't keep whose hand tapped; ethd-report still draws it, but "
                     "a new session is needed to go on",
                     journal->path);
  for (size_t i = 1; i < journal->count; i++)
    if (!ethd__progress_take(progress, journal->lines[i].kind, journal->lines[i].text))
      return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: not a line of this study", journal->path, i + 1);
  return ETHD_OK;
}
