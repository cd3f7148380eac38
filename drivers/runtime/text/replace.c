#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

/* ---- what is written directly ---- */

static ethd_status take(int fd, const char *path, ethd_replace *out, char *message) {
  out->file = fd >= 0 ? fdopen(fd, "wb") : NULL;
  if (!out->file) return ethd__file_refuse(path, message);
  out->path = strdup(path);
  return ETHD_OK;
}

/* Returns true for a descriptor that the program was started with and that can be written. Our own files are all closed
   on exec, and so is what stands for a standard stream that was closed. */
static bool is_given(int fd) {
  int flags = fcntl(fd, F_GETFL);
  return flags >= 0 && !(fcntl(fd, F_GETFD) & FD_CLOEXEC) && (flags & O_ACCMODE) != O_RDONLY && !(flags & O_PATH);
}

static ethd_status through(int fd, const char *path, ethd_replace *out, char *message) {
  fflush(NULL);
  if (!is_given(fd)) return ethd__say(message, ETHD_E_FILE, "%s: that descriptor isn't open for writing", path);
  return take(fcntl(fd, F_DUPFD_CLOEXEC, 3), path, out, message);
}

/* Returns the descriptor that a path names, -1: none. */
static int descriptor_of(const char *path) {
  static const char *const streams[] = {"/dev/stdin", "/dev/stdout", "/dev/stderr"};
  static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/", "/proc/thread-self/fd/"};
  for (int fd = 0; fd < 3; fd++)
    if (strcmp(path, streams[fd]) == 0) return fd;
  for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
    size_t n = strlen(folders[i]), digits = strncmp(path, folders[i], n) ? 0 : strspn(path + n, "0123456789");
    if (digits && digits < 9 && !path[n + digits]) return atoi(path + n);
  }
  return -1;
}

/* Returns the stream that is this very file, as with `--csv out >out`; -1: none. */
static int own_stream(const struct stat *info) {
  struct stat stream;
  for (int fd = STDOUT_FILENO; fd <= STDERR_FILENO; fd++)
    if (is_given(fd) && fstat(fd, &stream) == 0 && stream.st_dev == info->st_dev && stream.st_ino == info->st_ino)
      return fd;
  return -1;
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
  ETHD__FREED char *folder = ethd__path_folder(path);
  const char *slash = strrchr(path, '/'), *target = slash ? slash + 1 : path;
  DIR *entries = folder ? ethd__file_list(folder) : NULL;
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
}

/* ---- what is replaced ---- */

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
    int fd = ethd__file_open(*temporary, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW, mode);
    FILE *file = fd >= 0 ? locked(fd) : NULL;
    if (file) return file;
    free(*temporary);
    if (fd < 0 && errno != EEXIST) break;
  }
  *temporary = NULL;
  return NULL;
}

static ethd_status replace(const char *path, mode_t mode, ethd_replace *out, char *message) {
  remove_left(path);
  out->path = strdup(path);
  out->file = out->path ? beside(path, mode, &out->temporary) : NULL;
  if (out->file) return ETHD_OK;
  ethd_status status = out->path ? ethd__file_refuse(path, message) : ethd__no_memory(message, path);
  free(out->path);
  *out = (ethd_replace){0};
  return status;
}

/* Finds what a link leads to, which must be a regular file; *target is NULL if the path is no link. */
static ethd_status follow(const char *path, struct stat *info, char **target, char *message) {
  if (!S_ISLNK(info->st_mode)) return ETHD_OK;
  errno = ELOOP;
  if (ethd__file_is_received(path)) return ethd__file_refuse(path, message);
  if (stat(path, info) != 0)
    return errno != ENOENT ? ethd__file_refuse(path, message)
                           : ethd__say(message, ETHD_E_FILE, "%s: is a link that leads nowhere; remove it first", path);
  if (!S_ISREG(info->st_mode))
    return ethd__say(message, ETHD_E_FILE, "%s: is a link to something that isn't a file; name that itself", path);
  *target = realpath(path, NULL);
  return *target ? ETHD_OK : ethd__file_refuse(path, message);
}

/* A pipe waits for its reader, until a signal comes. */
static ethd_status directly(const char *path, ethd_replace *out, char *message) {
  const struct timespec pause = {.tv_nsec = 20000000};
  int fd;
  fflush(NULL);
  while ((fd = ethd__file_open(path, O_WRONLY | O_NOFOLLOW | O_NONBLOCK, 0)) < 0 && errno == ENXIO)
    if (nanosleep(&pause, NULL) != 0) break;
  if (fd >= 0) fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) & ~O_NONBLOCK);
  return take(fd, path, out, message);
}

static ethd_status begin_at(const char *path, const struct stat *info, ethd_replace *out, char *message) {
  int stream = own_stream(info);
  bool received = ethd__file_is_received(path);
  if (S_ISDIR(info->st_mode)) return ethd__say(message, ETHD_E_FILE, "%s: is a folder, a file's name is needed", path);
  if (stream >= 0) return through(stream, path, out, message);
  if ((S_ISFIFO(info->st_mode) || S_ISCHR(info->st_mode)) && !received) return directly(path, out, message);
  if (!S_ISREG(info->st_mode)) return ethd__say(message, ETHD_E_FILE, "%s: isn't a file; nothing is replaced", path);
  return access(path, W_OK) ? ethd__file_refuse(path, message) : replace(path, info->st_mode & 0777, out, message);
}

ethd_status ethd_replace_begin(const char *path, ethd_replace *out, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  ETHD__FREED char *target = NULL;
  int given = descriptor_of(path);
  *out = (ethd_replace){0};
  if (given >= 0) return through(given, path, out, message);
  bool exists = ethd__file_look_at(path, &info) == 0;
  if (!exists) return errno == ENOENT ? replace(path, 0666, out, message) : ethd__file_refuse(path, message);
  ethd_status status = follow(path, &info, &target, message);
  return status ? status : begin_at(target ? target : path, &info, out, message);
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
  if (!failed && replace->temporary) failed = ethd__file_move(replace->temporary, replace->path) != 0;
  if (failed) {
    status = errno ? ethd__file_refuse(path, message)
                   : ethd__say(message, ETHD_E_FILE, "%s: a write failed; is the disk full?", path);
    if (replace->temporary) ethd__file_remove(replace->temporary);
  }
  if (lock >= 0) close(lock);
  release(replace);
  return status;
}

void ethd_replace_abandon(ethd_replace *replace) {
  if (replace->file) fclose(replace->file);
  if (replace->temporary) ethd__file_remove(replace->temporary);
  release(replace);
}

ethd_status ethd_text_write(const char *path, const char *text, size_t length, char message[ETHD_MESSAGE_MAX]) {
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(path, &replace, message);
  if (status) return status;
  fwrite(text, 1, length, replace.file);
  return ethd_replace_commit(&replace, message);
}
