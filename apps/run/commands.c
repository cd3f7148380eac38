#include "run/commands.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/terminal.h"
#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

static void answer(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void answer(const char *format, ...) {
  va_list args;
  va_start(args, format);
  vprintf(format, args);
  va_end(args);
  putchar('\n');
  fflush(stdout);
}

/* ---- the commands ---- */

static void post(ethd__session *s, ethd_status status, const ethd__setup_copy *setup, const char *kind,
                 const char *detail, char *message) {
  if (!status) status = ethd__session_post(s, setup, kind, detail, message);
  if (status)
    answer("error: %s", message);
  else
    answer("ok: %s %s", kind, detail);
}

static void law(ethd__session *s, const char *kind, const char *id) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__setup_copy setup = s->setup;
  if (*id)
    post(s, ethd__config_law(s->config, s->front->config, kind, id, &setup, message), &setup, kind, id, message);
  else
    answer("error: %s LAW", kind);
}

static void tracking(ethd__session *s, ethd__commands *c, char *rest) { (void)c, law(s, "tracking", rest); }
static void contact(ethd__session *s, ethd__commands *c, char *rest) { (void)c, law(s, "contact", rest); }
static void transition(ethd__session *s, ethd__commands *c, char *rest) { (void)c, law(s, "transition", rest); }

static void set(ethd__session *s, ethd__commands *c, char *rest) {
  char message[ETHD_MESSAGE_MAX] = "", detail[ETHD__LINE_MAX];
  ethd__setup_copy setup = s->setup;
  size_t key = strcspn(rest, " \t");
  char *value = rest + key + strspn(rest + key, " \t");
  (void)c;
  if (!*value) {
    answer("error: set SECTION.KEY VALUE");
    return;
  }
  rest[key] = 0;
  snprintf(detail, sizeof detail, "%s %s", rest, value);
  post(s, ethd__config_set(s->config, s->front->config, rest, value, &setup, message), &setup, "set", detail, message);
}

static void status(ethd__session *s, ethd__commands *c, char *rest) {
  static ethd_loop_stats stats;
  const ethd__row row = ethd__recorder_latest(&s->recorder);
  const ethd_fault fault = (ethd_fault)s->front->head(&row).fault;
  const ethd_law *laws[ETHD_TRANSITION + 1];
  char says[256];
  (void)c, (void)rest;
  ethd_loop_read(s->loop, &stats);
  s->front->laws(&s->setup, laws);
  s->front->say(&s->setup, &row, says, sizeof says);
  answer("ok: t %.3f s, %s, %s, %s, %" PRIu64 " overruns, %s", ethd__session_time(s),
         ethd_loop_armed(s->loop) ? "enabled" : "disabled", laws[ETHD_TRANSITION]->id, says, stats.overruns,
         ethd_fault_sentence(fault));
}

static bool faulty(ethd__session *s) { return ethd__recorder_fault(&s->recorder) != ETHD_FAULT_NONE; }

static const char *latched(ethd__session *s) { return ethd_fault_sentence(ethd__recorder_fault(&s->recorder)); }

/* The device is asked at once to clear its own fault. The controller's fault can be cleared only after a time without
   faults; if the device had a fault, this needs a second ack. */
static void ack(ethd__session *s, ethd__commands *c, char *rest) {
  (void)c, (void)rest;
  ethd_device_clear(s->device);
  if (!faulty(s)) {
    answer("error: there is no fault to acknowledge");
    return;
  }
  double needed, clean = ethd__session_clean_time(s, &needed);
  if (clean < needed * (1 - 1e-9)) {
    answer("error: no fault for %.3f s, %g s are required", clean, needed);
    return;
  }
  if (!ethd__session_acknowledge(s))
    answer("error: the fault is still there: %s", latched(s));
  else
    answer(ethd_loop_armed(s->loop) ? "ok: acknowledged"
                                    : "ok: acknowledged; the device is disabled, enable starts it");
}

static void enable(ethd__session *s, ethd__commands *c, char *rest) {
  (void)c, (void)rest;
  if (ethd_loop_armed(s->loop)) {
    answer("error: the device is enabled");
  } else if (faulty(s)) {
    answer("error: a fault is latched: %s; ack comes first", latched(s));
  } else {
    ethd_status failure = ethd__session_enable(s);
    const char *why = ethd_device_why(s->device);
    if (failure)
      answer("error: starting the device again: %s%s%s", ethd_status_sentence(failure), why[0] ? ": " : "", why);
    else
      answer("ok: enabled");
  }
}

/* "home" finds the joints' angles by moving, as the device's settings say. With "home Q1 Q2" the arm is in its jig, at
   these angles. */
static void home(ethd__session *s, ethd__commands *c, char *rest) {
  double q[2];
  size_t n = strcspn(rest, " \t");
  char *second = rest + n + strspn(rest + n, " \t");
  (void)c;
  if (*rest && !(ethd__number(rest, n, &q[0]) && ethd__number(second, strlen(second), &q[1]))) {
    answer("error: home, or home Q1 Q2, the joints' angles in rad");
    return;
  }
  if (ethd_loop_armed(s->loop)) {
    answer("error: the device is enabled");
    return;
  }
  ethd_status failure = ethd_loop_home(s->loop, *rest ? q : NULL);
  const char *why = ethd_device_why(s->device);
  if (failure)
    answer("error: %s%s%s", ethd_status_sentence(failure), why[0] ? ": " : "", why);
  else
    answer("ok: the joints are found; enable starts the device");
}

static void stop(ethd__session *s, ethd__commands *c, char *rest) {
  (void)s, (void)rest;
  c->stop = true;
  answer("ok: stopping");
}

static void wait_for(ethd__session *s, ethd__commands *c, char *rest) {
  double seconds;
  if (!ethd__number(rest, strlen(rest), &seconds) || !(seconds >= 0 && seconds <= 1e6)) {
    answer("error: wait: a number of seconds from 0 to 1000000 is allowed");
    return;
  }
  c->hold = ethd__session_time(s) + seconds;
  answer("ok: waiting");
}

static const struct {
  const char *word;
  void (*run)(ethd__session *s, ethd__commands *c, char *rest);
  bool alone;
} table[] = {{"transition", transition, false},
             {"contact", contact, false},
             {"tracking", tracking, false},
             {"set", set, false},
             {"status", status, true},
             {"ack", ack, true},
             {"enable", enable, true},
             {"home", home, false},
             {"stop", stop, true},
             {"wait", wait_for, false}};

/* ---- lines ---- */

static void run(ethd__commands *c, ethd__session *s) {
  char *word = c->line + strspn(c->line, " \t"), quote[ETHD_QUOTE_MAX];
  for (size_t n = strlen(word); n && strchr(" \t\r", word[n - 1]);) word[--n] = 0;
  size_t length = strcspn(word, " \t");
  char *rest = word + length + strspn(word + length, " \t");
  if (!*word) return;
  for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
    if (strlen(table[i].word) != length || memcmp(table[i].word, word, length) != 0) continue;
    if (table[i].alone && *rest)
      answer("error: %s has no argument", table[i].word);
    else
      table[i].run(s, c, rest);
    return;
  }
  answer("error: found %s; transition, contact, tracking, set, status, ack, enable, home, stop, wait are allowed",
         ethd__quote(word, length, quote));
}

static void end_line(ethd__commands *c, ethd__session *s) {
  c->line[c->length] = 0;
  if (c->overlong)
    answer("error: a line over %d bytes", ETHD__LINE_MAX - 1);
  else
    run(c, s);
  c->length = 0;
  c->overlong = false;
}

void ethd__commands_read(ethd__commands *c, ethd__session *s, int wait_ms) {
  struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};
  char byte;
  while (!c->ended && poll(&in, ethd__stdin_is_ours(), wait_ms) > 0) {
    ssize_t n = read(STDIN_FILENO, &byte, 1);
    if (n < 0 && (errno == EINTR || errno == EAGAIN || !ethd__stdin_is_ours())) return;
    c->ended = n <= 0;
    if (n <= 0 && !c->length) return;
    if (n <= 0 || byte == '\n') {
      end_line(c, s);
      return;
    }
    if (c->length < ETHD__LINE_MAX - 1 && byte)
      c->line[c->length++] = byte;
    else
      c->overlong = true;
  }
}
