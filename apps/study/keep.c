#include "study/keep.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "study/columns.h"
#include "study/folder.h"
#include "study/row.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define FRESH ".new"
#define ROW "tap.csv"

static ethd_status refuse(const char *path, char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno));
}

/* ---- a folder of files, no deeper ---- */

/* Calls `each` for every file; false when one failed, errno says why. */
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

static bool sync_file(int folder, const char *name) {
  int fd = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  bool done = fd >= 0 && fdatasync(fd) == 0;
  int reason = errno;
  if (fd >= 0) close(fd);
  errno = reason;
  return done;
}

static bool sync_folder(const char *path) {
  int fd = ethd__file_open(path, O_RDONLY | O_DIRECTORY, 0);
  bool done = fd >= 0 && fdatasync(fd) == 0;
  int reason = errno;
  if (fd >= 0) close(fd);
  errno = reason;
  return done;
}

static void discard(const char *path) {
  if (every(path, remove_file)) (void)ethd__file_remove_folder(path);
}

/* ---- keeping ---- */

static ethd_status write_row(const char *fresh, const char *row, char *message) {
  char *path = ethd__folder_path(fresh, ROW), *text, *header = ethd__table_header(ETHD_TABLE_TAPS, NULL);
  int length = asprintf(&text, "%s\n%s\n", header, row);
  ethd_status status =
      length < 0 ? ethd__no_memory(message, NULL) : ethd_text_write(path, text, (size_t)length, message);
  if (length >= 0) free(text);
  free(header);
  free(path);
  return status;
}

static ethd_status write_fresh(const char *fresh, const ethd_config *config, const ethd__taken *taken,
                               const char *words, const char *row, char *message) {
  ethd__ticks ticks;
  char left[ETHD_MESSAGE_MAX];
  ethd_status status = ethd__ticks_open(fresh, config, false, &ticks, message);
  if (status) return status;
  status = ethd__ticks_stage(&ticks, taken->stage, message);
  if (!status) status = ethd__ticks_tap(&ticks, words, taken->stage, message);
  ethd_status closed = ethd__ticks_close(&ticks, left);
  if (!status && closed) status = ethd__say(message, closed, "%s", left);
  return status ? status : write_row(fresh, row, message);
}

static ethd_status put_in_place(const char *folder, const char *fresh, const char *path, char *message) {
  bool done = every(fresh, sync_file) && sync_folder(fresh) && ethd__file_move(fresh, path) == 0 && sync_folder(folder);
  return done ? ETHD_OK : refuse(path, message);
}

ethd_status ethd__tap_keep(const char *folder, const char *name, const ethd_config *config, const ethd__taken *taken,
                           const char *words, const char *row, char message[ETHD_MESSAGE_MAX]) {
  char *fresh = ethd__folder_path(folder, FRESH), *path = ethd__folder_path(folder, name);
  discard(fresh);
  ethd_status status = ethd__file_make_folder(folder) ? refuse(folder, message) : ETHD_OK;
  if (!status) status = write_fresh(fresh, config, taken, words, row, message);
  if (!status) status = put_in_place(folder, fresh, path, message);
  if (status) discard(fresh);
  free(fresh);
  free(path);
  return status;
}

/* ---- what is there ---- */

static ethd_status read_row(const char *path, char **row, char *message) {
  char *text, *file = ethd__folder_path(path, ROW), *columns = ethd__table_header(ETHD_TABLE_TAPS, NULL);
  size_t length, header = strlen(columns);
  ethd_status status = ethd_text_read(file, 1 << 16, &text, &length, message);
  if (!status && (length < header + 3 || memcmp(text, columns, header) != 0 || text[header] != '\n' ||
                  strcspn(text + header + 1, "\n") != length - header - 2))
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: not a tap's row; move the folder away to have the tap again", file);
  if (!status) {
    text[length - 1] = 0;
    memmove(text, text + header + 1, length - header - 1);
    *row = text;
  } else {
    free(text);
  }
  free(columns);
  free(file);
  return status;
}

ethd_status ethd__tap_kept(const char *folder, const char *name, char **row, char message[ETHD_MESSAGE_MAX]) {
  char *fresh = ethd__folder_path(folder, FRESH), *path = ethd__folder_path(folder, name);
  *row = NULL;
  discard(fresh);
  ethd_status status = ethd__file_taken(path) ? read_row(path, row, message) : ETHD_OK;
  free(fresh);
  free(path);
  return status;
}
