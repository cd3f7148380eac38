#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sim/plant.h"
#include "text/error_text.h"
#include "text/key.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 16)

static ethd_status set(const char *path, const ethd__plant_row *row, const ethd_ini *ini, ethd_plant *out,
                       char *message) {
  const ethd_ini_key *key = ethd_ini_find(ini, row->section, row->param.name);
  char *at = (char *)out + row->offset;
  if (!key)
    return ethd__say(message, ETHD_E_UNKNOWN, "%s: %s.%s is missing, a plant file needs every key", path, row->section,
                     row->param.name);
  const ethd__key found = ethd__key_of(path, key, message);
  double value;
  ethd_status status = ethd__key_value(&found, &row->param, false, &value);
  if (status) return status;
  if (ethd_param_words(&row->param))
    memcpy(at, &(int32_t){(int32_t)value}, sizeof(int32_t));
  else
    memcpy(at, &value, sizeof value);
  return ETHD_OK;
}

static bool is_known(const ethd_ini_key *key) {
  for (size_t i = 0; i < ethd__plant_row_count; i++)
    if (!strcmp(ethd__plant_rows[i].section, key->section) && !strcmp(ethd__plant_rows[i].param.name, key->key))
      return true;
  return false;
}

static ethd_status fill(const char *path, const ethd_ini *ini, ethd_plant *out, char *message) {
  ethd_error error;
  for (uint32_t i = 0; i < ini->count; i++)
    if (!is_known(&ini->keys[i]))
      return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: %s.%s: a plant has no such key", path, ini->keys[i].line,
                       ini->keys[i].section, ini->keys[i].key);
  memset(out, 0, sizeof *out);
  ethd_plant_finger(out, ETHD_READING_CENTRE);
  for (size_t i = 0; i < ethd__plant_row_count; i++) {
    ethd_status status = set(path, &ethd__plant_rows[i], ini, out, message);
    if (status) return status;
  }
  ethd_status status = ethd__plant_check(out, &error);
  if (status) ethd_error_text(path, &error, message);
  return status;
}

ethd_status ethd__plant_read(const char *path, const char *name, ethd_plant *out, char message[ETHD_MESSAGE_MAX]) {
  char *text;
  size_t length;
  ethd_ini ini;
  ethd_status status = ethd_text_read(path, BYTES_MAX, &text, &length, message);
  if (status) return status;
  status = ethd_ini_parse(text, length, name, NULL, NULL, &ini, message);
  free(text);
  if (status) return status;
  status = fill(name, &ini, out, message);
  ethd_ini_free(&ini);
  return status;
}

ethd_status ethd_plant_load(const char *path, ethd_plant *out, char message[ETHD_MESSAGE_MAX]) {
  return ethd__plant_read(path, path, out, message);
}

/* ---- where it is ---- */

static char *came_with_programs(const char *file) {
  const char *given = getenv("ETHD_DATA_DIR");
  if (given && *given) return ethd__path_join(given, file);
  char program[PATH_MAX];
  ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length > 0 ? length : 0] = 0;
  char *bin = ethd__path_folder(program);
  char *share = bin ? ethd__path_join(bin, "../share/ethd") : NULL;
  char *path = share ? ethd__path_join(share, file) : NULL;
  free(share);
  free(bin);
  return path;
}

char *ethd__plant_path(const char *plant, const char *folder) {
  char file[64];
  size_t length = strlen(plant);
  if (strpbrk(plant, "/.") || length > sizeof file - sizeof ".plant") return ethd__path_join(folder, plant);
  memcpy(file, plant, length);
  strcpy(file + length, ".plant");
  char *beside = ethd__path_join(folder, file);
  if (!beside || access(beside, R_OK) == 0) return beside;
  char *shared = came_with_programs(file);
  if (!shared || access(shared, R_OK) != 0) {
    free(shared);
    return beside;
  }
  free(beside);
  return shared;
}
