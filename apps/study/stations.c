#include "study/stations.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "study/progress.h"
#include "study/row.h"
#include "study/sums.h"
#include "study/tables.h"
#include "text/claim.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define FRESH "journal.new"
#define FILE_MAX ((size_t)1 << 30) /* bytes */

typedef struct station {
  ethd__folder folder;
  ethd__journal journal;
  ethd__session_progress progress;
} station;

/* ---- reading ---- */

static void close_station(station *s) {
  ethd__journal_close(&s->journal);
  ethd__progress_free(&s->progress);
  ethd__folder_close(&s->folder);
}

static ethd_status open_station(const char *path, station *out, char *message) {
  *out = (station){.journal = {.fd = -1}};
  char *journal = ethd__folder_path(path, ETHD_STUDY_JOURNAL);
  ethd_status status = ethd__folder_read(path, &out->folder, message);
  if (!status) status = ethd__progress_begin(&out->folder.protocol, &out->progress, message);
  if (!status) status = ethd__journal_read(journal, &out->journal, message);
  if (!status) status = ethd__progress_read(&out->journal, out->folder.hash, &out->progress, message);
  free(journal);
  if (status) close_station(out);
  return status;
}

/* Refuses a participant who has tapped at an earlier station. owner[person] is the station's number from 1, 0 if there
   is none yet. */
static ethd_status take_owners(const station *s, size_t number, const char *const *folders, size_t *owner,
                               char *message) {
  char id[ETHD_STUDY_ID_MAX];
  for (uint32_t i = 0; i < s->folder.protocol.participants; i++) {
    if (!s->progress.person[i].tapped) continue;
    ethd__participant_id(&s->folder.protocol, i, id);
    if (owner[i])
      return ethd__say(message, ETHD_E_DUPLICATE, "%s: %s has tapped there and in %s; one participant, one station",
                       folders[number], id, folders[owner[i] - 1]);
    owner[i] = number + 1;
  }
  return ETHD_OK;
}

ethd_status ethd__stations_fit(const char *const *folders, size_t count, char message[ETHD_MESSAGE_MAX]) {
  size_t *owner = calloc(ETHD_STUDY_SESSION_PEOPLE, sizeof *owner);
  char hash[ETHD_SHA256_TEXT] = "";
  size_t files;
  ethd_status status = owner ? ETHD_OK : ethd__no_memory(message, NULL);
  for (size_t i = 0; !status && i < count; i++) {
    station s;
    status = open_station(folders[i], &s, message);
    if (status) break;
    if (!i) memcpy(hash, s.folder.hash, sizeof hash);
    status = strcmp(hash, s.folder.hash)
                 ? ethd__say(message, ETHD_E_ARGUMENT,
                             "%s: its study, configuration, walls or plant are other ones than those of %s", folders[i],
                             folders[0])
                 : take_owners(&s, i, folders, owner, message);
    close_station(&s);
  }
  free(owner);
  for (size_t i = 0; !status && i < count; i++) status = ethd__sums_check(folders[i], &files, message);
  return status > 0 ? ETHD_E_FILE : status; /* a folder without sums is refused, too */
}

/* ---- copying ---- */

typedef struct copying {
  const char *from, *out;
  bool first; /* the first station brings the inputs along, each its taps */
  char *message;
} copying;

static void make_parents(const char *out, const char *path) {
  for (const char *slash = strchr(path, '/'); slash; slash = strchr(slash + 1, '/')) {
    char *within = strndup(path, (size_t)(slash - path));
    if (!within) ethd__fail_memory();
    char *folder = ethd__folder_path(out, within);
    (void)ethd__file_make_folder(folder); /* there already, or the file in it says why not */
    free(folder);
    free(within);
  }
}

static ethd_status copy_file(void *user, const char *path) {
  const copying *c = user;
  size_t length;
  char *text;
  bool of_a_tap = !strncmp(path, ETHD_STUDY_RECORDINGS "/", sizeof ETHD_STUDY_RECORDINGS);
  if (ethd__sums_grows(path) || (!of_a_tap && !c->first)) return ETHD_OK;
  char *from = ethd__folder_path(c->from, path), *to = ethd__folder_path(c->out, path);
  ethd_status status = ethd_text_read(from, FILE_MAX, &text, &length, c->message);
  if (!status) {
    make_parents(c->out, path);
    status = ethd_text_write(to, text, length, c->message);
    free(text);
  }
  free(from);
  free(to);
  return status;
}

/* ---- the journal ---- */

/* Prints all lines of a station but the first, and an event that says where they come from. */
static size_t put_station(const station *s, FILE *file, char *message) {
  char sum[ETHD_SHA256_TEXT], *text = NULL;
  size_t length, taps = 0;
  if (ethd__sum_of_file(s->journal.path, sum, message)) return 0;
  for (size_t i = 1; i < s->journal.count; i++) {
    ethd__journal_print(file, s->journal.lines[i].kind, s->journal.lines[i].text);
    taps += !strcmp(s->journal.lines[i].kind, "tap");
    if (i > 1) continue;
    FILE *row = open_memstream(&text, &length);
    if (!row) ethd__fail_memory();
    fputs(",,,merged,", row);
    ethd__csv_put_word(row, s->folder.path);
    fprintf(row, " %s", sum);
    if (fclose(row)) ethd__fail_memory();
    ethd__journal_print(file, "event", text);
    free(text);
  }
  return taps;
}

/* Prints the lines of all stations as the journal of one folder. */
static ethd_status print_journal(const char *const *folders, size_t count, FILE *file, size_t *taps, char *message) {
  ethd_status status = ETHD_OK;
  *taps = 0;
  for (size_t i = 0; !status && i < count; i++) {
    station s;
    status = open_station(folders[i], &s, message);
    if (status) break;
    if (!i) ethd__journal_print(file, s.journal.lines[0].kind, s.journal.lines[0].text);
    *taps += put_station(&s, file, message);
    close_station(&s);
  }
  return status;
}

static ethd_status write_journal(const char *const *folders, size_t count, const char *out, size_t *taps,
                                 char *message) {
  char *fresh = ethd__folder_path(out, FRESH), *path = ethd__folder_path(out, ETHD_STUDY_JOURNAL);
  int fd = ethd__file_create(fresh, message);
  FILE *file = fd < 0 ? NULL : fdopen(fd, "w");
  ethd_status status = fd < 0 ? ETHD_E_FILE : ETHD_OK;
  if (!status) status = file ? print_journal(folders, count, file, taps, message) : ethd__no_memory(message, fresh);
  bool failed = file && (fflush(file) || fsync(fileno(file)));
  if (file) failed |= fclose(file) != 0;
  if (!status && (failed || ethd__file_move(fresh, path)))
    status = ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno));
  if (status) ethd__file_remove(fresh);
  free(fresh);
  free(path);
  return status;
}

ethd_status ethd__stations_tables(const char *const *folders, size_t count, char *out[ETHD_TABLES],
                                  char message[ETHD_MESSAGE_MAX]) {
  char *text = NULL, *path = ethd__folder_path(folders[0], ETHD_STUDY_JOURNAL);
  size_t length, taps;
  ethd__folder folder;
  ethd__journal journal = {.fd = -1};
  FILE *file = open_memstream(&text, &length);
  if (!file) ethd__fail_memory();
  ethd_status status = print_journal(folders, count, file, &taps, message);
  if (fclose(file)) ethd__fail_memory();
  if (status)
    free(text);
  else
    status = ethd__journal_parse(text, length, path, &journal, message);
  if (!status) status = ethd__folder_read(folders[0], &folder, message);
  if (!status) {
    status = ethd__tables_of(&folder, &journal, out, message);
    ethd__folder_close(&folder);
  }
  ethd__journal_close(&journal);
  free(path);
  return status;
}

/* ---- merging ---- */

static ethd_status write_tables(const char *out, char *message) {
  ethd__folder folder;
  ethd_status status = ethd__folder_read(out, &folder, message);
  if (status) return status;
  status = ethd__tables_write(&folder, message);
  ethd__folder_close(&folder);
  return status;
}

static ethd_status merge(const char *const *folders, size_t count, const char *out, size_t *taps, char *message) {
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < count; i++) {
    copying c = {folders[i], out, i == 0, message};
    status = ethd__sums_each(folders[i], copy_file, &c, message);
  }
  if (!status) status = write_journal(folders, count, out, taps, message);
  return status ? status : write_tables(out, message);
}

ethd_status ethd__stations_merge(const char *const *folders, size_t count, const char *out, size_t *taps,
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
