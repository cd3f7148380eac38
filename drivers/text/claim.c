#include "text/claim.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text/error_text.h"
#include "text/text.h"

#define LOCK ".lock"
#define TRIES 100 /* how often to try again when a lock's owner removes it at the same time */

static ethd_status refuse(const char *path, char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno));
}

static bool matches(const char *const *own, const char *name) {
  for (; own && *own; own++)
    if (!fnmatch(*own, name, FNM_PERIOD)) return true;
  return false;
}

/* Calls `each` for the entries that match until it returns true; returns whether it did. */
static bool any(const char *folder, const char *const *own, bool (*each)(int folder, const char *name, void *user),
                void *user) {
  DIR *entries = opendir(folder);
  const struct dirent *entry;
  bool found = false;
  while (entries && !found && (entry = readdir(entries)))
    found = matches(own, entry->d_name) && each(dirfd(entries), entry->d_name, user);
  int reason = errno;
  if (entries) closedir(entries);
  errno = reason;
  return found;
}

/* ---- the lock ---- */

static ethd_status make_folder(const char *folder, char *message) {
  struct stat info;
  if (mkdir(folder, 0777) == 0) return ETHD_OK;
  if (errno == EEXIST && stat(folder, &info) == 0) {
    if (S_ISDIR(info.st_mode)) return ETHD_OK;
    errno = ENOTDIR;
  }
  return refuse(folder, message);
}

/* Returns true if fd is the file that is at this path now. */
static bool is_at(int fd, const char *path) {
  struct stat own, there;
  return fstat(fd, &own) == 0 && stat(path, &there) == 0 && own.st_ino == there.st_ino && own.st_dev == there.st_dev;
}

static ethd_status lock(const char *folder, int how, ethd__claim *out, char *message) {
  out->path = ethd__path_join(folder, LOCK);
  if (!out->path) return ethd__no_memory(message, folder);
  for (int i = 0; i < TRIES; i++) {
    out->fd = open(out->path, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (out->fd < 0) return refuse(out->path, message);
    if (flock(out->fd, how) != 0)
      return errno == EWOULDBLOCK ? ethd__say(message, ETHD_E_ARGUMENT, "%s: another program is writing there", folder)
                                  : refuse(out->path, message);
    if (is_at(out->fd, out->path)) return ETHD_OK;
    close(out->fd);
    out->fd = -1;
  }
  return ethd__say(message, ETHD_E_FILE, "%s: other programs are writing there", folder);
}

/* Gives up, and doesn't remove the lock if it is another program's. */
static void let_go(ethd__claim *claim) {
  if (claim->fd >= 0) close(claim->fd);
  free(claim->path);
  *claim = ETHD_CLAIM_NONE;
}

void ethd__claim_release(ethd__claim *claim) {
  if (claim->fd >= 0) unlink(claim->path);
  let_go(claim);
}

/* ---- what is there ---- */

static bool keep_name(int folder, const char *name, void *user) {
  (void)folder;
  snprintf(user, NAME_MAX + 1, "%s", name);
  return true;
}

static ethd_status claim(const char *folder, int how, ethd__claim *out, char *message) {
  *out = ETHD_CLAIM_NONE;
  ethd_status status = make_folder(folder, message);
  if (!status) status = lock(folder, how, out, message);
  if (status) let_go(out);
  return status;
}

ethd_status ethd__claim_wait(const char *folder, ethd__claim *out, char message[ETHD_MESSAGE_MAX]) {
  return claim(folder, LOCK_EX, out, message);
}

ethd_status ethd__claim_folder(const char *folder, const char *const *own, bool force, ethd__claim *out,
                               char message[ETHD_MESSAGE_MAX]) {
  char name[NAME_MAX + 1];
  ethd_status status = claim(folder, LOCK_EX | LOCK_NB, out, message);
  if (status || force || !any(folder, own, keep_name, name)) return status;
  ethd__claim_release(out);
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: holds %.80s already; --force replaces what is there", folder, name);
}

static bool is_same(int folder, const char *name, void *user) {
  const struct stat *wanted = user;
  struct stat info;
  return fstatat(folder, name, &info, 0) == 0 && info.st_ino == wanted->st_ino && info.st_dev == wanted->st_dev;
}

bool ethd__claim_holds(const char *folder, const char *const *own, const char *path) {
  struct stat wanted;
  return stat(path, &wanted) == 0 && (is_same(AT_FDCWD, folder, &wanted) || any(folder, own, is_same, &wanted));
}

static bool cannot_remove(int folder, const char *name, void *user) {
  (void)user;
  return unlinkat(folder, name, 0) != 0;
}

ethd_status ethd__claim_empty(const char *folder, const char *const *own, char message[ETHD_MESSAGE_MAX]) {
  return any(folder, own, cannot_remove, NULL) ? refuse(folder, message) : ETHD_OK;
}
