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
#include "text/file.h"
#include "text/text.h"

#define LOCK ".lock"
#define TRIES 100 /* how often to try again when a lock's owner removes it at the same time */

static bool matches(const char *const *own, const char *name) {
  for (; own && *own; own++)
    if (!fnmatch(*own, name, FNM_PERIOD)) return true;
  return false;
}

/* Calls `each` for the entries that match until it returns true; returns whether it did. */
static bool any(const char *folder, const char *const *own, bool (*each)(int folder, const char *name, void *user),
                void *user) {
  DIR *entries = ethd__file_list(folder);
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

/* Returns true if fd is the file that is at this path now. */
static bool is_at(int fd, const char *path) {
  struct stat own, there;
  return fstat(fd, &own) == 0 && ethd__file_look_at(path, &there) == 0 && own.st_ino == there.st_ino &&
         own.st_dev == there.st_dev;
}

static bool is_regular(int fd) {
  struct stat info;
  return fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
}

static ethd_status lock(const char *folder, int how, ethd__claim *out, char *message) {
  out->path = ethd__path_join(folder, LOCK);
  if (!out->path) return ethd__no_memory(message, folder);
  for (int i = 0; i < TRIES; i++) {
    out->fd = ethd__file_open(out->path, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (out->fd < 0) return ethd__file_refuse(out->path, message);
    if (!is_regular(out->fd)) return ethd__say(message, ETHD_E_FILE, "%s: isn't a file; remove it", out->path);
    if (flock(out->fd, how) != 0)
      return errno == EWOULDBLOCK ? ethd__say(message, ETHD_E_ARGUMENT, "%s: another program is writing there", folder)
                                  : ethd__file_refuse(out->path, message);
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
  if (claim->fd >= 0) ethd__file_remove(claim->path);
  let_go(claim);
}

/* ---- what is there ---- */

static bool keep_name(int folder, const char *name, void *user) {
  (void)folder;
  snprintf(user, NAME_MAX + 1, "%s", name);
  return true;
}

/* Keeps the name of a link, a folder and the like. */
static bool keep_odd(int folder, const char *name, void *user) {
  struct stat info;
  bool odd = fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(info.st_mode);
  return odd && keep_name(folder, name, user);
}

static ethd_status claim(const char *folder, int how, ethd__claim *out, char *message) {
  *out = ETHD_CLAIM_NONE;
  ethd_status status = ethd__file_make_folder(folder) ? ethd__file_refuse(folder, message) : ETHD_OK;
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
  if (status || !any(folder, own, force ? keep_odd : keep_name, name)) return status;
  if (force && !ethd__file_is_received(out->path)) return ETHD_OK;
  ethd__claim_release(out);
  if (force) return ethd__say(message, ETHD_E_FILE, "%s/%.80s: isn't a file; remove it first", folder, name);
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
  return any(folder, own, cannot_remove, NULL) ? ethd__file_refuse(folder, message) : ETHD_OK;
}
