#include "study/merge.h"

#include <errno.h>
#include <string.h>

#include "text/error_text.h"
#include "text/file.h"

#define FRESH ETHD_STUDY_STORE ".new"

static ethd_status count_taps(ethd__study_store *store, uint64_t *taps, char *message) {
  sqlite3_stmt *row = ethd__store_query(store, "SELECT count(*) FROM tap");
  *taps = ethd__store_next(row) ? (uint64_t)sqlite3_column_int64(row, 0) : 0;
  return ethd__store_end(store, row, message);
}

/* Removes the remains of a killed merge. */
static void remove_fresh(const ethd__folder *folder) {
  static const char *const names[] = {FRESH "-journal", FRESH};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    ETHD__FREED char *path = ethd__folder_path(folder->path, names[i]);
    (void)ethd__file_remove(path);
  }
}

ethd_status ethd__merge_write(const ethd__folder *folder, const ethd__merge *merge, uint64_t *taps,
                              char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *fresh = ethd__folder_path(folder->path, FRESH),
                   *path = ethd__folder_path(folder->path, ETHD_STUDY_STORE);
  ethd__study_store store;
  remove_fresh(folder);
  ethd_status status = ethd__store_open(fresh, folder->hash, &store, message);
  if (!status) status = merge->add(merge->self, &store, message);
  if (!status) status = count_taps(&store, taps, message);
  if (!status) status = ethd__tables_write(folder, &store, message);
  ethd__store_close(&store);
  if (!status && ethd__file_move(fresh, path))
    status = ethd__say(message, ETHD_E_FILE, "%s: %s", path, ethd__file_why());
  if (status) remove_fresh(folder);
  return status;
}
