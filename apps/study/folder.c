#include "study/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "ethd/ethd.h"
#include "record/recording_parts.h"
#include "study/dictionary.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/text.h"

#define PLANT "device.plant"
#define VERSIONS "versions.txt"
#define MOVEMENT "movement.csv"
#define DEVICE_FOLDER "device.folder"
#define BYTES_MAX ((size_t)1 << 24)

static const char *const hashed[] = {ETHD_STUDY_FILE, ETHD_RECORDING_CONFIG, ETHD_RECORDING_SCENE, PLANT};

char *ethd__folder_path(const char *folder, const char *name) {
  char *path = ethd__path_join(folder, name);
  if (!path) ethd__fail_memory();
  return path;
}

static ethd_status write_text(const char *folder, const char *name, const char *text, char *message) {
  char *path = ethd__folder_path(folder, name);
  ethd_status status = ethd_text_write(path, text, strlen(text), message);
  free(path);
  return status;
}

/* ---- what the protocol names ---- */

/* Beside the study file, else among the files that came with the programs. */
static char *find(const ethd__protocol *p, const char *name) {
  char *path = ethd__folder_path(p->folder, name);
  if (strchr(name, '/') || access(path, R_OK) == 0) return path;
  free(path);
  return ethd__data_path(name);
}

void ethd__folder_device(const ethd__protocol *p, ethd__loaded *out) {
  char *config = p->config ? find(p, p->config) : NULL;
  bool letter = p->plant && !p->plant[strcspn(p->plant, "/.")] && strlen(p->plant) == 1;
  char *plant = p->plant && !letter ? find(p, p->plant) : NULL;
  ethd__load(config, plant ? plant : p->plant, p->hands != ETHD_HANDS_PEOPLE, true, out);
  free(config);
  free(plant);
}

static ethd_status copy(const char *from, const char *folder, const char *name, char *message) {
  size_t length;
  char *text;
  ethd_status status = ethd_text_read(from, BYTES_MAX, &text, &length, message);
  if (status) return status;
  status = write_text(folder, name, text, message);
  free(text);
  return status;
}

static ethd_status write_device(const char *folder, const ethd__loaded *loaded, char *message) {
  char *config = ethd__record_config_text(loaded->config);
  if (!config) return ethd__no_memory(message, folder);
  ethd_status status = write_text(folder, ETHD_RECORDING_CONFIG, config, message);
  free(config);
  if (!status) status = write_text(folder, ETHD_RECORDING_SCENE, loaded->config->scene_text, message);
  return status ? status : copy(loaded->plant_path, folder, PLANT, message);
}

/* The configuration is copied away from the files that its device needs. */
static ethd_status write_device_folder(const char *folder, const ethd__loaded *loaded, char *message) {
  char *absolute = realpath(loaded->config->folder, NULL);
  if (!absolute) return ethd__say(message, ETHD_E_FILE, "%s: %s", loaded->config->folder, strerror(errno));
  ethd_status status = write_text(folder, DEVICE_FOLDER, absolute, message);
  free(absolute);
  return status;
}

/* ---- making ---- */

static ethd_status hash(const char *folder, char out[ETHD_SHA256_TEXT], char *message) {
  ethd__sha256 sum;
  ethd_status status = ETHD_OK;
  ethd__sha256_begin(&sum);
  for (size_t i = 0; !status && i < sizeof hashed / sizeof *hashed; i++) {
    char *path = ethd__folder_path(folder, hashed[i]), *text;
    size_t length;
    status = ethd_text_read(path, BYTES_MAX, &text, &length, message);
    if (!status) ethd__sha256_add(&sum, text, length);
    free(text);
    free(path);
  }
  ethd__sha256_end(&sum, out);
  return status;
}

static ethd_status write_versions(const char *folder, char *message) {
  char text[512], sum[ETHD_SHA256_TEXT];
  ethd_status status = hash(folder, sum, message);
  if (status) return status;
  snprintf(text, sizeof text,
           "libethd %s\ncompiler %s\nhash %s\n"
           "The hash is: cat study.ini config.ini scene.scene device.plant | sha256sum\n",
           ETHD_VERSION, __VERSION__, sum);
  return write_text(folder, VERSIONS, text, message);
}

/* The whole tap reaches the disk before a journal mentions it. */
static ethd_status settle(const char *folder, char *message) {
  int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  bool failed = fd < 0 || syncfs(fd) != 0;
  int reason = errno;
  if (fd >= 0) close(fd);
  return failed ? ethd__say(message, ETHD_E_FILE, "%s: %s", folder, strerror(reason)) : ETHD_OK;
}

static ethd_status write_files(const char *folder, const ethd__protocol *protocol, const ethd__loaded *loaded,
                               const char *finger, char *message) {
  ethd_status status = write_text(folder, ETHD_STUDY_FILE, protocol->text, message);
  if (!status) status = write_device(folder, loaded, message);
  if (!status && finger) status = copy(finger, folder, MOVEMENT, message);
  if (!status && protocol->hands == ETHD_HANDS_PEOPLE) status = write_device_folder(folder, loaded, message);
  if (!status) status = write_text(folder, "README.md", ethd__dictionary, message);
  if (!status) status = write_versions(folder, message);
  return status ? status : settle(folder, message);
}

/* ---- what is there already ---- */

static const char *const own[] = {ETHD_STUDY_FILE, ETHD_RECORDING_CONFIG, ETHD_RECORDING_SCENE, PLANT,
                                  MOVEMENT,        DEVICE_FOLDER,         "README.md",          VERSIONS,
                                  ETHD_STUDY_TAPS, ETHD_STUDY_SURVEY,     ETHD_STUDY_EVENTS,    NULL};

/* Whether a file of the folder says the same; without such a file it doesn't. */
static bool says(const char *folder, const char *name, const char *text, size_t length) {
  char unsaid[ETHD_MESSAGE_MAX], *path = ethd__folder_path(folder, name), *there;
  size_t n;
  bool same = !ethd_text_read(path, BYTES_MAX, &there, &n, unsaid) && n == length && !memcmp(there, text, n);
  free(there);
  free(path);
  return same;
}

static bool says_file(const char *folder, const char *name, const char *from) {
  char unsaid[ETHD_MESSAGE_MAX], *text;
  size_t n;
  bool same = !ethd_text_read(from, BYTES_MAX, &text, &n, unsaid) && says(folder, name, text, n);
  free(text);
  return same;
}

static bool is_same_study(const char *folder, const ethd__protocol *protocol, const ethd__loaded *loaded,
                          const char *finger) {
  char *config = ethd__record_config_text(loaded->config);
  const char *scene = loaded->config->scene_text;
  bool same = config && says(folder, ETHD_RECORDING_CONFIG, config, strlen(config)) &&
              says(folder, ETHD_STUDY_FILE, protocol->text, strlen(protocol->text)) &&
              says(folder, ETHD_RECORDING_SCENE, scene, strlen(scene)) &&
              says_file(folder, PLANT, loaded->plant_path) && (!finger || says_file(folder, MOVEMENT, finger));
  free(config);
  return same;
}

static bool exists(const char *folder, const char *name) {
  char *path = ethd__folder_path(folder, name);
  bool there = access(path, F_OK) == 0;
  free(path);
  return there;
}

static bool is_input(const char *folder, const ethd__protocol *protocol, const ethd__loaded *loaded,
                     const char *finger) {
  const char *const inputs[] = {protocol->path, loaded->path, loaded->plant_path, finger};
  for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++)
    if (inputs[i] && ethd__claim_holds(folder, own, inputs[i])) return true;
  return false;
}

/* Nothing of another study is written over, nor what the study is made of. versions.txt is written last: a folder
   without it is one that a killed program began, or somebody's own. */
static ethd_status make(const char *folder, const ethd__protocol *protocol, const ethd__loaded *loaded,
                        const char *finger, char *message) {
  size_t length = strlen(protocol->text);
  if (is_input(folder, protocol, loaded, finger))
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: the study is made of files in it; another folder is needed",
                     folder);
  if (exists(folder, VERSIONS) && is_same_study(folder, protocol, loaded, finger)) return ETHD_OK;
  bool begun = !exists(folder, VERSIONS) && says(folder, ETHD_STUDY_FILE, protocol->text, length);
  for (int i = 0; own[i] && !begun; i++)
    if (exists(folder, own[i]))
      return ethd__say(message, ETHD_E_ARGUMENT, "%s: holds %s, of another study or your own; another folder is needed",
                       folder, own[i]);
  return write_files(folder, protocol, loaded, finger, message);
}

ethd_status ethd__folder_make(const char *folder, const ethd__protocol *protocol, const ethd__loaded *loaded,
                              const char *finger, char message[ETHD_MESSAGE_MAX]) {
  ethd__claim claim;
  ethd_status status = ethd__claim_wait(folder, &claim, message);
  if (!status) status = make(folder, protocol, loaded, finger, message);
  ethd__claim_release(&claim);
  return status;
}

/* ---- opening ---- */

static ethd_status read_device_folder(const char *folder, char **out, char *message) {
  size_t length;
  char *path = ethd__folder_path(folder, DEVICE_FOLDER);
  ethd_status status = ethd_text_read(path, 1 << 16, out, &length, message);
  free(path);
  return status;
}

ethd_status ethd__folder_read(const char *folder, ethd__folder *out, char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__folder){.path = ethd__folder_path(folder, "")};
  out->path[strlen(out->path) - 1] = 0;
  char *study = ethd__folder_path(folder, ETHD_STUDY_FILE);
  ethd_status status = ethd__protocol_load(study, &out->protocol, message);
  if (!status) status = hash(folder, out->hash, message);
  free(study);
  if (status) ethd__folder_close(out);
  return status;
}

ethd_status ethd__folder_open(const char *folder, bool plugins, ethd__folder *out, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__folder_read(folder, out, message);
  if (status) return status;
  char *config = ethd__folder_path(folder, ETHD_RECORDING_CONFIG), *plant = ethd__folder_path(folder, PLANT);
  ethd__load(config, plant, out->protocol.hands != ETHD_HANDS_PEOPLE, plugins, &out->loaded);
  free(config);
  free(plant);
  out->finger = ethd__folder_path(folder, MOVEMENT);
  if (access(out->finger, F_OK) != 0) {
    free(out->finger);
    out->finger = NULL;
  }
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
