#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "study/merge.h"
#include "study/shard.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/file.h"

/* ---- which there are ---- */

static bool is_shard(const char *name, ethd__shard *out) {
  char again[ETHD_SHARD_NAME_MAX];
  if (sscanf(name, "shard-%" SCNu32 "-of-%" SCNu32 ".sqlite", &out->index, &out->count) != 2) return false;
  ethd__shard_name(out, again);
  return !strcmp(name, again) && out->count >= 1 && out->count <= ETHD_STUDY_SHARDS_MAX;
}

static ethd_status count_shards(const ethd__folder *folder, uint32_t *count, char *message) {
  DIR *entries = ethd__file_list(folder->path);
  const struct dirent *entry;
  ethd__shard shard;
  ethd_status status = ETHD_OK;
  *count = 0;
  while (entries && !status && (entry = readdir(entries))) {
    if (!is_shard(entry->d_name, &shard)) continue;
    if (*count && *count != shard.count)
      status =
          ethd__say(message, ETHD_E_FILE, "%s: shards of %" PRIu32 " and of %" PRIu32 "; keep those of one division",
                    folder->path, *count, shard.count);
    *count = shard.count;
  }
  if (entries) closedir(entries);
  if (!status && !*count)
    status = ethd__say(message, ETHD_E_FILE, "%s: no shard-i-of-n.sqlite; --simulate makes them", folder->path);
  return status;
}

/* ---- merging ---- */

/* Refuses a missing or unfinished shard, or one of another study. */
static ethd_status check_shard(const ethd__folder *folder, const ethd__shard *shard, const char *name, char *message) {
  ethd__study_store store;
  uint64_t done, units = ethd__shard_units(&folder->protocol, shard);
  ETHD__FREED char *path = ethd__folder_path(folder->path, name);
  struct stat info;
  ethd_status status = ETHD_OK;
  if (ethd__file_look_at(path, &info))
    status =
        ethd__say(message, ETHD_E_FILE, "%s: missing; ethd-study --simulate N --shard %" PRIu32 "/%" PRIu32 " makes it",
                  path, shard->index, shard->count);
  if (!status) status = ethd__progress_open(folder, name, false, &store, message);
  if (!status) {
    status = ethd__shard_done(&store, &folder->protocol, shard, &done, message);
    ethd__store_close(&store);
    if (!status && done < units)
      status = ethd__say(message, ETHD_E_FILE,
                         "%s: has %" PRIu64 " of its %" PRIu64 " participants; ethd-study --simulate N --shard %" PRIu32
                         "/%" PRIu32 " goes on",
                         path, done, units, shard->index, shard->count);
  }
  return status;
}

/* The shards of a folder. */
typedef struct shards {
  const ethd__folder *folder;
  uint32_t count;
} shards;

static ethd_status add(const void *self, ethd__study_store *out, char message[ETHD_MESSAGE_MAX]) {
  const shards *all = self;
  ethd_status status = ETHD_OK;
  for (uint32_t i = 1; !status && i <= all->count; i++) {
    const ethd__shard shard = {.index = i, .count = all->count};
    char name[ETHD_SHARD_NAME_MAX];
    ethd__shard_name(&shard, name);
    ETHD__FREED char *path = ethd__folder_path(all->folder->path, name);
    status = check_shard(all->folder, &shard, name, message);
    if (!status) status = ethd__store_add(out, path, message);
  }
  return status;
}

ethd_status ethd__shards_merge(ethd__folder *folder, uint64_t *taps, char message[ETHD_MESSAGE_MAX]) {
  shards all = {folder, 0};
  ethd__claim claim = ETHD_CLAIM_NONE;
  ethd_status status = count_shards(folder, &all.count, message);
  if (!status && !folder->simulated)
    status = ethd__say(message, ETHD_E_FILE, "%s/%s: doesn't say how many participants were simulated", folder->path,
                       ETHD_STUDY_VERSIONS);
  if (!status) status = ethd__claim_wait(folder->path, &claim, message);
  if (!status) status = ethd__merge_write(folder, &(ethd__merge){&all, add}, taps, message);
  ethd__claim_release(&claim);
  return status;
}
