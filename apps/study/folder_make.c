#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "ethd/ethd.h"
#include "record/recording_parts.h"
#include "study/columns.h"
#include "study/dictionary.h"
#include "study/folder.h"
#include "study/movements.h"
#include "study/plan.h"
#include "study/sums.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

/* A file that the folder must hold, with its text. */
typedef struct wanted_file {
  char *name, *text;
  size_t length;
  bool hashed; /* identifies the study */
} wanted_file;

typedef struct wanted_list {
  const ethd__folder_parts *parts;
  wanted_file *file;
  size_t count;
  char *message;
} wanted_list;

/* ---- what is wanted ---- */

/* Takes over the text, which may be NULL: no memory. */
static void want(wanted_list *list, const char *name, char *text, size_t length, bool hashed) {
  wanted_file *more = realloc(list->file, (list->count + 1) * sizeof *more);
  char *copy = strdup(name);
  if (!more || !copy || !text) ethd__fail_memory();
  list->file = more;
  list->file[list->count++] = (wanted_file){copy, text, length, hashed};
}

static void want_text(wanted_list *list, const char *name, char *text, bool hashed) {
  want(list, name, text, text ? strlen(text) : 0, hashed);
}

static ethd_status want_copy(wanted_list *list, const char *name, const char *from) {
  char *text;
  size_t length;
  ethd_status status = ethd_text_read(from, ETHD_STUDY_INPUT_MAX, &text, &length, list->message);
  if (!status) want(list, name, text, length, true);
  return status;
}

static ethd_status want_movements(wanted_list *list) {
  const ethd__folder_parts *parts = list->parts;
  char **files = NULL;
  size_t count = 0;
  if (parts->finger) return want_copy(list, ETHD_STUDY_MOVEMENT, parts->finger);
  if (parts->protocol->hands != ETHD_HANDS_RECORDED) return ETHD_OK;
  ethd_status status = ethd__movements_find(parts->protocol, NULL, &files, &count, list->message);
  for (size_t i = 0; !status && i < count; i++) {
    ETHD__FREED char *name = ethd__folder_path(ETHD_STUDY_MOVEMENTS, strrchr(files[i], '/') + 1);
    status = want_copy(list, name, files[i]);
  }
  ethd__movements_free(files, count);
  return status;
}

static ethd__table_scope scope_of(const wanted_list *list) {
  return (ethd__table_scope){list->parts->protocol,
                             list->parts->simulated ? &list->parts->loaded->config->setup : NULL};
}

static void want_sidecars(wanted_list *list) {
  const ethd__table_scope scope = scope_of(list);
  for (int i = 0; i < ETHD_TABLES; i++) {
    char name[40];
    snprintf(name, sizeof name, "%s.json", ethd__table_names[i]);
    want_text(list, name, ethd__table_sidecar((ethd__study_table)i, &scope), false);
  }
  want_text(list, "dataset_description.json", ethd__dataset_describe(list->parts->protocol), false);
}

static ethd_status want_all(wanted_list *list) {
  const ethd__table_scope scope = scope_of(list);
  const ethd__folder_parts *parts = list->parts;
  const ethd_config *config = parts->loaded->config;
  want_text(list, ETHD_STUDY_FILE, strdup(parts->protocol->text), true);
  want_text(list, ETHD_RECORDING_CONFIG, ethd__record_config_text(config), true);
  want_text(list, ETHD_RECORDING_SCENE, strdup(config->scene_text), true);
  ethd_status status = want_copy(list, ETHD_STUDY_PLANT, parts->loaded->plant_path);
  if (!status && parts->protocol->conditions)
    status = want_copy(list, ETHD_STUDY_CONDITIONS_FILE, parts->protocol->condition_path);
  if (!status) status = want_movements(list);
  if (status) return status;
  want_text(list, "README.md", ethd__dictionary(&scope), false);
  if (parts->protocol->participants <= ETHD_STUDY_PLANNED)
    want_text(list, "orders.csv", ethd__plan_table(parts->protocol), false);
  want_sidecars(list);
  if (parts->protocol->hands != ETHD_HANDS_PEOPLE) return ETHD_OK;
  /* the copied configuration is no longer beside the files of its device */
  char *absolute = realpath(config->folder, NULL);
  if (!absolute) return ethd__say(list->message, ETHD_E_FILE, "%s: %s", config->folder, strerror(errno));
  want_text(list, ETHD_STUDY_DEVICE_FOLDER, absolute, false);
  return ETHD_OK;
}

/* ---- what is there already ---- */

static bool exists(const char *folder, const char *name) {
  ETHD__FREED char *path = ethd__folder_path(folder, name);
  return ethd__file_taken(path);
}

/* Whether the folder holds this file with the same text. */
static bool says(const char *folder, const wanted_file *file) {
  char unsaid[ETHD_MESSAGE_MAX];
  ETHD__FREED char *path = ethd__folder_path(folder, file->name), *there = NULL;
  size_t n;
  return !ethd_text_read(path, ETHD_STUDY_INPUT_MAX, &there, &n, unsaid) && n == file->length &&
         !memcmp(there, file->text, n);
}

static ethd_status refuse(const wanted_list *list, const char *folder, const char *name) {
  return ethd__say(list->message, ETHD_E_ARGUMENT,
                   "%s: holds %s, of another study or your own; another folder is needed", folder, name);
}

/* Since versions.txt is written last, this folder is complete. */
static ethd_status compare_whole(const wanted_list *list, const char *folder) {
  ethd__folder there;
  uint32_t simulated = list->parts->simulated;
  for (size_t i = 0; i < list->count; i++)
    if (list->file[i].hashed && !says(folder, &list->file[i])) return refuse(list, folder, list->file[i].name);
  ethd_status status = ethd__folder_read(folder, &there, list->message);
  if (status) return status;
  if (there.simulated != simulated)
    status = there.simulated ? ethd__say(list->message, ETHD_E_ARGUMENT,
                                         "%s: holds a simulation of %u participant%s; another folder is needed for %u",
                                         folder, there.simulated, ethd__s(there.simulated), simulated)
                             : refuse(list, folder, "a session");
  ethd__folder_close(&there);
  return status;
}

/* This folder is empty, was begun by a program that was killed, or belongs to somebody else. */
static ethd_status compare_begun(const wanted_list *list, const char *folder) {
  static const char *const later[] = {ETHD_STUDY_TAPS, ETHD_STUDY_SURVEY, ETHD_STUDY_EVENTS, ETHD_STUDY_PARTICIPANTS,
                                      ETHD_STUDY_SUMS};
  for (size_t i = 0; i < list->count; i++)
    if (exists(folder, list->file[i].name) && !says(folder, &list->file[i]))
      return refuse(list, folder, list->file[i].name);
  for (size_t i = 0; i < sizeof later / sizeof *later; i++)
    if (exists(folder, later[i])) return refuse(list, folder, later[i]);
  return ETHD_OK;
}

/* Whether the folder would overwrite one of the files that the study is read from. */
static bool is_input(const wanted_list *list, const char *folder) {
  const ethd__folder_parts *parts = list->parts;
  const char *const inputs[] = {parts->protocol->path, parts->loaded->path, parts->loaded->plant_path, parts->finger};
  ETHD__FREED const char **own = calloc(list->count + 2, sizeof *own);
  bool found = false;
  if (!own) ethd__fail_memory();
  for (size_t i = 0; i < list->count; i++) own[i] = list->file[i].name;
  own[list->count] = ETHD_STUDY_VERSIONS;
  for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++)
    found |= inputs[i] && ethd__claim_holds(folder, own, inputs[i]);
  return found;
}

/* ---- writing ---- */

static ethd_status write_versions(const wanted_list *list, const char *folder) {
  char sum[ETHD_SHA256_TEXT];
  const ethd_config *config = list->parts->loaded->config;
  ethd__printed text;
  ethd_status status = ethd__folder_hash(folder, sum, list->message);
  if (status) return status;
  FILE *file = ethd__print_begin(&text);
  fprintf(file, "libethd %s\ncompiler %s\nhash %s\n", ETHD_VERSION, __VERSION__, sum);
  fputs("The hash is: cat", file);
  for (size_t i = 0; i < list->count; i++)
    if (list->file[i].hashed && strncmp(list->file[i].name, ETHD_STUDY_MOVEMENTS "/", 10))
      fprintf(file, " %s", list->file[i].name);
  if (exists(folder, ETHD_STUDY_MOVEMENTS)) fputs(" " ETHD_STUDY_MOVEMENTS "/*.csv", file);
  fputs(" | sha256sum\n", file);
  if (list->parts->simulated) fprintf(file, "simulated %u\n", list->parts->simulated);
  for (uint32_t i = 0; !status && i < config->plugin_count; i++) {
    status = ethd__sum_of_file(config->plugins[i], sum, list->message);
    fprintf(file, "plugin %s %s\n", sum, config->plugins[i]);
  }
  ethd__print_end(&text);
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_STUDY_VERSIONS);
  if (!status) status = ethd_text_write(path, text.text, text.length, list->message);
  free(text.text);
  return status;
}

/* Everything must reach the disk before the store mentions it. */
static ethd_status settle(const char *folder, char *message) {
  int fd = ethd__file_open(folder, O_RDONLY | O_DIRECTORY, 0);
  bool failed = fd < 0 || syncfs(fd) != 0;
  int reason = errno;
  if (fd >= 0) close(fd);
  return failed ? ethd__say(message, ETHD_E_FILE, "%s: %s", folder, strerror(reason)) : ETHD_OK;
}

static ethd_status write_all(const wanted_list *list, const char *folder) {
  ethd_status status = ETHD_OK;
  ETHD__FREED char *movements = ethd__folder_path(folder, ETHD_STUDY_MOVEMENTS);
  if (list->parts->protocol->hands == ETHD_HANDS_RECORDED && !list->parts->finger)
    (void)ethd__file_make_folder(movements);
  for (size_t i = 0; !status && i < list->count; i++) {
    ETHD__FREED char *path = ethd__folder_path(folder, list->file[i].name);
    status = ethd_text_write(path, list->file[i].text, list->file[i].length, list->message);
  }
  if (!status) status = write_versions(list, folder);
  return status ? status : settle(folder, list->message);
}

static ethd_status make(const wanted_list *list, const char *folder) {
  if (is_input(list, folder))
    return ethd__say(list->message, ETHD_E_ARGUMENT, "%s: the study is made of files in it; another folder is needed",
                     folder);
  if (exists(folder, ETHD_STUDY_VERSIONS)) return compare_whole(list, folder);
  ethd_status status = compare_begun(list, folder);
  return status ? status : write_all(list, folder);
}

static void drop(wanted_list *list) {
  for (size_t i = 0; i < list->count; i++) {
    free(list->file[i].name);
    free(list->file[i].text);
  }
  free(list->file);
}

ethd_status ethd__folder_make(const char *folder, const ethd__folder_parts *parts, char message[ETHD_MESSAGE_MAX]) {
  wanted_list list = {.parts = parts, .message = message};
  ethd__claim claim = ETHD_CLAIM_NONE;
  ethd_status status = want_all(&list);
  if (!status) status = ethd__claim_wait(folder, &claim, message);
  if (!status) status = make(&list, folder);
  ethd__claim_release(&claim);
  drop(&list);
  return status;
}

ethd_status ethd__folder_plan_hash(const ethd__folder_parts *parts, char out[ETHD_SHA256_TEXT],
                                   char message[ETHD_MESSAGE_MAX]) {
  wanted_list list = {.parts = parts, .message = message};
  ethd__sha256 sum;
  ethd_status status = want_all(&list);
  ethd__sha256_begin(&sum);
  for (size_t i = 0; i < list.count; i++)
    if (list.file[i].hashed) ethd__sha256_add(&sum, list.file[i].text, list.file[i].length);
  ethd__sha256_end(&sum, out);
  drop(&list);
  return status;
}
