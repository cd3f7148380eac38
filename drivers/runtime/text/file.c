#include "text/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "text/error_text.h"

static _Thread_local const ethd__received *innermost;

void ethd__received_enter(ethd__received *received, const char *folder) {
  *received = (ethd__received){folder, (ethd__received *)innermost};
  innermost = received;
}

void ethd__received_leave(const ethd__received *received) { innermost = received->outer; }

/* ---- where a path leads ---- */

/* A folder's descriptor, and what the path calls the file in it. */
typedef struct place {
  int folder; /* AT_FDCWD: `name` is the whole path */
  const char *name;
  int no_link; /* AT_SYMLINK_NOFOLLOW below a received folder, else 0 */
} place;

/* Returns how many bytes of the path are the outermost received folder's; 0: it isn't below one. */
static size_t root_of(const char *path) {
  size_t root = 0;
  for (const ethd__received *r = innermost; r; r = r->outer) {
    size_t n = strlen(r->folder);
    while (n > 1 && r->folder[n - 1] == '/') n--;
    if (strncmp(path, r->folder, n) == 0 && path[n] == '/' && path[n + strspn(path + n, "/")]) root = n;
  }
  return root;
}

bool ethd__file_is_received(const char *path) { return root_of(path) > 0; }

static bool is_link(int folder, const char *name) {
  struct stat info;
  return fstatat(folder, name, &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(info.st_mode);
}

static void close_quietly(int fd) {
  int reason = errno;
  if (fd >= 0) close(fd);
  errno = reason;
}

/* Opens the folder `name`, of `length` bytes, in another one, which is closed; a link isn't entered. */
static int enter(int folder, const char *name, size_t length) {
  char part[NAME_MAX + 1];
  int inner = -1;
  snprintf(part, sizeof part, "%.*s", (int)length, name);
  if (length > NAME_MAX)
    errno = ENAMETOOLONG;
  else if (strcmp(part, "..") == 0)
    errno = EXDEV;
  else if ((inner = openat(folder, part, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) < 0 && errno == ENOTDIR)
    errno = is_link(folder, part) ? ELOOP : ENOTDIR;
  close_quietly(folder);
  return inner;
}

static bool find(const char *path, place *out) {
  char root[PATH_MAX];
  size_t n = root_of(path);
  *out = (place){AT_FDCWD, path, 0};
  if (!n) return true;
  if (n >= sizeof root) return errno = ENAMETOOLONG, false;
  memcpy(root, path, n);
  root[n] = 0;
  const char *name = path + n + strspn(path + n, "/");
  int folder = open(root, O_PATH | O_DIRECTORY | O_CLOEXEC);
  for (size_t length; folder >= 0 && name[length = strcspn(name, "/")]; name += length + strspn(name + length, "/"))
    folder = enter(folder, name, length);
  if (folder >= 0 && strcmp(name, "..") == 0) {
    close(folder);
    folder = -1;
    errno = EXDEV;
  }
  *out = (place){folder, *name ? name : ".", AT_SYMLINK_NOFOLLOW};
  return folder >= 0;
}

static void leave(const place *p) {
  if (p->folder != AT_FDCWD) close_quietly(p->folder);
}

/* ---- what is done there ---- */

int ethd__file_open(const char *path, int flags, mode_t mode) {
  place p;
  if (!find(path, &p)) return -1;
  int fd = openat(p.folder, p.name, flags | (p.no_link ? O_NOFOLLOW : 0) | O_CLOEXEC | O_NOCTTY, mode);
  if (fd < 0 && p.no_link && errno == ENOTDIR && is_link(p.folder, p.name)) errno = ELOOP;
  leave(&p);
  if (fd < 0 || fd > STDERR_FILENO) return fd;
  int higher = fcntl(fd, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  close_quietly(fd);
  return higher;
}

static int look(const char *path, int no_link, struct stat *out) {
  place p;
  if (!find(path, &p)) return -1;
  int failed = fstatat(p.folder, p.name, out, p.no_link | no_link);
  leave(&p);
  return failed;
}

int ethd__file_look(const char *path, struct stat *out) { return look(path, 0, out); }

int ethd__file_look_at(const char *path, struct stat *out) { return look(path, AT_SYMLINK_NOFOLLOW, out); }

bool ethd__file_taken(const char *path) {
  struct stat info;
  return ethd__file_look(path, &info) == 0;
}

DIR *ethd__file_list(const char *folder) {
  int fd = ethd__file_open(folder, O_RDONLY | O_DIRECTORY | O_NONBLOCK, 0);
  DIR *entries = fd < 0 ? NULL : fdopendir(fd);
  if (!entries) close_quietly(fd);
  return entries;
}

int ethd__file_make_folder(const char *folder) {
  struct stat info;
  place p;
  if (!find(folder, &p)) return -1;
  int failed = mkdirat(p.folder, p.name, 0777);
  if (failed && errno == EEXIST && fstatat(p.folder, p.name, &info, p.no_link) == 0) {
    failed = S_ISDIR(info.st_mode) ? 0 : -1;
    errno = S_ISLNK(info.st_mode) ? ELOOP : ENOTDIR;
  }
  leave(&p);
  return failed;
}

static int remove_at(const char *path, int flag) {
  place p;
  if (!find(path, &p)) return -1;
  int failed = unlinkat(p.folder, p.name, flag);
  leave(&p);
  return failed;
}

int ethd__file_remove(const char *path) { return remove_at(path, 0); }

int ethd__file_remove_folder(const char *path) { return remove_at(path, AT_REMOVEDIR); }

int ethd__file_move(const char *from, const char *to) {
  place p, q;
  if (!find(from, &p)) return -1;
  int failed = -1;
  if (find(to, &q)) {
    failed = renameat(p.folder, p.name, q.folder, q.name);
    leave(&q);
  }
  leave(&p);
  return failed;
}

const char *ethd__file_why(void) {
  if (errno == ELOOP) return "is a link, which isn't followed in a folder of somebody else; a file is needed";
  if (errno == EXDEV) return "leads out of the folder";
  return strerror(errno);
}

ethd_status ethd__file_refuse(const char *path, char message[ETHD_MESSAGE_MAX]) {
  return ethd__say(message, ETHD_E_FILE, "%s: %s", path, ethd__file_why());
}

/* ---- files ---- */

static int refuse(int fd, const char *path, const char *why, char *message) {
  (void)ethd__say(message, ETHD_E_FILE, "%s: %s", path, why);
  if (fd >= 0) close(fd);
  return -1;
}

static bool is_null(const struct stat *info) { return S_ISCHR(info->st_mode) && info->st_rdev == makedev(1, 3); }

int ethd__file_read(const char *path, struct stat *out, char message[ETHD_MESSAGE_MAX]) {
  int fd = *path ? ethd__file_open(path, O_RDONLY | O_NONBLOCK, 0) : -1;
  if (!*path) return refuse(fd, "\"\"", "a file's name is needed", message);
  if (fd < 0 || fstat(fd, out) != 0) return refuse(fd, path, ethd__file_why(), message);
  if (S_ISREG(out->st_mode)) return fd;
  if (S_ISDIR(out->st_mode)) return refuse(fd, path, "is a folder, a file is needed", message);
  if (!ethd__file_is_received(path) && (S_ISFIFO(out->st_mode) || isatty(fd) || is_null(out))) return fd;
  return refuse(fd, path, S_ISFIFO(out->st_mode) ? "is a pipe, a file is needed" : "is a device, a file is needed",
                message);
}

int ethd__file_create(const char *path, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  bool exists = ethd__file_look_at(path, &info) == 0;
  if (!exists && errno != ENOENT) return refuse(-1, path, ethd__file_why(), message);
  if (exists && S_ISCHR(info.st_mode) && !ethd__file_is_received(path)) {
    int device = ethd__file_open(path, O_WRONLY | O_NOFOLLOW, 0);
    return device < 0 ? refuse(-1, path, strerror(errno), message) : device;
  }
  if (exists && !S_ISREG(info.st_mode)) return refuse(-1, path, "isn't a file; nothing is replaced", message);
  if (exists && ethd__file_remove(path) != 0) return refuse(-1, path, strerror(errno), message);
  int fd = ethd__file_open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW, 0666);
  return fd < 0 ? refuse(fd, path, ethd__file_why(), message) : fd;
}

FILE *ethd__file_stream(const char *path, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  int fd = ethd__file_read(path, &info, message);
  if (fd >= 0 && !S_ISREG(info.st_mode)) fd = refuse(fd, path, "isn't a file; another one is needed", message);
  FILE *file = fd < 0 ? NULL : fdopen(fd, "r");
  if (fd >= 0 && !file) refuse(fd, path, strerror(errno), message);
  return file;
}

bool ethd__file_has_hole(int fd, int64_t end) {
  off_t at = lseek(fd, 0, SEEK_CUR), hole = lseek(fd, 0, SEEK_HOLE);
  lseek(fd, at, SEEK_SET);
  return hole >= 0 && hole < end;
}
