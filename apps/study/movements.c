#include "study/movements.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

static char *folder_of(const ethd__protocol *p) {
  char *root = ethd__motion_folder(), *folder = ethd__path_join(root, p->motion);
  free(root);
  return folder;
}

static int is_csv(const struct dirent *entry) {
  size_t n = strlen(entry->d_name);
  return n > 4 && entry->d_name[0] != '.' && !strcmp(entry->d_name + n - 4, ".csv");
}

static ethd_status list(const char *folder, char ***files, size_t *count, char *message) {
  struct dirent **entries = NULL;
  int fd = ethd__file_open(folder, O_RDONLY | O_DIRECTORY, 0);
  int n = fd < 0 ? -1 : scandirat(fd, ".", &entries, is_csv, alphasort);
  bool failed = n < 0;
  if (fd >= 0) close(fd);
  *files = calloc(n > 0 ? (size_t)n : 1, sizeof **files);
  for (int i = 0; i < n; i++) {
    char *path = *files ? ethd__path_join(folder, entries[i]->d_name) : NULL;
    if (path) (*files)[(*count)++] = path;
    failed |= !path;
    free(entries[i]);
  }
  free(entries);
  if (!failed && n > 0) return ETHD_OK;
  return ethd__say(message, ETHD_E_FILE,
                   "%s: no folder with recorded movements (*.csv); ETHD_MOTION_DIR may name the one it is in", folder);
}

ethd_status ethd__movements_list(const char *path, char ***files, size_t *count, char message[ETHD_MESSAGE_MAX]) {
  struct stat what;
  *count = 0;
  *files = NULL;
  if (!ethd__file_look(path, &what) && S_ISDIR(what.st_mode)) return list(path, files, count, message);
  *files = calloc(1, sizeof **files);
  char *copy = *files ? strdup(path) : NULL;
  if (copy) (*files)[(*count)++] = copy;
  return copy ? ETHD_OK : ethd__no_memory(message, path);
}

ethd_status ethd__movements_find(const ethd__protocol *protocol, const char *finger, char ***files, size_t *count,
                                 char message[ETHD_MESSAGE_MAX]) {
  *count = 0;
  *files = NULL;
  if (finger) return ethd__movements_list(finger, files, count, message);
  if (!protocol->motion)
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: hand.source: recorded needs motion = FOLDER or --finger",
                     protocol->path);
  char *folder = folder_of(protocol);
  ethd_status status = folder ? list(folder, files, count, message) : ETHD_E_MEMORY;
  free(folder);
  return status;
}

void ethd__movements_free(char **files, size_t count) {
  for (size_t i = 0; i < count; i++) free(files[i]);
  free(files);
}
