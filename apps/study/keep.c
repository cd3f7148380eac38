#include "study/keep.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/schema.h"
#include "text/error_text.h"
#include "text/file.h"

#define FRESH ".new"

/* ---- a folder of files, no deeper ---- */

/* Calls `each` for every file; false: one failed, errno has the reason. */
static bool every(const char *path, bool (*each)(int folder, const char *name)) {
  DIR *open_folder = ethd__file_list(path);
  bool done = open_folder != NULL;
  struct dirent *entry;
  while (done && (entry = readdir(open_folder)))
    if (strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..")) done = each(dirfd(open_folder), entry->d_name);
  int reason = errno;
  if (open_folder) closedir(open_folder);
  errno = reason;
  return done;
}

static bool remove_file(int folder, const char *name) { return unlinkat(folder, name, 0) == 0; }

static bool put_on_disk(int fd) {
  bool done = fd >= 0 && fdatasync(fd) == 0;
  int reason = errno;
  if (fd >= 0) close(fd);
  errno = reason;
  return done;
}

static bool sync_file(int folder, const char *name) {
  return put_on_disk(openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
}

static bool sync_folder(const char *path) { return put_on_disk(ethd__file_open(path, O_RDONLY | O_DIRECTORY, 0)); }

static void discard(const char *path) {
  if (every(path, remove_file)) (void)ethd__file_remove_folder(path);
}

/* ---- keeping ---- */

static ethd_status write_fresh(const char *fresh, const ethd_config *config, const ethd__taken *taken,
                               const char *words, char *message) {
  ethd__ticks ticks;
  char left[ETHD_MESSAGE_MAX];
  ethd_status status = ethd__ticks_open(fresh, config, false, &ticks, message);
  if (status) return status;
  status = ethd__ticks_stage(&ticks, taken->stage, message);
  if (!status) status = ethd__ticks_tap(&ticks, words, taken->stage, message);
  ethd_status closed = ethd__ticks_close(&ticks, left);
  if (!status && closed) status = ethd__say(message, closed, "%s", left);
  return status;
}

static ethd_status put_in_place(const char *folder, const char *fresh, const char *path, char *message) {
  bool done = every(fresh, sync_file) && sync_folder(fresh) && ethd__file_move(fresh, path) == 0 && sync_folder(folder);
  return done ? ETHD_OK : ethd__file_refuse(path, message);
}

ethd_status ethd__tap_keep(const char *folder, const char *name, const ethd_config *config, const ethd__taken *taken,
                           const char *words, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *fresh = ethd__folder_path(folder, FRESH), *path = ethd__folder_path(folder, name);
  discard(fresh);
  ethd_status status = ethd__file_make_folder(folder) ? ethd__file_refuse(folder, message) : ETHD_OK;
  if (!status) status = write_fresh(fresh, config, taken, words, message);
  if (!status) status = put_in_place(folder, fresh, path, message);
  if (status) discard(fresh);
  return status;
}

/* ---- what a kill has left ---- */

/* Whether this is the name of a tap's folder, and its tap isn't in the store. */
static ethd_status is_torn(const ethd__protocol *p, ethd__study_store *store, const char *name, bool *torn,
                           char *message) {
  char again[64], id[ETHD_STUDY_ID_MAX];
  unsigned person, block, attempt;
  *torn = false;
  if (sscanf(name, "P%u-%u-%u", &person, &block, &attempt) != 3) return ETHD_OK;
  ethd__participant_id(p, person - 1, id);
  snprintf(again, sizeof again, "%s-%02u-%03u", id, block, attempt);
  if (strcmp(name, again) != 0) return ETHD_OK;
  sqlite3_stmt *row =
      ethd__store_query(store, "SELECT 1 FROM tap WHERE point = 0 AND participant = ? AND block = ? AND attempt = ?");
  sqlite3_bind_int64(row, 1, person);
  sqlite3_bind_int64(row, 2, block);
  sqlite3_bind_int64(row, 3, attempt);
  *torn = !ethd__store_next(row);
  return ethd__store_end(store, row, message);
}

ethd_status ethd__tap_remove_torn(const ethd__folder *folder, ethd__study_store *store,
                                  char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *taps = ethd__folder_path(folder->path, ETHD_STUDY_RECORDINGS),
                   *fresh = ethd__folder_path(taps, FRESH);
  char *torn = NULL;
  DIR *open_folder = ethd__file_list(taps);
  const struct dirent *entry;
  size_t count = 0;
  ethd_status status = ETHD_OK;
  while (!status && open_folder && (entry = readdir(open_folder))) {
    bool is = false;
    status = is_torn(&folder->protocol, store, entry->d_name, &is, message);
    if (is && !count++) torn = ethd__folder_path(taps, entry->d_name);
  }
  if (open_folder) closedir(open_folder);
  if (!status && count > 1)
    status = ethd__say(message, ETHD_E_SYNTAX,
                       "%s: not in " ETHD_STUDY_STORE ", nor are %zu other taps' folders: put its latest copy back, or "
                       "move these folders away",
                       torn, count - 1);
  if (!status) discard(fresh);
  if (!status && torn) discard(torn);
  free(torn);
  return status;
}

/* ---- its row ---- */

static void bind_figures(sqlite3_stmt *query, int first, const ethd__result *result) {
  const ethd__metrics *m = &result->metrics;
  const double figures[ETHD_STORE_FIGURE_COUNT] = {m->v_rvo,
                                                   m->v_of,
                                                   m->d_max,
                                                   m->v_rmin,
                                                   m->delta_s,
                                                   m->eps,
                                                   m->t_rvo,
                                                   m->t_of,
                                                   m->t_seen,
                                                   m->peak_force,
                                                   result->finger_radius,
                                                   result->commanded,
                                                   m->v_hand,
                                                   m->touch_depth,
                                                   m->eps_felt};
  for (int i = 0; i < ETHD_STORE_FIGURE_COUNT; i++) sqlite3_bind_double(query, first + i, figures[i]); /* NaN: NULL */
}

static void bind_word(sqlite3_stmt *query, int column, const char *word) {
  sqlite3_bind_text(query, column, word, -1, SQLITE_TRANSIENT);
}

ethd_status ethd__tap_put(ethd__study_store *store, size_t point, const ethd__taken *taken,
                          char message[ETHD_MESSAGE_MAX]) {
  static const char insert[] =
      "INSERT INTO tap (" ETHD_STORE_TAP ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, "
      "?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21, ?22, ?23, ?24, ?25, ?26, ?27, ?28)";
  const ethd__metrics *m = &taken->result.metrics;
  const ethd__turn *turn = &taken->turn;
  char seed[24], tap[24];
  sqlite3_stmt *query = ethd__store_query(store, insert);
  snprintf(seed, sizeof seed, "%" PRIu64, taken->seed);
  snprintf(tap, sizeof tap, "%" PRIu64, taken->tap);
  sqlite3_bind_int64(query, 1, (int64_t)point);
  sqlite3_bind_int64(query, 2, turn->person + 1);
  sqlite3_bind_int64(query, 3, (int64_t)turn->number);
  sqlite3_bind_int64(query, 4, turn->attempt);
  bind_word(query, 5, seed);
  bind_word(query, 6, tap);
  sqlite3_bind_int(query, 7, m->reason == ETHD_TAP_OK);
  bind_word(query, 8, ethd__reason_words[m->reason]);
  bind_figures(query, 9, &taken->result);
  bind_word(query, 24, ethd__hand_words[taken->hand]);
  bind_word(query, 25, taken->movement);
  bind_word(query, 26, taken->utc);
  bind_word(query, 27, ethd__reason_words[m->by_ring]);
  bind_word(query, 28, ethd__reason_words[m->by_finger]);
  return ethd__store_run(store, query, message);
}
