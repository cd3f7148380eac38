#include "study/shard.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "cli/cli.h"
#include "study/columns.h"
#include "study/keep.h"
#include "study/progress.h"
#include "study/row.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

/* ---- names ---- */

#define HASH_DIGITS 12

static char *had(char *text, int length) {
  if (length < 0) ethd__fail_memory();
  return text;
}

uint64_t ethd__unit_count(const ethd__protocol *protocol) {
  return (uint64_t)ethd__protocol_points(protocol) * protocol->participants;
}

char *ethd__shard_path(const ethd__folder *folder, const ethd__shard *shard, const char *suffix) {
  char *path = NULL;
  int length =
      asprintf(&path, "%s/shard-%" PRIu32 "-of-%" PRIu32 "%s", folder->path, shard->index, shard->count, suffix);
  return had(path, length);
}

char *ethd__unit_prefix(const ethd__folder *folder, uint64_t unit) {
  char id[ETHD_STUDY_ID_MAX], *prefix = NULL;
  uint64_t people = folder->protocol.participants;
  ethd__participant_id(&folder->protocol, (uint32_t)(unit % people), id);
  int length = asprintf(&prefix, "%.*s,%" PRIu64 ",%s,", HASH_DIGITS, folder->hash, unit / people, id);
  return had(prefix, length);
}

/* ---- a shard at work ---- */

/* A shard at work. */
typedef struct shard_work {
  ethd__folder *folder;
  ethd__desk *desk;
  const ethd__shard *shard;
  ethd__source source;
  FILE *file; /* NAME.part */
  char *path;
  uint64_t taps;
  char *message;
} shard_work;

static ethd_status refuse(const shard_work *w, const char *path) {
  return ethd__say(w->message, ETHD_E_FILE, "%s: %s", path, strerror(errno ? errno : EIO));
}

/* ---- a unit ---- */

static ethd_status keep(shard_work *w, size_t point, const char *id, const ethd__taken *taken, const char *row) {
  const ethd__protocol *p = &w->folder->protocol;
  const ethd__turn *turn = &taken->turn;
  char name[80], words[160], below[48];
  snprintf(below, sizeof below, "taps-%" PRIu32 "-of-%" PRIu32, w->shard->index, w->shard->count);
  snprintf(name, sizeof name, "%zu-%s-%02zu-%03" PRIu32, point, id, turn->number, turn->attempt);
  snprintf(words, sizeof words, "%s %s %s", name, p->strategies.word[turn->block.strategy],
           p->speeds.word[turn->block.speed]);
  char *folder = ethd__folder_path(w->folder->path, below), *there = ethd__folder_path(folder, name);
  ethd_status status = ETHD_OK;
  if (!ethd__file_taken(there))
    status = ethd__tap_keep(folder, name, w->folder->loaded.config, taken, words, row, w->message);
  free(there);
  free(folder);
  return status;
}

static ethd_status run_tap(shard_work *w, size_t point, const ethd__turn *turn, bool *valid) {
  const ethd__protocol *p = &w->folder->protocol;
  ethd__taken taken;
  char id[ETHD_STUDY_ID_MAX];
  ethd_status status = w->source.tap(w->source.self, turn, &taken, w->message);
  char *row = status ? NULL : ethd__tap_row(p, &taken);
  if (status) return status;
  if (!row) return ethd__no_memory(w->message, NULL);
  *valid = taken.result.metrics.reason == ETHD_TAP_OK;
  ethd__participant_id(p, turn->person, id);
  if (w->shard->record) status = keep(w, point, id, &taken, row);
  fprintf(w->file, "%.12s,%zu,%s", w->folder->hash, point, row);
  for (size_t i = 0; i < p->axis_count; i++) fprintf(w->file, ",%s", ethd__protocol_value(p, point, i));
  putc('\n', w->file);
  free(row);
  w->taps++;
  return status;
}

static ethd_status run_unit(shard_work *w, uint64_t unit) {
  const ethd__protocol *p = &w->folder->protocol;
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  uint32_t person = (uint32_t)(unit % p->participants);
  size_t point = (size_t)(unit / p->participants), count = ethd__order_of(p, person, blocks);
  ethd_status status = ETHD_OK;
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
  return status;
}

/* ---- going on ---- */

/* Counts the complete units at the start of the text; the last one doesn't count, because it may be cut off. */
static ethd_status units_of(const shard_work *w, const char *text, size_t length, uint64_t *units, size_t *good) {
  char *header = ethd__simulation_header(&w->folder->protocol);
  size_t n = strlen(header);
  bool same = length > n && !memcmp(text, header, n) && text[n] == '\n';
  free(header);
  *units = 0;
  *good = 0;
  if (length <= n) return ETHD_OK; /* ended before its first unit */
  size_t at = n + 1;
  uint64_t unit = w->shard->index - 1, all = ethd__unit_count(&w->folder->protocol);
  while (same && at < length && unit < all) {
    char *prefix = ethd__unit_prefix(w->folder, unit);
    size_t begin = at, p = strlen(prefix);
    while (at < length && length - at >= p && !memcmp(text + at, prefix, p)) {
      const char *end = memchr(text + at, '\n', length - at);
      at = end ? (size_t)(end - text) + 1 : length;
    }
    free(prefix);
    if (at == begin) break;
    *good = begin;
    unit += w->shard->count;
    ++*units;
  }
  *units -= *units > 0;
  return same ? ETHD_OK
              : ethd__say(w->message, ETHD_E_SYNTAX, "%s: of another study; remove it to begin anew", w->path);
}

static ethd_status cut(shard_work *w, uint64_t *units) {
  char *text, *header;
  size_t length, good;
  ethd_status status = ethd_text_read(w->path, (size_t)1 << 34, &text, &length, w->message);
  if (!status) status = units_of(w, text, length, units, &good);
  free(text);
  if (status) return status;
  if (ftruncate(fileno(w->file), (off_t)good) != 0 || fseek(w->file, 0, SEEK_END) != 0) return refuse(w, w->path);
  if (good) return ETHD_OK;
  header = ethd__simulation_header(&w->folder->protocol);
  fprintf(w->file, "%s\n", header);
  free(header);
  return ETHD_OK;
}

static ethd_status open_part(shard_work *w, uint64_t *units) {
  int fd = ethd__file_edit(w->path, true, w->message);
  if (fd < 0) return ETHD_E_FILE;
  w->file = fdopen(fd, "r+");
  if (!w->file) return refuse(w, w->path);
  if (flock(fd, LOCK_EX | LOCK_NB) != 0)
    return ethd__say(w->message, ETHD_E_FILE, "%s: another program is at work on it", w->path);
  return cut(w, units);
}

/* ---- all units ---- */

static ethd_status run_units(shard_work *w, uint64_t done, bool *over) {
  uint64_t all = ethd__unit_count(&w->folder->protocol);
  ethd_status status = ETHD_OK;
  uint64_t unit = w->shard->index - 1 + done * w->shard->count;
  for (; !status && unit < all && !ethd__stop; unit += w->shard->count) {
    ethd__progress(unit, all, "participants");
    status = run_unit(w, unit);
    if (!status && ferror(w->file)) status = refuse(w, w->path);
  }
  ethd__progress(1, 1, "");
  *over = !status && unit >= all;
  return status;
}

static ethd_status finish(shard_work *w, const char *final, bool over) {
  bool failed = fflush(w->file) != 0 || (over && fsync(fileno(w->file)) != 0);
  if (!failed && over) failed = ethd__file_move(w->path, final) != 0;
  return failed ? refuse(w, w->path) : ETHD_OK;
}

ethd_status ethd__shard_run(ethd__folder *folder, ethd__desk *desk, const ethd__shard *shard, uint64_t *taps,
                            bool *over, char message[ETHD_MESSAGE_MAX]) {
  shard_work w = {
      .folder = folder, .desk = desk, .shard = shard, .source = ethd__desk_source(desk), .message = message};
  char *final = ethd__shard_path(folder, shard, ".csv");
  uint64_t done = 0;
  ethd_status status = ETHD_OK;
  *taps = 0;
  *over = ethd__file_taken(final);
  if (!*over) {
    w.path = ethd__shard_path(folder, shard, ".part");
    status = open_part(&w, &done);
    if (!status) status = run_units(&w, done, over);
    if (!status) status = finish(&w, final, *over);
    if (w.file) (void)fclose(w.file);
    free(w.path);
    *taps = w.taps;
  }
  free(final);
  return status;
}
