#include "unit/mock_counter.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define FIRST 1000 /* descriptor */

mock_counter counter_mock;

static int fail(int reason) { return errno = reason, -1; }
static const char *path_of(int fd) { return counter_mock.opened[fd - FIRST]; }
static int ends(const char *path, const char *end) {
  size_t n = strlen(path), m = strlen(end);
  return n >= m && !strcmp(path + n - m, end);
}

/* Returns whether this call fails; errno says why. */
static int fails(mock_failure *f, const char *path) {
  if (!f->path || !ends(path, f->path) || f->after-- > 0) return 0;
  errno = f->reason;
  return 1;
}

static int joint_of(const char *path) { return strstr(path, "count1/") != NULL; }

static int mock_open(const char *path, int flags) {
  if (fails(&counter_mock.open, path)) return -1;
  if (ends(path, "/ceiling") && !counter_mock.ceiling[joint_of(path)][0]) return fail(ENOENT);
  if (ends(path, "/enable") && !counter_mock.has_enable) return fail(ENOENT);
  if (ends(path, "/function") && counter_mock.fixed && (flags & O_ACCMODE) != O_RDONLY) return fail(EACCES);
  if (strstr(path, "counter9")) return fail(ENOENT);
  for (int i = 0; i < 16; i++)
    if (!counter_mock.opened[i][0]) {
      snprintf(counter_mock.opened[i], sizeof counter_mock.opened[i], "%s", path);
      counter_mock.open_files++;
      return FIRST + i;
    }
  return fail(EMFILE);
}

static int mock_close(int fd) {
  counter_mock.opened[fd - FIRST][0] = 0;
  counter_mock.open_files--;
  return 0;
}

static int mock_ioctl(int fd, unsigned long request, void *argument) {
  (void)fd;
  if (request == COUNTER_ADD_WATCH_IOCTL) {
    const struct counter_watch *w = argument;
    if (w->event == counter_mock.refuse_event) return fail(EINVAL);
    counter_mock.watches[counter_mock.watch_count++ % 8] = *w;
  }
  if (request == COUNTER_ENABLE_EVENTS_IOCTL && counter_mock.ioctl_reason) return fail(counter_mock.ioctl_reason);
  if (request == COUNTER_ENABLE_EVENTS_IOCTL) counter_mock.enabled = 1;
  if (request == COUNTER_DISABLE_EVENTS_IOCTL) counter_mock.enabled = 0;
  return 0;
}

static ssize_t mock_read(int fd, void *to, size_t size) {
  (void)fd;
  if (counter_mock.gone) return fail(ENODEV);
  uint32_t n = (uint32_t)(size / sizeof *counter_mock.events);
  if (n > counter_mock.waiting) n = counter_mock.waiting;
  if (!n) return fail(EAGAIN);
  memcpy(to, counter_mock.events, n * sizeof *counter_mock.events);
  memmove(counter_mock.events, counter_mock.events + n, (counter_mock.waiting - n) * sizeof *counter_mock.events);
  counter_mock.waiting -= n;
  return (ssize_t)(n * sizeof *counter_mock.events);
}

static ssize_t mock_read_text(int fd, char *to, size_t size) {
  const char *path = path_of(fd);
  if (counter_mock.gone) return fail(ENODEV);
  if (fails(&counter_mock.read, path)) return -1;
  int j = joint_of(path);
  if (ends(path, "/function") && !counter_mock.function[0]) return fail(EINVAL);
  if (ends(path, "/function")) return snprintf(to, size, "%s\n", counter_mock.function);
  if (ends(path, "/ceiling")) return snprintf(to, size, "%s\n", counter_mock.ceiling[j]);
  if (ends(path, "/enable")) return snprintf(to, size, "%d\n", counter_mock.on[j]);
  int counts = (counter_mock.on[j] || !counter_mock.has_enable) && strcmp(counter_mock.ceiling[j], "0") != 0;
  return snprintf(to, size, "%" PRIu64 "\n", counts ? counter_mock.count[j] : 0);
}

static ssize_t mock_write_text(int fd, const char *from, size_t size) {
  const char *path = path_of(fd);
  int j = joint_of(path);
  if (fails(&counter_mock.write, path)) return -1;
  if (ends(path, "/function") && !counter_mock.deaf)
    snprintf(counter_mock.function, sizeof counter_mock.function, "%.*s", (int)size, from);
  if (ends(path, "/enable")) counter_mock.on[j] = from[0] == '1' && !counter_mock.stays_off;
  if (ends(path, "/ceiling") && counter_mock.on[j]) return fail(EBUSY); /* as intel-qep */
  if (ends(path, "/ceiling") && !counter_mock.ceiling_fixed)
    snprintf(counter_mock.ceiling[j], sizeof counter_mock.ceiling[j], "%.*s", (int)size, from);
  return (ssize_t)size;
}

static void mock_pause(int64_t ns) {
  counter_mock.pauses++;
  if (counter_mock.on_pause) counter_mock.on_pause(ns);
}

static const ethd__counter_calls calls = {.open = mock_open,
                                          .close = mock_close,
                                          .ioctl = mock_ioctl,
                                          .read = mock_read,
                                          .read_text = mock_read_text,
                                          .write_text = mock_write_text,
                                          .pause = mock_pause};

/* drivers/counter/NAME.c. 104-quad-8 counts 24 bits and a carry; ti-eqep's QPOSMAX is 0 after a reset; stm32-timer-cnt
   has no function before one is set (later kernels: "increase"). */
static const struct {
  const char *name, *function, *ceiling;
  int fixed, has_enable;
} drivers[] = {
    {"intel-qep", "quadrature x4", "4294967295", 1, 1},
    {"ti-eqep", "quadrature x4", "0", 0, 1},
    {"stm32-timer-cnt", "", "65535", 0, 1},
    {"104-quad-8", "pulse-direction", "33554431", 0, 1},
    {"ftm-quaddec", "quadrature x4", "", 1, 0},
    {"interrupt-cnt", "increase", "", 1, 1},
};

void mock_counter_load(const char *driver) {
  size_t i = 0;
  while (strcmp(drivers[i].name, driver) != 0) i++;
  counter_mock = (mock_counter){.fixed = drivers[i].fixed, .has_enable = drivers[i].has_enable, .refuse_event = -1};
  strcpy(counter_mock.function, drivers[i].function);
  for (int j = 0; j < 2; j++) strcpy(counter_mock.ceiling[j], drivers[i].ceiling);
  ethd__counter_calls_now = &calls;
}

void mock_counter_install(void) {
  mock_counter_load("intel-qep");
  counter_mock.fixed = 0; /* other functions are tried, too */
}

void mock_counter_event(uint8_t kind, int joint, uint64_t value, int64_t time_ns) {
  if (counter_mock.waiting == MOCK_EVENTS) return;
  counter_mock.events[counter_mock.waiting++] =
      (struct counter_event){.timestamp = (uint64_t)time_ns,
                             .value = value,
                             .watch = {.component = {COUNTER_COMPONENT_COUNT, COUNTER_SCOPE_COUNT, (uint8_t)joint, 0},
                                       .event = kind,
                                       .channel = (uint8_t)joint}};
}
