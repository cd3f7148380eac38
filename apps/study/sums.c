#include "study/sums.h"

#include <dirent.h>
#include <errno.h>
#include <fnmatch.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "study/folder.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define LIST_MAX ((size_t)1 << 30)
#define DEEPEST 4 /* folders below the study's */

typedef struct summed {
  char *path; /* from the folder on */
  char sum[ETHD_SHA256_TEXT];
} summed;

/* Files by path. */
typedef struct summed_list {
  summed *file;
  size_t count;
} summed_list;

ethd_status ethd__sum_of_file(const char *path, char out[ETHD_SHA256_TEXT], char message[ETHD_MESSAGE_MAX]) {
  static char bytes[1 << 16];
  ethd__sha256 sum;
  size_t n;
  struct stat info;
  FILE *file = ethd__file_stream(path, message);
  if (!file) return ETHD_E_FILE;
  if (fstat(fileno(file), &info) != 0 || ethd__file_has_hole(fileno(file), info.st_size)) { /* it may be endless */
    fclose(file);
    return ethd__say(message, ETHD_E_FILE, "%s: has a hole; restore the file from a copy", path);
  }
  ethd__sha256_begin(&sum);
  while ((n = fread(bytes, 1, sizeof bytes, file))) ethd__sha256_add(&sum, bytes, n);
  bool failed = ferror(file);
  int reason = errno;
  fclose(file);
  ethd__sha256_end(&sum, out);
  return failed ? ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(reason)) : ETHD_OK;
}

/* ---- lists ---- */

static void free_list(summed_list *list) {
  for (size_t i = 0; i < list->count; i++) free(list->file[i].path);
  free(list->file);
  *list = (summed_list){0};
}

/* Adds the path, which the list owns from then on. */
static void add(summed_list *list, char *path, const char *sum) {
  size_t n = list->count;
  if (!(n & (n - 1))) list->file = realloc(list->file, (n ? 2 * n : 1) * sizeof *list->file);
  if (!list->file || !path) ethd__fail_memory();
  list->file[n].path = path;
  snprintf(list->file[n].sum, sizeof list->file[n].sum, "%s", sum);
  list->count++;
}

static int by_path(const void *a, const void *b) {
  return strcmp(((const summed *)a)->path, ((const summed *)b)->path);
}

static void sort(summed_list *list) {
  if (list->count) qsort(list->file, list->count, sizeof *list->file, by_path);
}

static const summed *find(const summed_list *list, const char *path) {
  const summed key = {.path = (char *)path};
  return list->count ? bsearch(&key, list->file, list->count, sizeof key, by_path) : NULL;
}

/* ---- what is in the folder ---- */

static bool ends(const char *name, const char *end) {
  size_t n = strlen(name), m = strlen(end);
  return n > m && !strcmp(name + n - m, end);
}

static bool left_out(const char *name, int depth) {
  return name[0] == '.' || ends(name, ".new") || ends(name, ".sqlite-journal") ||
         (!depth && (!strcmp(name, ETHD_STUDY_SUMS) || !strcmp(name, "report")));
}

/* All files below folder/within; with `odd` also links, pipes and the like. */
static void walk(const char *folder, const char *within, int depth, bool odd, summed_list *out) {
  ETHD__FREED char *path = ethd__folder_path(folder, within);
  DIR *open_folder = ethd__file_list(path);
  const struct dirent *entry;
  struct stat what;
  while (open_folder && (entry = readdir(open_folder))) {
    if (left_out(entry->d_name, depth) || strchr(entry->d_name, '\n')) continue;
    char *inner = ethd__folder_path(within, entry->d_name);
    ETHD__FREED char *whole = ethd__folder_path(folder, inner);
    bool there = ethd__file_look_at(whole, &what) == 0;
    if (there && S_ISDIR(what.st_mode) && depth < DEEPEST) walk(folder, inner, depth + 1, odd, out);
    if (there && (S_ISREG(what.st_mode) || (odd && !S_ISDIR(what.st_mode))))
      add(out, inner, "");
    else
      free(inner);
  }
  if (open_folder) closedir(open_folder);
}

/* ---- the file ---- */

static bool is_within(const char *path) {
  return *path && *path != '/' && strncmp(path, "../", 3) && !strstr(path, "/../");
}

static ethd_status read_list(const char *path, summed_list *out, char *message) {
  size_t length, number = 0;
  ETHD__FREED char *text = NULL;
  *out = (summed_list){0};
  ethd_status status = ethd_text_read(path, LIST_MAX, &text, &length, message);
  if (status) return status;
  for (char *at = text, *line; !status && (line = strsep(&at, "\n")) && (*line || at);) {
    size_t n = strspn(line, "0123456789abcdef");
    number++;
    if (n != ETHD_SHA256_TEXT - 1 || strncmp(line + n, "  ", 2) != 0 || !is_within(line + n + 2)) {
      status = ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: not a line of sha256sum about a file in this folder", path,
                         number);
    } else {
      line[n] = 0;
      add(out, strdup(line + n + 2), line);
    }
  }
  sort(out);
  return status;
}

bool ethd__sums_grows(const char *path) {
  static const char *const names[] = {"*.sqlite", "taps.csv", "survey.csv", "events.csv", "participants.csv"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (!fnmatch(names[i], path, FNM_PATHNAME)) return true;
  return false;
}

static ethd_status put_list(const char *folder, const char *path, const summed_list *list, char *message) {
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(path, &replace, message);
  if (status) return status;
  for (size_t i = 0; !status && i < list->count; i++) {
    char sum[ETHD_SHA256_TEXT];
    ETHD__FREED char *whole = ethd__folder_path(folder, list->file[i].path);
    snprintf(sum, sizeof sum, "%s", list->file[i].sum);
    if (!*sum) status = ethd__sum_of_file(whole, sum, message);
    fprintf(replace.file, "%s  %s\n", sum, list->file[i].path);
  }
  if (!status) return ethd_replace_commit(&replace, message);
  ethd_replace_abandon(&replace);
  return status;
}

/* A file that was listed keeps its line, so that its loss is noticed. */
static void take_missing(const summed_list *before, summed_list *now) {
  size_t count = now->count;
  for (size_t i = 0; i < before->count; i++) {
    const summed_list there = {now->file, count};
    if (!find(&there, before->file[i].path)) add(now, strdup(before->file[i].path), before->file[i].sum);
  }
  sort(now);
}

ethd_status ethd__sums_write(const char *folder, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_STUDY_SUMS);
  summed_list before = {0}, now = {0};
  ethd_status status = ethd__file_taken(path) ? read_list(path, &before, message) : ETHD_OK;
  if (!status) {
    walk(folder, "", 0, false, &now);
    sort(&now);
    take_missing(&before, &now);
    for (size_t i = 0; i < now.count; i++) {
      const summed *old = ethd__sums_grows(now.file[i].path) ? NULL : find(&before, now.file[i].path);
      if (old) memcpy(now.file[i].sum, old->sum, sizeof old->sum);
    }
    status = put_list(folder, path, &now, message);
  }
  free_list(&before);
  free_list(&now);
  return status;
}

/* ---- checking ---- */

/* Gives the first wrong file and the number of wrong files. */
typedef struct fault {
  const char *path, *what;
  size_t count;
} fault;

static void note(fault *f, const char *path, const char *what) {
  if (!f->count++) f->path = path, f->what = what;
}

static void compare(const char *folder, const summed_list *list, const summed_list *there, fault *f) {
  char sum[ETHD_SHA256_TEXT], unsaid[ETHD_MESSAGE_MAX];
  for (size_t i = 0; i < list->count; i++) {
    ETHD__FREED char *whole = ethd__folder_path(folder, list->file[i].path);
    if (ethd__sum_of_file(whole, sum, unsaid))
      note(f, list->file[i].path, "is missing or can't be read");
    else if (strcmp(sum, list->file[i].sum))
      note(f, list->file[i].path, "isn't what it was");
  }
  for (size_t i = 0; i < there->count; i++)
    if (!find(list, there->file[i].path)) note(f, there->file[i].path, "isn't listed");
}

ethd_status ethd__sums_check(const char *folder, size_t *files, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_STUDY_SUMS);
  summed_list list = {0}, there = {0};
  fault f = {0};
  *files = 0;
  ethd_status status =
      ethd__file_taken(path)
          ? read_list(path, &list, message)
          : ethd__say(message, ETHD_STATUS_EMPTY, "%s: No such file; a session or a merge that ends writes it", path);
  if (!status) {
    walk(folder, "", 0, true, &there);
    compare(folder, &list, &there, &f);
    *files = list.count;
    if (f.count)
      status = ethd__say(message, ETHD_E_SYNTAX,
                         "%s: %s %s, and so %zu of its files don't fit %s; a session that was "
                         "killed is brought to its end by --resume",
                         folder, f.path, f.what, f.count, ETHD_STUDY_SUMS);
  }
  free_list(&list);
  free_list(&there);
  return status;
}

ethd_status ethd__sums_each(const char *folder, ethd_status (*each)(void *user, const char *path), void *user,
                            char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_STUDY_SUMS);
  summed_list list;
  ethd_status status = read_list(path, &list, message);
  for (size_t i = 0; !status && i < list.count; i++) status = each(user, list.file[i].path);
  free_list(&list);
  return status;
}
