#include "study/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "text/error_text.h"

bool ethd__block_over(const ethd__protocol *protocol, const ethd__study_block *block, uint32_t taken, uint32_t valid) {
  if (block->training) return taken >= protocol->training;
  return valid >= ethd__block_taps(protocol) || taken >= ethd__block_attempts(protocol);
}

/* ---- a participant ---- */

static ethd_status read_blocks(ethd__study_store *store, ethd__participant *who, char *message) {
  sqlite3_stmt *row = ethd__store_query(
      store, "SELECT block, count(*), sum(valid AND checked IS NOT 'rejected'), 0, "
             "sum(checked IS 'accepted'), sum(checked IS 'rejected') FROM (SELECT block, valid, " ETHD_STUDY_CHECKED
             " AS checked FROM tap WHERE point = 0 AND participant = ?1) GROUP BY block "
             "UNION ALL SELECT block, 0, 0, 1, 0, 0 FROM survey WHERE participant = ?1");
  sqlite3_bind_int64(row, 1, who->person + 1);
  while (ethd__store_next(row)) {
    int number = sqlite3_column_int(row, 0);
    if (number < 0 || number > ETHD_STUDY_BLOCKS + 1) continue;
    ethd__progress_of *at = &who->at[number];
    at->taken += (uint32_t)sqlite3_column_int64(row, 1);
    at->valid += (uint32_t)sqlite3_column_int64(row, 2);
    at->surveyed |= sqlite3_column_int(row, 3);
    at->accepted += (uint32_t)sqlite3_column_int64(row, 4);
    at->rejected += (uint32_t)sqlite3_column_int64(row, 5);
  }
  return ethd__store_end(store, row, message);
}

static ethd_status read_events(ethd__study_store *store, ethd__participant *who, char *message) {
  sqlite3_stmt *row =
      ethd__store_query(store, "SELECT coalesce((SELECT event IN ('undo', 'include') FROM event WHERE participant = ?1 "
                               "AND event IN " ETHD_STUDY_DECISIONS " ORDER BY id DESC LIMIT 1), 1),"
                               "EXISTS (SELECT 1 FROM event WHERE participant = ?1 AND event = 'consent')");
  sqlite3_bind_int64(row, 1, who->person + 1);
  if (ethd__store_next(row)) {
    who->in = sqlite3_column_int(row, 0);
    who->consented = sqlite3_column_int(row, 1);
  }
  return ethd__store_end(store, row, message);
}

ethd_status ethd__participant_of(ethd__study_store *store, uint32_t person, ethd__participant *out,
                                 char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__participant){.person = person};
  ethd_status status = read_blocks(store, out, message);
  return status ? status : read_events(store, out, message);
}

ethd_status ethd__said_of(ethd__study_store *store, uint32_t person, size_t block, ethd__said *out,
                          char message[ETHD_MESSAGE_MAX]) {
  sqlite3_stmt *row =
      ethd__store_query(store, "SELECT question, number, words FROM answer WHERE participant = ? AND block = ?");
  memset(out, 0, sizeof *out);
  for (size_t i = 0; i < ETHD_STUDY_QUESTIONS; i++) out->number[i] = ETHD_ANSWER_UNASKED;
  sqlite3_bind_int64(row, 1, person + 1);
  sqlite3_bind_int64(row, 2, (int64_t)block);
  while (ethd__store_next(row)) {
    int question = sqlite3_column_int(row, 0);
    if (question < 1 || question > ETHD_STUDY_QUESTIONS) continue;
    out->number[question - 1] = (int16_t)sqlite3_column_int(row, 1);
    snprintf(out->words[question - 1], ETHD_MESSAGE_MAX, "%s", ethd__store_text(row, 2));
  }
  return ethd__store_end(store, row, message);
}

/* ---- all of it ---- */

ethd_status ethd__hands_of(ethd__study_store *store, bool out[ETHD_HAND_SOURCES], char message[ETHD_MESSAGE_MAX]) {
  sqlite3_stmt *row = ethd__store_query(store, "SELECT word FROM hand");
  memset(out, 0, ETHD_HAND_SOURCES * sizeof *out);
  while (ethd__store_next(row))
    for (int i = 0; i < ETHD_HAND_SOURCES; i++) out[i] |= !strcmp(ethd__store_text(row, 0), ethd__hand_words[i]);
  return ethd__store_end(store, row, message);
}

/* SQL that finds rows of a participant, a block or a point that the study lacks; a non-integer cell counts too. */
#define BEYOND(table, first, last) \
  "EXISTS (SELECT 1 FROM " table " WHERE participant NOT BETWEEN 1 AND ?1 OR block NOT BETWEEN " first " AND " last ")"

static const char odd_rows[] = "SELECT " BEYOND("tap", "1", "?2") " OR " BEYOND("answer", "0", "?2 + 1") " OR " BEYOND(
    "survey", "0",
    "?2 + 1") " OR " BEYOND("event", "1",
                            "?2") " OR EXISTS (SELECT 1 FROM tap WHERE point NOT BETWEEN 0 AND ?3)"
                                  " OR EXISTS (SELECT 1 FROM tap GROUP BY point, participant, block HAVING "
                                  "max(attempt) <> count(*) OR "
                                  "min(attempt) <> 1)"
                                  " OR EXISTS (SELECT 1 FROM event WHERE attempt NOTNULL AND NOT EXISTS (SELECT 1 FROM "
                                  "tap WHERE point = 0 "
                                  "AND valid AND tap.participant = event.participant AND tap.block = event.block AND "
                                  "tap.attempt = "
                                  "event.attempt))"
                                  " OR EXISTS (SELECT 1 FROM tap GROUP BY participant HAVING min(hand) <> max(hand))"
                                  " OR EXISTS (SELECT 1 FROM answer WHERE question NOT BETWEEN 1 AND 9 OR number NOT "
                                  "BETWEEN 0 AND 9)";

/* A question's answers are numbered up to its own last one; a missing question has none. */
static ethd_status check_answers(ethd__study_store *store, const ethd__protocol *p, size_t blocks, bool *odd,
                                 char *message) {
  const size_t first[ETHD_ASKINGS] = {0, 1, blocks + 1}, last[ETHD_ASKINGS] = {0, blocks, blocks + 1};
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && !*odd && i < ETHD_ASKINGS * ETHD_STUDY_QUESTIONS; i++) {
    size_t when = i / ETHD_STUDY_QUESTIONS, number = i % ETHD_STUDY_QUESTIONS;
    const ethd__question *asked = &p->questionnaire.question[when][number];
    int64_t most = !asked->text ? -1 : ethd__question_is_text(asked) ? 1 : (int64_t)ethd__answer_count(asked);
    sqlite3_stmt *row =
        ethd__store_query(store, "SELECT 1 FROM answer WHERE block BETWEEN ? AND ? AND question = ? AND number > ?");
    sqlite3_bind_int64(row, 1, (int64_t)first[when]);
    sqlite3_bind_int64(row, 2, (int64_t)last[when]);
    sqlite3_bind_int64(row, 3, (int64_t)number + 1);
    sqlite3_bind_int64(row, 4, most);
    *odd = ethd__store_next(row);
    status = ethd__store_end(store, row, message);
  }
  return status;
}

static ethd_status check(ethd__study_store *store, const ethd__protocol *p, char *message) {
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  sqlite3_stmt *row = ethd__store_query(store, odd_rows);
  sqlite3_bind_int64(row, 1, p->participants);
  size_t count = ethd__order_of(p, 0, blocks);
  sqlite3_bind_int64(row, 2, (int64_t)count);
  sqlite3_bind_int64(row, 3, (int64_t)ethd__protocol_points(p) - 1);
  bool odd = ethd__store_next(row) && sqlite3_column_int(row, 0);
  ethd_status status = ethd__store_end(store, row, message);
  if (!status) status = check_answers(store, p, count, &odd, message);
  return !status && odd ? ethd__say(message, ETHD_E_SYNTAX, "%s: has rows that aren't of this study", store->path)
                        : status;
}

ethd_status ethd__progress_open(const ethd__folder *folder, const char *name, bool write, ethd__study_store *out,
                                char message[ETHD_MESSAGE_MAX]) {
  const ethd__protocol *p = &folder->protocol;
  *out = ETHD_STORE_NONE;
  if (!folder->simulated && p->participants > ETHD_STUDY_SESSION_PEOPLE)
    return ethd__say(message, ETHD_E_RANGE,
                     "%s: study.participants: found %" PRIu32
                     "; at most %u are allowed in a session, more with --simulate",
                     p->path, p->participants, ETHD_STUDY_SESSION_PEOPLE);
  ETHD__FREED char *path = ethd__folder_path(folder->path, name);
  ethd_status status = (write ? ethd__store_open : ethd__store_read)(path, folder->hash, out, message);
  if (!status) status = check(out, p, message);
  if (status) ethd__store_close(out);
  return status;
}
