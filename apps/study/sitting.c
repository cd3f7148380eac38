#include "study/sitting.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#include "study/keep.h"
#include "text/error_text.h"

/* ---- what happens ---- */

void ethd__sitting_now(const ethd__sitting *s, char out[ETHD_UTC_MAX]) {
  time_t t = time(NULL);
  struct tm utc;
  *out = 0;
  if (ethd__hand_is_persons(s->source.hand) && gmtime_r(&t, &utc))
    strftime(out, ETHD_UTC_MAX, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

ethd_status ethd__sitting_turn(ethd__sitting *s, uint32_t person, char message[ETHD_MESSAGE_MAX]) {
  return ethd__participant_of(&s->store, person, &s->who, message);
}

ethd_status ethd__sitting_put(ethd__sitting *s, sqlite3_stmt *insert, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__store_run(&s->store, insert, message);
  return status ? status : ethd__sitting_turn(s, s->who.person, message);
}

ethd_status ethd__sitting_event(ethd__sitting *s, ethd__about about, const char *event, const char *detail,
                                char message[ETHD_MESSAGE_MAX]) {
  char utc[ETHD_UTC_MAX];
  sqlite3_stmt *insert = ethd__store_query(
      &s->store,
      "INSERT INTO event (utc, participant, block, attempt, event, detail) VALUES (?, nullif(?, 0), nullif(?, 0), "
      "nullif(?, 0), ?, ?)");
  ethd__sitting_now(s, utc);
  sqlite3_bind_text(insert, 1, utc, -1, SQLITE_STATIC);
  sqlite3_bind_int64(insert, 2, about.participant);
  sqlite3_bind_int64(insert, 3, (int64_t)about.block);
  sqlite3_bind_int64(insert, 4, about.attempt);
  sqlite3_bind_text(insert, 5, event, -1, SQLITE_STATIC);
  sqlite3_bind_text(insert, 6, detail, -1, SQLITE_STATIC);
  return ethd__sitting_put(s, insert, message);
}

/* ---- opening ---- */

static ethd_status refuse_hand(const ethd__sitting *s, const bool hand[ETHD_HAND_SOURCES], char *message) {
  const char *folder = s->folder->path;
  int hands = 0, whose = 0;
  for (int i = 0; i < ETHD_HAND_SOURCES; i++)
    if (hand[i]) hands++, whose = i;
  if (hands > 1)
    return ethd__say(message, ETHD_E_ARGUMENT,
                     "%s: holds several stations' taps, of different hands; go on in their own folders and merge again",
                     folder);
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: its taps are led by a %s hand; ethd-study --resume %s%s goes on",
                   folder, ethd__hand_words[whose], folder, whose == ETHD_HAND_MOUSE ? " --screen" : "");
}

/* Refuses another hand than the one that led the taps so far; the first one is stored. */
static ethd_status take_hand(ethd__sitting *s, ethd__hand_source hand, char *message) {
  bool is[ETHD_HAND_SOURCES], any = false;
  ethd_status status = ethd__hands_of(&s->store, is, message);
  for (int i = 0; i < ETHD_HAND_SOURCES; i++) any |= is[i];
  if (status) return status;
  if (!any) {
    sqlite3_stmt *insert = ethd__store_query(&s->store, "INSERT INTO hand VALUES (?)");
    sqlite3_bind_text(insert, 1, ethd__hand_words[hand], -1, SQLITE_STATIC);
    return ethd__store_run(&s->store, insert, message);
  }
  for (int i = 0; i < ETHD_HAND_SOURCES; i++)
    if (is[i] != (i == (int)hand)) return refuse_hand(s, is, message);
  return ETHD_OK;
}

ethd_status ethd__sitting_open(ethd__folder *folder, ethd__hand_source hand, ethd__sitting *out,
                               char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__sitting){.folder = folder, .source = {.hand = hand}, .last = folder->protocol.participants};
  ethd_status status = ethd__progress_open(folder, ETHD_STUDY_STORE, true, &out->store, message);
  if (!status) status = take_hand(out, hand, message);
  if (!status) status = ethd__tap_remove_torn(folder, &out->store, message);
  if (!status) status = ethd__sitting_turn(out, 0, message);
  if (status) ethd__sitting_close(out);
  return status;
}

void ethd__sitting_close(ethd__sitting *s) { ethd__store_close(&s->store); }
