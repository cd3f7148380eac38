#include "study/stations.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "study/merge.h"
#include "study/sums.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define FILE_MAX ((size_t)1 << 30) /* bytes */

typedef struct station {
  ethd__folder folder;
  ethd__study_store store;
} station;

/* ---- reading ---- */

static void close_station(station *s) {
  ethd__store_close(&s->store);
  ethd__folder_close(&s->folder);
}

static ethd_status open_station(const char *path, station *out, char *message) {
  ethd_status status = ethd__folder_read(path, &out->folder, message);
  if (status) return status;
  status = ethd__progress_open(&out->folder, ETHD_STUDY_STORE, false, &out->store, message);
  if (status) ethd__folder_close(&out->folder);
  return status;
}

/* Refuses a participant who has tapped at an earlier station. owner[person] is the station's number from 1, 0 if there
   is none yet. */
static ethd_status take_owners(station *s, size_t number, const char *const *folders, size_t *owner, char *message) {
  char id[ETHD_STUDY_ID_MAX];
  ethd_status status = ETHD_OK;
  sqlite3_stmt *row = ethd__store_query(&s->store, "SELECT DISTINCT participant FROM tap");
  while (!status && ethd__store_next(row)) {
    uint32_t person = (uint32_t)sqlite3_column_int64(row, 0) - 1;
    ethd__participant_id(&s->folder.protocol, person, id);
    if (owner[person])
      status = ethd__say(message, ETHD_E_DUPLICATE, "%s: %s has tapped there and in %s; one participant, one station",
                         folders[number], id, folders[owner[person] - 1]);
    owner[person] = number + 1;
  }
  ethd_status ended = ethd__store_end(&s->store, row, message);
  return status ? status : ended;
}

ethd_status ethd__stations_fit(const char *const *folders, size_t count, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED size_t *owner = calloc(ETHD_STUDY_SESSION_PEOPLE, sizeof *owner);
  char hash[ETHD_SHA256_TEXT] = "";
  size_t files;
  ethd_status status = owner ? ETHD_OK : ethd__no_memory(message, NULL);
  for (size_t i = 0; !status && i < count; i++) {
    station s;
    status = open_station(folders[i], &s, message);
    if (status) break;
    if (!i) memcpy(hash, s.folder.hash, sizeof hash);
    if (s.folder.simulated)
      status = ethd__say(message, ETHD_E_ARGUMENT, "%s: holds a simulation; sessions are merged here", folders[i]);
    else if (strcmp(hash, s.folder.hash))
      status = ethd__say(message, ETHD_E_ARGUMENT,
                         "%s: its study, configuration, walls or plant are other ones than those of %s", folders[i],
                         folders[0]);
    else
      status = take_owners(&s, i, folders, owner, message);
    close_station(&s);
  }
  for (size_t i = 0; !status && i < count; i++) status = ethd__sums_check(folders[i], &files, message);
  return status > 0 ? ETHD_E_FILE : status; /* a folder without sums is refused, too */
}

/* ---- copying ---- */

typedef struct copying {
  const char *from, *out;
  bool first; /* the inputs are the first station's; the taps are each station's */
  char *message;
} copying;

static void make_parents(const char *out, const char *path) {
  for (const char *slash = strchr(path, '/'); slash; slash = strchr(slash + 1, '/')) {
    ETHD__FREED char *within = strndup(path, (size_t)(slash - path));
    if (!within) ethd__fail_memory();
    ETHD__FREED char *folder = ethd__folder_path(out, within);
    (void)ethd__file_make_folder(folder); /* it may exist; an error shows at the file in it */
  }
}

static ethd_status copy_file(void *user, const char *path) {
  const copying *c = user;
  size_t length;
  ETHD__FREED char *text = NULL;
  bool of_a_tap = !strncmp(path, ETHD_STUDY_RECORDINGS "/", sizeof ETHD_STUDY_RECORDINGS);
  if (ethd__sums_grows(path) || (!of_a_tap && !c->first)) return ETHD_OK;
  ETHD__FREED char *from = ethd__folder_path(c->from, path), *to = ethd__folder_path(c->out, path);
  ethd_status status = ethd_text_read(from, FILE_MAX, &text, &length, c->message);
  if (!status) {
    make_parents(c->out, path);
    status = ethd_text_write(to, text, length, c->message);
  }
  return status;
}

/* ---- the stores ---- */

/* Marks the next rows in the store as this folder's. */
static ethd_status put_origin(ethd__study_store *out, const char *folder, const char *path, char *message) {
  char sum[ETHD_SHA256_TEXT];
  ETHD__FREED char *detail = NULL;
  ethd_status status = ethd__sum_of_file(path, sum, message);
  if (status) return status;
  if (asprintf(&detail, "%s %s", folder, sum) < 0) return ethd__no_memory(message, NULL);
  sqlite3_stmt *insert = ethd__store_query(out, "INSERT INTO event (utc, event, detail) VALUES ('', 'merged', ?)");
  sqlite3_bind_text(insert, 1, detail, -1, SQLITE_TRANSIENT);
  return ethd__store_run(out, insert, message);
}

typedef struct origins {
  const char *const *folder;
  size_t count;
} origins;

static ethd_status add(const void *self, ethd__study_store *out, char message[ETHD_MESSAGE_MAX]) {
  const origins *all = self;
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < all->count; i++) {
    ETHD__FREED char *path = ethd__folder_path(all->folder[i], ETHD_STUDY_STORE);
    status = put_origin(out, all->folder[i], path, message);
    if (!status) status = ethd__store_add(out, path, message);
  }
  return status;
}

ethd_status ethd__stations_tables(const char *const *folders, size_t count, char *out[ETHD_TABLES],
                                  char message[ETHD_MESSAGE_MAX]) {
  ethd__folder folder;
  ethd__study_store store;
  ethd_status status = ethd__folder_read(folders[0], &folder, message);
  if (status) return status;
  status = ethd__store_open(ETHD_STORE_MEMORY, folder.hash, &store, message);
  if (!status) status = add(&(origins){folders, count}, &store, message);
  if (!status) status = ethd__tables_of(&folder, &store, out, message);
  ethd__store_close(&store);
  ethd__folder_close(&folder);
  return status;
}

/* ---- merging ---- */

static ethd_status merge(const char *const *folders, size_t count, const char *out, uint64_t *taps, char *message) {
  ethd__folder folder;
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < count; i++) {
    copying c = {folders[i], out, i == 0, message};
    status = ethd__sums_each(folders[i], copy_file, &c, message);
  }
  if (!status) status = ethd__folder_read(out, &folder, message);
  if (status) return status;
  status = ethd__merge_write(&folder, &(ethd__merge){&(origins){folders, count}, add}, taps, message);
  ethd__folder_close(&folder);
  return status ? status : ethd__sums_write(out, message);
}

ethd_status ethd__stations_merge(const char *const *folders, size_t count, const char *out, uint64_t *taps,
                                 char message[ETHD_MESSAGE_MAX]) {
  static const char *const any[] = {"*", NULL};
  ethd__claim claim = ETHD_CLAIM_NONE;
  ethd_status status;
  struct stat what;
  if (!stat(out, &what)) {
    char unsaid[ETHD_MESSAGE_MAX];
    status = ethd__claim_folder(out, any, false, &claim, unsaid);
    if (status) return ethd__say(message, status, "%s: isn't empty; another folder is needed", out);
  } else {
    status = ethd__claim_folder(out, any, false, &claim, message);
  }
  if (!status) status = merge(folders, count, out, taps, message);
  ethd__claim_release(&claim);
  return status < 0 || !status ? status : ETHD_E_FILE;
}
