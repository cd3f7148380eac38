#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sim/plant.h"
#include "text/error_text.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 16)

static ethd_status fill(const ethd__key_file *file, ethd_plant *out) {
  ethd_error error;
  ethd_status status = ethd__keys_known(file, NULL, ethd__plant_rows, ethd__plant_row_count, NULL);
  memset(out, 0, sizeof *out);
  ethd_plant_finger(out, ETHD_READING_CENTRE);
  if (!status) status = ethd__keys_read(file, NULL, 0, ethd__plant_rows, ethd__plant_row_count, out);
  if (status) return status;
  status = ethd__plant_check(out, &error);
  if (status) ethd_error_text(file->name, &error, file->message);
  return status;
}

ethd_status ethd__plant_read(const char *path, const char *name, ethd_plant *out, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *text = NULL;
  size_t length;
  ethd_ini ini;
  ethd_status status = ethd_text_read(path, BYTES_MAX, &text, &length, message);
  if (status) return status;
  status = ethd_ini_parse(text, length, name, NULL, NULL, &ini, message);
  if (status) return status;
  status = fill(&(ethd__key_file){&ini, name, message}, out);
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
  ETHD__FREED char *bin = ethd__path_folder(program);
  ETHD__FREED char *share = bin ? ethd__path_join(bin, "../share/ethd") : NULL;
  return share ? ethd__path_join(share, file) : NULL;
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
