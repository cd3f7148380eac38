#include "study/folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "record/recording_parts.h"
#include "study/movements.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

static const char *const hashed[] = {ETHD_STUDY_FILE, ETHD_RECORDING_CONFIG, ETHD_RECORDING_SCENE, ETHD_STUDY_PLANT,
                                     ETHD_STUDY_CONDITIONS_FILE};

/* folder/name if the file or folder exists, else NULL. */
static char *existing(const char *folder, const char *name) {
  char *path = ethd__folder_path(folder, name);
  if (ethd__file_taken(path)) return path;
  free(path);
  return NULL;
}

/* ---- what the protocol names ---- */

/* A file is looked for beside the study file, then among the files installed with the programs. */
static char *find(const ethd__protocol *p, const char *name) {
  char *path = ethd__folder_path(p->folder, name);
  if (strchr(name, '/') || access(path, R_OK) == 0) return path;
  free(path);
  return ethd__data_path(name);
}

ethd_status ethd__folder_conditions(ethd__protocol *p, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *path = p->conditions ? ethd__folder_path(p->folder, p->conditions) : NULL;
  return ethd__protocol_conditions(p, path, message);
}

void ethd__folder_device(const ethd__protocol *p, ethd__loaded *out) {
  ETHD__FREED char *config = p->config ? find(p, p->config) : NULL;
  bool letter = p->plant && !p->plant[strcspn(p->plant, "/.")] && strlen(p->plant) == 1;
  ETHD__FREED char *plant = p->plant && !letter ? find(p, p->plant) : NULL;
  ethd__load(config, plant ? plant : p->plant, p->hands != ETHD_HANDS_PEOPLE, true, out);
  ETHD__FREED char *scene = p->scene ? find(p, p->scene) : NULL;
  if (scene) ethd__load_scene(out, scene);
}

/* ---- the hash ---- */

static ethd_status add_file(ethd__sha256 *sum, const char *path, char *message) {
  ETHD__FREED char *text = NULL;
  size_t length;
  ethd_status status = ethd_text_read(path, ETHD_STUDY_INPUT_MAX, &text, &length, message);
  if (!status) ethd__sha256_add(sum, text, length);
  return status;
}

/* Adds the movement for all hands, or each file of the folder of movements in the order of their names. */
static ethd_status add_movements(ethd__sha256 *sum, const char *finger, char *message) {
  char **files;
  size_t count;
  ethd_status status = ethd__movements_list(finger, &files, &count, message);
  for (size_t i = 0; !status && i < count; i++) status = add_file(sum, files[i], message);
  ethd__movements_free(files, count);
  return status;
}

static char *finger_of(const char *folder) {
  char *finger = existing(folder, ETHD_STUDY_MOVEMENT);
  return finger ? finger : existing(folder, ETHD_STUDY_MOVEMENTS);
}

ethd_status ethd__folder_hash(const char *folder, char out[ETHD_SHA256_TEXT], char message[ETHD_MESSAGE_MAX]) {
  ethd__sha256 sum;
  ethd_status status = ETHD_OK;
  ETHD__FREED char *finger = finger_of(folder);
  ethd__sha256_begin(&sum);
  for (size_t i = 0; !status && i < sizeof hashed / sizeof *hashed; i++) {
    ETHD__FREED char *path = strcmp(hashed[i], ETHD_STUDY_CONDITIONS_FILE) ? ethd__folder_path(folder, hashed[i])
                                                                           : existing(folder, hashed[i]);
    if (path) status = add_file(&sum, path, message);
  }
  if (!status && finger) status = add_movements(&sum, finger, message);
  ethd__sha256_end(&sum, out);
  return status;
}

/* ---- opening ---- */

static ethd_status read_device_folder(const char *folder, char **out, char *message) {
  size_t length;
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_STUDY_DEVICE_FOLDER);
  return ethd_text_read(path, 1 << 16, out, &length, message);
}

uint32_t ethd__folder_simulated(const char *folder) {
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_STUDY_VERSIONS), *text = NULL;
  char unsaid[ETHD_MESSAGE_MAX];
  size_t length;
  unsigned people = 0;
  if (!ethd_text_read(path, 1 << 16, &text, &length, unsaid)) {
    const char *line = strstr(text, "\nsimulated ");
    if (line && (sscanf(line, " simulated %u", &people) != 1 || people > ETHD_STUDY_PEOPLE)) people = 0;
  }
  return people;
}

/* Names the kind of a folder without a study, if known, and the program that shows it. */
static ethd_status no_study(const char *folder, ethd_status status, char *message) {
  ETHD__FREED char *ticks = existing(folder, ETHD_RECORDING_TICK), *study = existing(folder, ETHD_STUDY_FILE);
  if (ticks && !study)
    status =
        ethd__say(message, ETHD_E_ARGUMENT,
                  "%s: a recording, not a study's folder: ethd-replay --verify %s checks it, ethd-convert %s NAME.csv "
                  "or NAME.mcap makes a table of it",
                  folder, folder, folder);
  return status;
}

ethd_status ethd__folder_read(const char *folder, ethd__folder *out, char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__folder){.path = ethd__folder_path(folder, "")};
  out->path[strlen(out->path) - 1] = 0;
  ETHD__FREED char *study = ethd__folder_path(folder, ETHD_STUDY_FILE);
  ethd_status status = ethd__protocol_load(study, &out->protocol, message);
  ETHD__FREED char *conditions = ethd__folder_path(folder, ETHD_STUDY_CONDITIONS_FILE);
  if (!status) status = ethd__protocol_conditions(&out->protocol, conditions, message);
  if (!status) status = ethd__folder_hash(folder, out->hash, message);
  if (status == ETHD_E_FILE) status = no_study(folder, status, message);
  out->simulated = ethd__folder_simulated(folder);
  if (!status && out->simulated) out->protocol.participants = out->simulated;
  if (status) ethd__folder_close(out);
  return status;
}

ethd_status ethd__folder_open(const char *folder, bool plugins, ethd__folder *out, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__folder_read(folder, out, message);
  if (status) return status;
  ETHD__FREED char *config = ethd__folder_path(folder, ETHD_RECORDING_CONFIG),
                   *plant = ethd__folder_path(folder, ETHD_STUDY_PLANT);
  ethd__load(config, plant, out->protocol.hands != ETHD_HANDS_PEOPLE, plugins, &out->loaded);
  out->finger = finger_of(folder);
  if (out->protocol.hands == ETHD_HANDS_PEOPLE) status = read_device_folder(folder, &out->device, message);
  if (status) ethd__folder_close(out);
  return status;
}

void ethd__folder_close(ethd__folder *folder) {
  ethd__protocol_free(&folder->protocol);
  ethd__loaded_free(&folder->loaded);
  free(folder->path);
  free(folder->finger);
  free(folder->device);
  folder->path = folder->finger = folder->device = NULL;
}
