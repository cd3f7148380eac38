#include "device/container.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MACHINE "pid:[4026531836]" /* PROC_PID_INIT_INO of the kernel's linux/proc_ns.h */
#define FAR 2                      /* a depth that can't be determined */

static bool link_is(const char *path, const char *wanted) {
  char text[64] = "";
  return readlink(path, text, sizeof text - 1) > 0 && !strcmp(text, wanted);
}

bool ethd__in_container(void) {
  return getpid() == 1 || (access("/proc/self/ns/pid", F_OK) == 0 && !link_is("/proc/self/ns/pid", MACHINE));
}

/* The parent by /proc/PID/stat, in which the preceding name may hold any characters; -1: it can't be read. */
static pid_t parent_of(pid_t process) {
  char path[32], text[512], *end;
  snprintf(path, sizeof path, "/proc/%d/stat", (int)process);
  FILE *file = fopen(path, "re");
  if (!file) return -1;
  size_t n = fread(text, 1, sizeof text - 1, file);
  fclose(file);
  text[n] = 0;
  end = strrchr(text, ')');
  return end && strlen(end) > 4 ? (pid_t)strtol(end + 4, NULL, 10) : -1;
}

static bool is_systemd(void) {
  char name[32] = "";
  FILE *file = fopen("/proc/1/comm", "re");
  if (!file) return false;
  bool is = fgets(name, sizeof name, file) && !strcmp(name, "systemd\n");
  fclose(file);
  return is;
}

int ethd__container_depth(void) {
  char own[32];
  int depth = 1;
  if (getpid() == 1) return 0;
  if (!ethd__in_container()) return -1;
  snprintf(own, sizeof own, "%d", (int)getpid());
  if (!link_is("/proc/self", own)) return getppid() == 1 ? 1 : FAR; /* this /proc is of another namespace */
  if (is_systemd()) return -1;
  for (pid_t p = getppid(); p != 1; p = parent_of(p), depth++) {
    if (p == 0) return -1;
    if (p < 0) return FAR;
  }
  return depth;
}

/* ---- control groups ---- */

/* The path of our control group in the tree that `prefix` names; false: there is none. */
static bool group_of(const char *root, const char *prefix, char *out, size_t room) {
  char path[PATH_MAX], line[PATH_MAX];
  bool found = false;
  snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
  FILE *file = fopen(path, "re");
  while (file && !found && fgets(line, sizeof line, file)) {
    const char *at = strstr(line, prefix);
    if (!at) continue;
    line[strcspn(line, "\n")] = 0;
    snprintf(out, room, "%s", at + strlen(prefix));
    found = true;
  }
  if (file) fclose(file);
  return found;
}

static bool is_one(const char *path) {
  FILE *file = fopen(path, "re");
  bool is = file && fgetc(file) == '1';
  if (file) fclose(file);
  return is;
}

bool ethd__group_dies_whole(const char *root) {
  char group[PATH_MAX / 2], path[PATH_MAX];
  if (!group_of(root, "0::", group, sizeof group)) return false;
  for (;;) {
    snprintf(path, sizeof path, "%s/sys/fs/cgroup%s/memory.oom.group", root, group);
    if (is_one(path)) return true;
    char *slash = strrchr(group, '/');
    if (!slash) return false;
    *slash = 0;
  }
}

bool ethd__group_is_service(const char *root) {
  char group[PATH_MAX / 2];
  if (!group_of(root, "0::", group, sizeof group) && !group_of(root, "name=systemd:", group, sizeof group))
    return false;
  size_t n = strlen(group);
  return n > 8 && !strcmp(group + n - 8, ".service");
}
