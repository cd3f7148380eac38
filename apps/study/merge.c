#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/columns.h"
#include "study/shard.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

/* The shards of a folder while they are merged. */
typedef struct merge {
  ethd__folder *folder;
  uint32_t count;
  FILE **file; /* by shard */
  char **line; /* of each, the next one, NULL at its end */
  size_t *room;
  FILE *out;
  uint64_t taps;
  char *message;
} merge;

static ethd_status no_memory(const merge *m) { return ethd__no_memory(m->message, NULL); }

/* ---- which there are ---- */

static bool shard_name(const char *name, ethd__shard *out) {
  char again[64];
  if (sscanf(name, "shard-%" SCNu32 "-of-%" SCNu32 ".csv", &out->index, &out->count) != 2) return false;
  snprintf(again, sizeof again, "shard-%" PRIu32 "-of-%" PRIu32 ".csv", out->index, out->count);
  return !strcmp(name, again) && out->count >= 1 && out->count <= ETHD_STUDY_SHARDS_MAX;
}

static ethd_status count_shards(merge *m) {
  DIR *folder = ethd__file_list(m->folder->path);
  const struct dirent *entry;
  ethd__shard shard;
  ethd_status status = ETHD_OK;
  while (folder && !status && (entry = readdir(folder))) {
    if (!shard_name(entry->d_name, &shard)) continue;
    if (m->count && m->count != shard.count)
      status =
          ethd__say(m->message, ETHD_E_FILE, "%s: shards of %" PRIu32 " and of %" PRIu32 "; keep those of one division",
                    m->folder->path, m->count, shard.count);
    m->count = shard.count;
  }
  if (folder) closedir(folder);
  if (!status && !m->count)
    status = ethd__say(m->message, ETHD_E_FILE, "%s: no shard-i-of-n.csv; --simulate makes them", m->folder->path);
  return status;
}

/* ---- lines ---- */

static void next(merge *m, uint32_t shard) {
  ssize_t length = getline(&m->line[shard], &m->room[shard], m->file[shard]);
  if (length > 0) return;
  free(m->line[shard]);
  m->line[shard] = NULL;
}

static ethd_status open_shard(merge *m, uint32_t shard, const char *header) {
  const ethd__shard which = {.index = shard + 1, .count = m->count};
  char *path = ethd__shard_path(m->folder, &which, ".csv");
  size_t n = strlen(header);
  struct stat info;
  ethd_status status = ETHD_OK;
  if (ethd__file_taken(path) && !(m->file[shard] = ethd__file_stream(path, m->message))) {
    status = ETHD_E_FILE;
  } else if (!m->file[shard]) {
    status = ethd__say(m->message, ETHD_E_FILE,
                       "%s: missing; ethd-study --simulate N --shard %" PRIu32 "/%" PRIu32 " makes it", path,
                       which.index, which.count);
  } else if (fstat(fileno(m->file[shard]), &info) != 0 || ethd__file_has_hole(fileno(m->file[shard]), info.st_size)) {
    status = ethd__say(m->message, ETHD_E_SYNTAX, "%s: has a hole; remove it and have it made again", path);
  } else {
    next(m, shard);
    if (!m->line[shard] || strncmp(m->line[shard], header, n) != 0 || m->line[shard][n] != '\n')
      status = ethd__say(m->message, ETHD_E_SYNTAX, "%s:1: not the columns of this study", path);
    else
      next(m, shard);
  }
  free(path);
  return status;
}

static ethd_status open_shards(merge *m) {
  char *header = ethd__simulation_header(&m->folder->protocol);
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; !status && i < m->count; i++) status = open_shard(m, i, header);
  fprintf(m->out, "%s\n", header);
  free(header);
  return status;
}

/* Rows that are left over in a shard belong to no participant. */
static ethd_status check_ends(const merge *m) {
  for (uint32_t i = 0; i < m->count; i++)
    if (m->line[i])
      return ethd__say(m->message, ETHD_E_SYNTAX,
                       "%s/shard-%" PRIu32 "-of-%" PRIu32 ".csv: rows of nobody behind those of its participants; "
                       "remove it and have it made again",
                       m->folder->path, i + 1, m->count);
  return ETHD_OK;
}

static ethd_status merge_unit(merge *m, uint64_t unit) {
  uint32_t shard = (uint32_t)(unit % m->count);
  char *prefix = ethd__unit_prefix(m->folder, unit);
  size_t n = strlen(prefix);
  uint64_t before = m->taps;
  while (m->line[shard] && !strncmp(m->line[shard], prefix, n)) {
    fputs(m->line[shard], m->out);
    m->taps++;
    next(m, shard);
  }
  ethd_status status = ETHD_OK;
  if (m->taps == before)
    status = ethd__say(m->message, ETHD_E_SYNTAX,
                       "%s/shard-%" PRIu32 "-of-%" PRIu32
                       ".csv: no rows that begin with %s; remove it and have it made again",
                       m->folder->path, shard + 1, m->count, prefix);
  free(prefix);
  return status;
}

static void release(merge *m) {
  for (uint32_t i = 0; m->file && i < m->count; i++) {
    if (m->file[i]) fclose(m->file[i]);
    free(m->line[i]);
  }
  free(m->file);
  free(m->line);
  free(m->room);
}

ethd_status ethd__shards_merge(ethd__folder *folder, uint64_t *taps, char message[ETHD_MESSAGE_MAX]) {
  merge m = {.folder = folder, .message = message};
  ethd_replace replace;
  uint64_t units = ethd__unit_count(&folder->protocol);
  ethd_status status = count_shards(&m);
  if (!status && !folder->simulated)
    status = ethd__say(message, ETHD_E_FILE, "%s/%s: doesn't say how many participants were simulated", folder->path,
                       ETHD_STUDY_VERSIONS);
  if (status) return status;
  m.file = calloc(m.count, sizeof *m.file);
  m.line = calloc(m.count, sizeof *m.line);
  m.room = calloc(m.count, sizeof *m.room);
  char *path = ethd__folder_path(folder->path, ETHD_STUDY_TAPS);
  if (!m.file || !m.line || !m.room) status = no_memory(&m);
  if (!status) status = ethd_replace_begin(path, &replace, message);
  free(path);
  if (!status) {
    m.out = replace.file;
    status = open_shards(&m);
    for (uint64_t unit = 0; !status && unit < units; unit++) status = merge_unit(&m, unit);
    if (!status) status = check_ends(&m);
    if (status)
      ethd_replace_abandon(&replace);
    else
      status = ethd_replace_commit(&replace, message);
  }
  release(&m);
  *taps = m.taps;
  return status;
}
