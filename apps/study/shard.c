#include "study/shard.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "study/keep.h"
#include "text/error_text.h"
#include "text/file.h"

void ethd__shard_name(const ethd__shard *shard, char out[ETHD_SHARD_NAME_MAX]) {
  snprintf(out, ETHD_SHARD_NAME_MAX, "shard-%" PRIu32 "-of-%" PRIu32 ".sqlite", shard->index, shard->count);
}

uint64_t ethd__shard_units(const ethd__protocol *p, const ethd__shard *shard) {
  uint64_t all = (uint64_t)ethd__protocol_points(p) * p->participants;
  return (all + shard->count - shard->index) / shard->count;
}

/* A shard at work. */
typedef struct shard_work {
  ethd__folder *folder;
  ethd__desk *desk;
  const ethd__shard *shard;
  ethd__source source;
  ethd__study_store store;
  uint64_t taps;
  char *message;
} shard_work;

/* ---- a unit ---- */

static ethd_status keep(shard_work *w, size_t point, const char *id, const ethd__taken *taken) {
  const ethd__protocol *p = &w->folder->protocol;
  const ethd__turn *turn = &taken->turn;
  char name[80], words[160], below[48];
  snprintf(below, sizeof below, "taps-%" PRIu32 "-of-%" PRIu32, w->shard->index, w->shard->count);
  snprintf(name, sizeof name, "%zu-%s-%02zu-%03" PRIu32, point, id, turn->number, turn->attempt);
  snprintf(words, sizeof words, "%s %s %s", name, p->strategies.word[turn->block.strategy],
           p->speeds.word[turn->block.speed]);
  ETHD__FREED char *folder = ethd__folder_path(w->folder->path, below), *there = ethd__folder_path(folder, name);
  ethd_status status = ETHD_OK;
  if (!ethd__file_taken(there))
    status = ethd__tap_keep(folder, name, w->folder->loaded.config, taken, words, w->message);
  return status;
}

static ethd_status run_tap(shard_work *w, size_t point, const ethd__turn *turn, bool *valid) {
  ethd__taken taken;
  char id[ETHD_STUDY_ID_MAX];
  ethd_status status = w->source.tap(w->source.self, turn, &taken, w->message);
  if (status) return status;
  *valid = taken.result.metrics.reason == ETHD_TAP_OK;
  ethd__participant_id(&w->folder->protocol, turn->person, id);
  if (w->shard->record) status = keep(w, point, id, &taken);
  w->taps++;
  return status ? status : ethd__tap_put(&w->store, point, &taken, w->message);
}

/* All taps of a unit are one transaction. */
static ethd_status run_unit(shard_work *w, uint64_t unit) {
  const ethd__protocol *p = &w->folder->protocol;
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  uint32_t person = (uint32_t)(unit % p->participants);
  size_t point = (size_t)(unit / p->participants), count = ethd__order_of(p, person, blocks);
  ethd_status status = ethd__store_do(&w->store, "BEGIN", w->message);
  ethd__desk_point(w->desk, point);
  for (size_t i = 0; !status && i < count; i++) {
    ethd__turn turn = {.person = person, .number = i + 1, .block = blocks[i]};
    uint32_t valid = 0;
    bool counts = false;
    while (!status && !ethd__block_over(p, &blocks[i], turn.attempt, valid)) {
      turn.attempt++;
      status = run_tap(w, point, &turn, &counts);
      valid += !status && counts;
    }
  }
  return status ? status : ethd__store_do(&w->store, "COMMIT", w->message);
}

/* ---- all units ---- */

ethd_status ethd__shard_done(ethd__study_store *store, const ethd__protocol *p, const ethd__shard *shard,
                             uint64_t *units, char message[ETHD_MESSAGE_MAX]) {
  sqlite3_stmt *row =
      ethd__store_query(store, "SELECT count(*), coalesce(max(unit), -1), coalesce(max(unit % ?2 <> ?3), 0) FROM "
                               "(SELECT DISTINCT point * ?1 + participant - 1 AS unit FROM tap)");
  sqlite3_bind_int64(row, 1, p->participants);
  sqlite3_bind_int64(row, 2, shard->count);
  sqlite3_bind_int64(row, 3, shard->index - 1);
  bool there = ethd__store_next(row), odd = true;
  *units = there ? (uint64_t)sqlite3_column_int64(row, 0) : 0;
  if (there) {
    int64_t last = (int64_t)shard->index - 1 + ((int64_t)*units - 1) * (int64_t)shard->count;
    odd = sqlite3_column_int(row, 2) || (*units && sqlite3_column_int64(row, 1) != last);
  }
  ethd_status status = ethd__store_end(store, row, message);
  return !status && odd ? ethd__say(message, ETHD_E_SYNTAX,
                                    "%s: has rows of another shard; remove it and have it made again", store->path)
                        : status;
}

static ethd_status run_units(shard_work *w, uint64_t done, bool *over) {
  uint64_t units = ethd__shard_units(&w->folder->protocol, w->shard);
  ethd_status status = ETHD_OK;
  for (; !status && done < units && !ethd__stop; done += !status) {
    ethd__progress(done, units, "participants");
    status = run_unit(w, w->shard->index - 1 + done * w->shard->count);
  }
  ethd__progress(1, 1, "");
  *over = !status && done >= units;
  return status;
}

/* The hand of the whole simulation, which is the desk's. */
static ethd_status put_hand(shard_work *w) {
  sqlite3_stmt *insert = ethd__store_query(&w->store, "INSERT OR IGNORE INTO hand VALUES (?)");
  sqlite3_bind_text(insert, 1, ethd__hand_words[w->source.hand], -1, SQLITE_STATIC);
  return ethd__store_run(&w->store, insert, w->message);
}

ethd_status ethd__shard_run(ethd__folder *folder, ethd__desk *desk, const ethd__shard *shard, uint64_t *taps,
                            bool *over, char message[ETHD_MESSAGE_MAX]) {
  shard_work w = {
      .folder = folder, .desk = desk, .shard = shard, .source = ethd__desk_source(desk), .message = message};
  char name[ETHD_SHARD_NAME_MAX];
  uint64_t done = 0;
  *over = false;
  ethd__shard_name(shard, name);
  ethd_status status = ethd__progress_open(folder, name, true, &w.store, message);
  if (!status) status = put_hand(&w);
  if (!status) status = ethd__shard_done(&w.store, &folder->protocol, shard, &done, message);
  if (!status) status = run_units(&w, done, over);
  ethd__store_close(&w.store);
  *taps = w.taps;
  return status;
}
