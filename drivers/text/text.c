#include "text/text.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text/error_text.h"

static ethd_status refuse(const char *path, char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno));
}

/* ---- reading ---- */

static ethd_status read_all(FILE *file, const char *path, size_t most, char **text, size_t *length, char *message) {
  struct stat info;
  size_t room = 65536, n = 0, got;
  if (fstat(fileno(file), &info) == 0 && info.st_size > 0 && (size_t)info.st_size <= most)
    room = (size_t)info.st_size + 2;
  char *buffer = malloc(room);
  while (buffer && (got = fread(buffer + n, 1, room - 1 - n, file)) > 0) {
    n += got;
    if (n > most) {
      free(buffer);
      return ethd__say(message, ETHD_E_FILE, "%s: too long, at most %zu bytes are allowed", path, most);
    }
    if (n == room - 1) {
      char *more = realloc(buffer, room * 2);
      if (!more) free(buffer);
      buffer = more;
      room *= 2;
    }
  }
  if (!buffer) return ethd__say(message, ETHD_E_MEMORY, "%s: %s", path, ethd_status_sentence(ETHD_E_MEMORY));
  if (ferror(file)) {
    free(buffer);
    return refuse(path, message);
  }
  buffer[n] = 0;
  *text = buffer;
  *length = n;
  return ETHD_OK;
}

ethd_status ethd_text_read(const char *path, size_t most, char **text, size_t *length, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  *text = NULL;
  *length = 0;
  FILE *file = fopen(path, "rbe");
  if (!file) return refuse(path, message);
  ethd_status status;
  if (fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode))
    status = ethd__say(message, ETHD_E_FILE, "%s: is a folder, a file is needed", path);
  else if (S_ISREG(info.st_mode) && (uintmax_t)info.st_size > most)
    status =
        ethd__say(message, ETHD_E_FILE, "%s: %jd bytes, at most %zu are allowed", path, (intmax_t)info.st_size, most);
  else
    status = read_all(file, path, most, text, length, message);
  fclose(file);
  return status;
}

/* ---- writing ---- */

static ethd_status in_place(const char *path, ethd_replace *out, char *message) {
  out->file = fopen(path, "wbe");
  if (!out->file) return refuse(path, message);
  out->path = strdup(path);
  return ETHD_OK;
}

/* A fresh file in the target's own folder, so that the rename stays within one file system. */
static FILE *beside(const char *path, mode_t mode, char **temporary) {
  static unsigned count;
  for (int attempt = 0; attempt < 100; attempt++) {
    if (asprintf(temporary, "%s.%ld-%u.new", path, (long)getpid(), count++) < 0) break;
    int fd = open(*temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (fd >= 0) return fdopen(fd, "wb");
    free(*temporary);
    if (errno != EEXIST) break;
  }
  *temporary = NULL;
  return NULL;
}

ethd_status ethd_replace_begin(const char *path, ethd_replace *out, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  *out = (ethd_replace){0};
  bool exists = stat(path, &info) == 0;
  if (exists && S_ISDIR(info.st_mode))
    return ethd__say(message, ETHD_E_FILE, "%s: is a folder, a file's name is needed", path);
  if (exists && !S_ISREG(info.st_mode)) return in_place(path, out, message);
  if (exists && access(path, W_OK) != 0) return refuse(path, message);
  out->path = exists ? realpath(path, NULL) : strdup(path);
  if (!out->path) return refuse(path, message);
  out->file = beside(out->path, exists ? info.st_mode & 0777 : 0666, &out->temporary);
  if (out->file) return ETHD_OK;
  ethd_status status = refuse(path, message);
  free(out->path);
  *out = (ethd_replace){0};
  return status;
}

static void release(ethd_replace *replace) {
  free(replace->path);
  free(replace->temporary);
  *replace = (ethd_replace){0};
}

ethd_status ethd_replace_commit(ethd_replace *replace, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  const char *path = replace->path ? replace->path : "output";
  errno = 0;
  bool failed = ferror(replace->file) != 0;
  failed |= fclose(replace->file) != 0;
  if (!failed && replace->temporary) failed = rename(replace->temporary, replace->path) != 0;
  if (failed) {
    status =
        errno ? refuse(path, message) : ethd__say(message, ETHD_E_FILE, "%s: a write failed; is there room?", path);
    if (replace->temporary) unlink(replace->temporary);
  }
  release(replace);
  return status;
}

void ethd_replace_abandon(ethd_replace *replace) {
  if (replace->file) fclose(replace->file);
  if (replace->temporary) unlink(replace->temporary);
  release(replace);
}

ethd_status ethd_text_write(const char *path, const char *text, size_t length, char message[ETHD_MESSAGE_MAX]) {
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(path, &replace, message);
  if (status) return status;
  fwrite(text, 1, length, replace.file);
  return ethd_replace_commit(&replace, message);
}

/* ---- numbers and paths ---- */

static const char *digits(const char *p, const char *end) {
  while (p < end && isdigit((unsigned char)*p)) p++;
  return p;
}

const char *ethd__decimal(const char *p, const char *end) {
  const char *whole = p;
  p = digits(p, end);
  size_t count = (size_t)(p - whole);
  if (p < end && *p == '.') {
    const char *fraction = ++p;
    p = digits(p, end);
    count += (size_t)(p - fraction);
  }
  if (!count) return NULL;
  if (p < end && (*p == 'e' || *p == 'E')) {
    p++;
    if (p < end && (*p == '+' || *p == '-')) p++;
    const char *exponent = p;
    p = digits(p, end);
    if (p == exponent) return NULL;
  }
  return p;
}

static bool is_word(const char *text, size_t length, const char *word) {
  return length == strlen(word) && strncasecmp(text, word, length) == 0;
}

bool ethd__number(const char *text, size_t length, double *out) {
  const char *p = text, *end = text + length;
  if (is_word(text, length, "nan")) return *out = NAN, true;
  if (p < end && (*p == '+' || *p == '-')) p++;
  if (is_word(p, (size_t)(end - p), "inf")) return *out = *text == '-' ? -INFINITY : INFINITY, true;
  if (ethd__decimal(p, end) != end) return false;
  *out = strtod(text, NULL);
  return isfinite(*out);
}

char *ethd__path_join(const char *folder, const char *path) {
  char *joined;
  if (path[0] == '/' || !folder || !folder[0]) return strdup(path);
  return asprintf(&joined, "%s/%s", folder, path) < 0 ? NULL : joined;
}

char *ethd__path_folder(const char *path) {
  const char *slash = strrchr(path, '/');
  if (!slash) return strdup(".");
  return slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
}
