/* The kernel's side: attributes and watches. */
#include <errno.h>
#include <fcntl.h>
#include <linux/counter.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "encoder/counter.h"
#include "text/error_text.h"

/* ---- the calls themselves ---- */

static int call_open(const char *path, int flags) { return open(path, flags | O_CLOEXEC); }
static int call_ioctl(int fd, unsigned long request, void *argument) { return ioctl(fd, request, argument); }
static ssize_t call_read_text(int fd, char *to, size_t size) { return pread(fd, to, size, 0); }
static ssize_t call_write_text(int fd, const char *from, size_t size) { return pwrite(fd, from, size, 0); }

static void call_pause(int64_t ns) {
  struct timespec t = {.tv_sec = (time_t)(ns / 1000000000), .tv_nsec = (long)(ns % 1000000000)};
  nanosleep(&t, NULL);
}

const ethd__counter_calls ethd__counter_kernel = {.open = call_open,
                                                  .close = close,
                                                  .ioctl = call_ioctl,
                                                  .read = read,
                                                  .read_text = call_read_text,
                                                  .write_text = call_write_text,
                                                  .pause = call_pause};
const ethd__counter_calls *ethd__counter_calls_now = &ethd__counter_kernel;

/* ---- attributes ---- */

static void name_attribute(const ethd__counter_settings *s, int j, const char *name, char *out, size_t room) {
  const char *base = strrchr(s->device[j], '/');
  snprintf(out, room, "/sys/bus/counter/devices/%.40s/count%d/%s", base ? base + 1 : s->device[j], s->count[j], name);
}

static ethd_status say_errno(const char *path, const char *what, char *message) {
  int reason = errno;
  return ethd__say(message, ETHD_E_DEVICE, "%s: %s: %s", path, what, strerror(reason));
}

/* Reads an attribute's text without the line's end; -1 with errno. */
static int get(const ethd__counter_calls *calls, const char *path, char *out, size_t room) {
  int fd = calls->open(path, O_RDONLY);
  if (fd < 0) return -1;
  ssize_t n = calls->read_text(fd, out, room - 1);
  calls->close(fd);
  if (n < 0) return -1;
  out[n] = 0;
  out[strcspn(out, "\n")] = 0;
  return 0;
}

static int put(const ethd__counter_calls *calls, const char *path, const char *text) {
  int fd = calls->open(path, O_WRONLY);
  if (fd < 0) return -1;
  ssize_t n = calls->write_text(fd, text, strlen(text));
  calls->close(fd);
  return n < 0 ? -1 : 0;
}

/* The setting is read back, because a kernel may accept one without applying it. stm32-timer-cnt can't report
   (EINVAL) the setting before the first one. */
static ethd_status set_function(const ethd__counter_calls *calls, const ethd__counter_settings *s, int j,
                                char *message) {
  char path[160], now[ETHD_COUNTER_TEXT_MAX];
  name_attribute(s, j, "function", path, sizeof path);
  bool known = !get(calls, path, now, sizeof now);
  if (!known && errno != EINVAL) return say_errno(path, "can't be read", message);
  if (known && !strcmp(now, s->function)) return ETHD_OK;
  if (put(calls, path, s->function)) return say_errno(path, s->function, message);
  if (get(calls, path, now, sizeof now)) return say_errno(path, "can't be read", message);
  if (strcmp(now, s->function) != 0)
    return ethd__say(message, ETHD_E_DEVICE, "%s: found %s after setting %s", path, now, s->function);
  return ETHD_OK;
}

/* With any function most counters are off until they are enabled; those without the attribute always count. */
static ethd_status enable(const ethd__counter_calls *calls, const ethd__counter_settings *s, int j, char *message) {
  char path[160], now[ETHD_COUNTER_TEXT_MAX];
  name_attribute(s, j, "enable", path, sizeof path);
  int reason = put(calls, path, "1") ? errno : 0;
  if (reason == ENOENT) return ETHD_OK;
  bool known = !get(calls, path, now, sizeof now);
  if (known && !strcmp(now, "1")) return ETHD_OK;
  if (reason) errno = reason;
  if (reason || !known) return say_errno(path, reason ? "can't be enabled" : "can't be read", message);
  return ethd__say(message, ETHD_E_DEVICE, "%s: found %s after writing 1: it doesn't count", path, now);
}

/* Parses a whole number and nothing else; -1 for any other text. */
static int to_count(const char *text, uint64_t *out) {
  char *end;
  if (text[0] < '0' || text[0] > '9') return -1;
  errno = 0;
  *out = strtoull(text, &end, 10);
  return *end || errno ? -1 : 0;
}

/* A ceiling of 0, as ti-eqep has at first, hasn't been set yet: such a counter stays at 0. */
static ethd_status raise_ceiling(const ethd__counter_calls *calls, const char *path, uint64_t *out, char *message) {
  char text[32];
  uint64_t wanted = *out;
  snprintf(text, sizeof text, "%llu", (unsigned long long)wanted);
  if (put(calls, path, text)) return say_errno(path, "is 0 and can't be set", message);
  if (get(calls, path, text, sizeof text)) return say_errno(path, "can't be read", message);
  if (!to_count(text, out) && *out == wanted) return ETHD_OK;
  return ethd__say(message, ETHD_E_DEVICE, "%s: found %s after setting %llu", path, text, (unsigned long long)wanted);
}

/* The ceiling that is written must fit the counter; 32 bits do where the kernel has the attribute. */
#define WIDTH 32

static ethd_status find_ceiling(const ethd__counter_calls *calls, const ethd__counter_settings *s, int j, uint64_t *out,
                                char *message) {
  char path[160], text[32];
  uint32_t width = (uint32_t)s->p[ETHD__COUNTER_WIDTH];
  name_attribute(s, j, "ceiling", path, sizeof path);
  if (get(calls, path, text, sizeof text)) {
    if (errno != ENOENT) return say_errno(path, "can't be read", message);
    if (!width)
      return ethd__say(message, ETHD_E_DEVICE,
                       "%s: this counter has none: counter.width must say its bits (ftm-quaddec: 16)", path);
    *out = ethd__count_ceiling(width);
    return ETHD_OK;
  }
  if (to_count(text, out))
    return ethd__say(message, ETHD_E_DEVICE, "%s: found \"%s\"; a whole number is expected", path, text);
  if (*out) return ETHD_OK;
  *out = ethd__count_ceiling(width ? width : WIDTH);
  return raise_ceiling(calls, path, out, message);
}

/* ---- one count ---- */

static ethd_status open_files(const ethd__counter_calls *calls, const ethd__counter_settings *s, int j,
                              const ethd__kernel_count *other, ethd__kernel_count *out, char *message) {
  char path[160];
  out->shared = other && !strcmp(s->device[0], s->device[j]);
  out->device = out->shared ? other->device : calls->open(s->device[j], O_RDWR | O_NONBLOCK);
  if (out->device < 0)
    return errno == ENOENT ? ethd__say(message, ETHD_E_DEVICE,
                                       "%s: no such counter; is the kernel's counter driver loaded?", s->device[j])
                           : say_errno(s->device[j], "can't be opened", message);
  name_attribute(s, j, "count", path, sizeof path);
  out->count = calls->open(path, O_RDONLY);
  return out->count < 0 ? say_errno(path, "can't be opened", message) : ETHD_OK;
}

ethd_status ethd__kernel_count_open(const ethd__counter_calls *calls, const ethd__counter_settings *s, int j,
                                    const ethd__kernel_count *other, ethd__kernel_count *out,
                                    char message[ETHD_MESSAGE_MAX]) {
  uint64_t raw;
  *out = (ethd__kernel_count){.device = -1, .count = -1};
  ethd_status status = open_files(calls, s, j, other, out, message);
  if (!status) status = set_function(calls, s, j, message);
  if (!status) status = find_ceiling(calls, s, j, &out->ceiling, message);
  if (!status) status = enable(calls, s, j, message); /* some refuse a ceiling while they count */
  if (!status && ethd__kernel_count_read(calls, out, &raw))
    status = ethd__say(message, ETHD_E_DEVICE, "%s: count %d can't be read", s->device[j], s->count[j]);
  if (status) ethd__kernel_count_close(calls, out);
  return status;
}

void ethd__kernel_count_close(const ethd__counter_calls *calls, ethd__kernel_count *c) {
  if (c->count >= 0) calls->close(c->count);
  if (c->device >= 0 && !c->shared) {
    (void)calls->ioctl(c->device, COUNTER_DISABLE_EVENTS_IOCTL, NULL);
    calls->close(c->device);
  }
  *c = (ethd__kernel_count){.device = -1, .count = -1};
}

int ethd__kernel_count_read(const ethd__counter_calls *calls, const ethd__kernel_count *c, uint64_t *raw) {
  char text[32];
  ssize_t n = calls->read_text(c->count, text, sizeof text - 1);
  if (n <= 0) return -1;
  text[n] = 0;
  text[strcspn(text, "\n")] = 0;
  return to_count(text, raw);
}

/* ---- watches ---- */

static int add_watch(const ethd__counter_calls *calls, int fd, uint8_t count, uint8_t event, uint8_t channel) {
  struct counter_watch watch = {
      .component = {.type = COUNTER_COMPONENT_COUNT, .scope = COUNTER_SCOPE_COUNT, .parent = count},
      .event = event,
      .channel = channel};
  return calls->ioctl(fd, COUNTER_ADD_WATCH_IOCTL, &watch);
}

/* A count without an index is refused only where there must be one, or edges. */
ethd_status ethd__kernel_count_watch(const ethd__counter_calls *calls, const ethd__counter_settings *s, int j,
                                     const ethd__kernel_count *counts, char message[ETHD_MESSAGE_MAX]) {
  int fd = counts[j].device, last = j == 1 ? 1 : counts[1].shared ? 1 : 0, watched = 0;
  if (counts[j].shared) return ETHD_OK;
  for (int k = j; k <= last; k++) {
    int index = !add_watch(calls, fd, s->count[k], COUNTER_EVENT_INDEX, s->channel[k]);
    int edges = s->p[ETHD__COUNTER_STAMPS] != 0 &&
                !add_watch(calls, fd, s->count[k], COUNTER_EVENT_CHANGE_OF_STATE, s->channel[k]);
    if (!index && s->p[ETHD__COUNTER_HOME] != 0)
      return ethd__say(message, ETHD_E_DEVICE, "%s: count %d has no index event, so home = yes isn't possible",
                       s->device[k], s->count[k]);
    if (!edges && s->p[ETHD__COUNTER_STAMPS] != 0)
      return ethd__say(message, ETHD_E_DEVICE, "%s: count %d has no edge event, so stamps = yes isn't possible",
                       s->device[k], s->count[k]);
    watched += index + edges;
  }
  if (watched && calls->ioctl(fd, COUNTER_ENABLE_EVENTS_IOCTL, NULL)) return say_errno(s->device[j], "events", message);
  return ETHD_OK;
}
