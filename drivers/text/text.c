#include "text/text.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
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
  if (!buffer) return ethd__no_memory(message, path);
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
  if (!*path) return ethd__say(message, ETHD_E_FILE, "\"\": a file's name is needed");
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

static bool same_file(const struct stat *a, const struct stat *b) {
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Returns the stream if the path is our own standard output under a name such as /dev/stdout, which may be a file; else
   -1. */
static int own_stream(const struct stat *info) {
  struct stat stream;
  for (int fd = STDOUT_FILENO; fd <= STDERR_FILENO; fd++)
    if (fstat(fd, &stream) == 0 && same_file(&stream, info)) return fd;
  return -1;
}

/* Writes directly to a device, a pipe or our own stream. */
static ethd_status in_place(const char *path, int stream, ethd_replace *out, char *message) {
  fflush(NULL);
  int fd = stream >= 0 ? fcntl(stream, F_DUPFD_CLOEXEC, 3) : open(path, O_WRONLY | O_CLOEXEC);
  out->file = fd >= 0 ? fdopen(fd, "wb") : NULL;
  if (!out->file) return refuse(path, message);
  out->path = strdup(path);
  return ETHD_OK;
}

/* ---- what a killed program left: PATH.PID-COUNT.new, which is locked while its writer runs ---- */

static bool is_left(const char *name, const char *target) {
  size_t n = strlen(target), digits;
  if (strncmp(name, target, n) || name[n] != '.') return false;
  name += n + 1;
  digits = strspn(name, "0123456789");
  if (!digits || name[digits] != '-') return false;
  name += digits + 1;
  digits = strspn(name, "0123456789");
  return digits && !strcmp(name + digits, ".new");
}

static void remove_left(const char *path) {
  char *folder = ethd__path_folder(path);
  const char *slash = strrchr(path, '/'), *target = slash ? slash + 1 : path;
  DIR *entries = folder ? opendir(folder) : NULL;
  const struct dirent *entry;
  while (entries && (entry = readdir(entries))) {
    int fd = is_left(entry->d_name, target)
                 ? openat(dirfd(entries), entry->d_name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)
                 : -1;
    if (fd < 0) continue;
    if (flock(fd, LOCK_EX | LOCK_NB) == 0) unlinkat(dirfd(entries), entry->d_name, 0);
    close(fd);
  }
  if (entries) closedir(entries);
  free(folder);
}

/* Locks the new file, before another program can take it for one that was left. */
static FILE *locked(int fd) {
  struct stat info;
  if (flock(fd, LOCK_EX | LOCK_NB) == 0 && fstat(fd, &info) == 0 && info.st_nlink > 0) return fdopen(fd, "wb");
  close(fd);
  return NULL;
}

/* Makes a new file in the target's own folder, so that the rename stays within one file system. */
static FILE *beside(const char *path, mode_t mode, char **temporary) {
  static unsigned count;
  for (int attempt = 0; attempt < 100; attempt++) {
    if (asprintf(temporary, "%s.%ld-%u.new", path, (long)getpid(), count++) < 0) break;
    int fd = open(*temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    FILE *file = fd >= 0 ? locked(fd) : NULL;
    if (file) return file;
    free(*temporary);
    if (fd < 0 && errno != EEXIST) break;
  }
  *temporary = NULL;
  return NULL;
}

ethd_status ethd_replace_begin(const char *path, ethd_replace *out, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  *out = (ethd_replace){0};
  bool exists = stat(path, &info) == 0;
  int stream = exists ? own_stream(&info) : -1;
  if (exists && S_ISDIR(info.st_mode))
    return ethd__say(message, ETHD_E_FILE, "%s: is a folder, a file's name is needed", path);
  if (exists && (stream >= 0 || !S_ISREG(info.st_mode))) return in_place(path, stream, out, message);
  if (exists && access(path, W_OK) != 0) return refuse(path, message);
  out->path = exists ? realpath(path, NULL) : strdup(path);
  if (!out->path) return refuse(path, message);
  remove_left(out->path);
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

/* Keeps the lock until the file is closed, which may fail, and renamed. */
ethd_status ethd_replace_commit(ethd_replace *replace, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  const char *path = replace->path ? replace->path : "output";
  int lock = replace->temporary ? fcntl(fileno(replace->file), F_DUPFD_CLOEXEC, 3) : -1;
  errno = 0;
  bool failed = ferror(replace->file) != 0;
  failed |= fclose(replace->file) != 0;
  if (!failed && replace->temporary) failed = rename(replace->temporary, replace->path) != 0;
  if (failed) {
    status =
        errno ? refuse(path, message) : ethd__say(message, ETHD_E_FILE, "%s: a write failed; is there room?", path);
    if (replace->temporary) unlink(replace->temporary);
  }
  if (lock >= 0) close(lock);
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

bool ethd__text_is_word(const char *text, size_t most, const char *letters) {
  size_t n = text ? strnlen(text, most + 1) : 0;
  return n >= 1 && n <= most && strspn(text, letters) == n;
}

bool ethd__text_is_line(const char *text, size_t most) {
  size_t n = text ? strnlen(text, most + 1) : 0;
  for (size_t i = 0; i < n; i++)
    if (text[i] < ' ' || text[i] > '~') return false;
  return n >= 1 && n <= most;
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
