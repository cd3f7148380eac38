#include "inject/script.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"
#include "text/text.h"

#define BLANKS " \t\r"
#define BIT(kind) (1u << ETHD__INJECT_##kind)
#define NOT (-1)
#define VALUES (BIT(FREEZE) | BIT(OFFSET) | BIT(REVERSE) | BIT(SCALE) | BIT(NOISE) | BIT(SET_TO) | BIT(NAN))

static const struct {
  const char *name;
  int32_t plane, space; /* count of the channel's numbers in each front; 0: none; NOT: the front has no such channel */
  uint32_t kinds;
} channels[ETHD__INJECT_CHANNELS] = {
    [ETHD__INJECT_Q] = {"q", 2, NOT, VALUES},
    [ETHD__INJECT_DQ] = {"dq", 2, NOT, VALUES},
    [ETHD__INJECT_CENTRE] = {"centre", 2, 3, VALUES},
    [ETHD__INJECT_FINGER] = {"finger", 2, 3, VALUES},
    [ETHD__INJECT_RING] = {"ring", 2, NOT, VALUES},
    [ETHD__INJECT_RAY] = {"ray", ETHD_RAYS, NOT, VALUES},
    [ETHD__INJECT_X] = {"x", NOT, 3, VALUES},
    [ETHD__INJECT_V] = {"v", NOT, 3, VALUES},
    [ETHD__INJECT_TIME] = {"time", 0, 0, BIT(FREEZE) | BIT(OFFSET)},
    [ETHD__INJECT_READING] = {"reading", 0, 0, BIT(FREEZE) | BIT(DROP) | BIT(DELAY)},
    [ETHD__INJECT_READ] = {"read", 0, 0, BIT(FAIL) | BIT(STALE)},
    [ETHD__INJECT_WRITE] = {"write", 0, 0, BIT(FAIL) | BIT(DROP) | BIT(DELAY) | BIT(SCALE)},
    [ETHD__INJECT_SERVICE] = {"service", 0, 0, BIT(FAIL) | BIT(DROP)},
    [ETHD__INJECT_START] = {"start", 0, 0, BIT(FAIL)},
    [ETHD__INJECT_FAULT] = {"fault", ETHD_FAULT_COUNT - 1, ETHD_FAULT_COUNT - 1, BIT(SET) | BIT(GRAVE)},
};

static const struct {
  const char *name;
  bool by; /* 1: has a number */
  double min, max;
} kinds[ETHD__INJECT_KINDS] = {
    [ETHD__INJECT_FREEZE] = {"freeze", 0, 0, 0},   [ETHD__INJECT_OFFSET] = {"offset", 1, -1e6, 1e6},
    [ETHD__INJECT_REVERSE] = {"reverse", 0, 0, 0}, [ETHD__INJECT_SCALE] = {"scale", 1, -1e6, 1e6},
    [ETHD__INJECT_NOISE] = {"noise", 1, 0, 1e6},   [ETHD__INJECT_SET_TO] = {"value", 1, -1e6, 1e6},
    [ETHD__INJECT_NAN] = {"nan", 0, 0, 0},         [ETHD__INJECT_DROP] = {"drop", 0, 0, 0},
    [ETHD__INJECT_DELAY] = {"delay", 1, 0, 1},     [ETHD__INJECT_FAIL] = {"fail", 0, 0, 0},
    [ETHD__INJECT_STALE] = {"stale", 0, 0, 0},     [ETHD__INJECT_SET] = {"set", 0, 0, 0},
    [ETHD__INJECT_GRAVE] = {"grave", 0, 0, 0},
};

/* ---- words ---- */

typedef struct script_reader {
  const char *name;
  char *message;
  int line;
  ethd__script_of of;
} script_reader;

typedef struct script_word {
  const char *at;
  size_t length;
} script_word;

static ethd_status refuse(const script_reader *r, ethd_status status, script_word w, const char *allowed) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(r->message, status, "%s:%d: found %s; %s", r->name, r->line,
                   w.length ? ethd__quote(w.at, w.length, quote) : "the line's end", allowed);
}

static script_word next_word(const char **at, const char *end) {
  script_word w;
  while (*at < end && strchr(BLANKS, **at) && **at) ++*at;
  w.at = *at;
  while (*at < end && !(strchr(BLANKS, **at) && **at)) ++*at;
  w.length = (size_t)(*at - w.at);
  return w;
}

static bool is_word(script_word w, const char *name) {
  return strlen(name) == w.length && !memcmp(w.at, name, w.length);
}

/* Returns the rest of a word after `prefix`, or an empty word when it begins differently. */
static script_word behind(script_word w, const char *prefix) {
  size_t n = strlen(prefix);
  if (w.length <= n || memcmp(w.at, prefix, n) != 0) return (script_word){w.at, 0};
  return (script_word){w.at + n, w.length - n};
}

/* ---- one line ---- */

static ethd_status read_time(const script_reader *r, script_word w, ethd__injection *out) {
  int ticks = w.length > 1 && w.at[w.length - 1] == 't';
  double t, unit = ticks ? r->of.period : 1;
  if (!ethd__number(w.at, w.length - (size_t)ticks, &t) || !(t >= 0 && t * unit <= 1e6))
    return refuse(r, ETHD_E_SYNTAX, w, "a line begins with a time, 0 to 1e6 s, or in periods, as in 500t");
  out->from_ns = (int64_t)rint(1e9 * t * unit);
  return ETHD_OK;
}

/* "ray5": the fifth; "ray": all. */
static bool names(script_word w, int channel, bool in_space, ethd__injection *out) {
  const char *name = channels[channel].name;
  const int32_t has = in_space ? channels[channel].space : channels[channel].plane;
  uint32_t number = 0, numbers = has < 0 ? 0 : (uint32_t)has;
  if (has < 0) return false;
  out->first = 0;
  out->count = numbers ? numbers : 1;
  if (is_word(w, name)) return channel != ETHD__INJECT_FAULT;
  script_word tail = behind(w, name);
  if (numbers > 2 && channel == ETHD__INJECT_RAY && is_word(w, "rays")) return true;
  if (tail.length < 1 || tail.length > 2) return false;
  for (size_t i = 0; i < tail.length; i++) {
    if (tail.at[i] < '0' + (i == 0) || tail.at[i] > '9') return false;
    number = 10 * number + (uint32_t)(tail.at[i] - '0');
  }
  if (number > numbers) return false;
  out->first = number - 1;
  out->count = 1;
  return true;
}

static ethd_status read_channel(const script_reader *r, script_word w, ethd__injection *out) {
  for (int i = 0; i < ETHD__INJECT_CHANNELS; i++)
    if (names(w, i, r->of.in_space, out)) {
      out->channel = (ethd__inject_channel)i;
      return ETHD_OK;
    }
  if (r->of.in_space)
    return refuse(
        r, ETHD_E_UNKNOWN, w,
        "channels in space are x1 x2 x3 v1 v2 v3 centre1 centre2 centre3 finger1 finger2 finger3 time reading "
        "read write service start fault1..fault39");
  return refuse(r, ETHD_E_UNKNOWN, w,
                "channels are q1 q2 dq1 dq2 centre1 centre2 finger1 finger2 ring1 ring2 ray1..ray16 time reading "
                "read write service start fault1..fault39");
}

static ethd_status read_kind(const script_reader *r, script_word w, ethd__injection *out) {
  char list[ETHD_MESSAGE_MAX / 2] = "kinds of this channel are";
  for (int i = 0; i < ETHD__INJECT_KINDS; i++) {
    if (!(channels[out->channel].kinds >> i & 1)) continue;
    if (is_word(w, kinds[i].name)) {
      out->kind = (ethd__inject_kind)i;
      return ETHD_OK;
    }
    strncat(list, " ", sizeof list - strlen(list) - 1);
    strncat(list, kinds[i].name, sizeof list - strlen(list) - 1);
  }
  return refuse(r, ETHD_E_UNKNOWN, w, list);
}

static ethd_status read_by(const script_reader *r, script_word w, script_word number, ethd__injection *out) {
  double min = kinds[out->kind].min, max = kinds[out->kind].max;
  if (!kinds[out->kind].by) return refuse(r, ETHD_E_UNKNOWN, w, "this kind has no by=");
  if (!isnan(out->by)) return refuse(r, ETHD_E_DUPLICATE, w, "by= may occur once");
  if (!ethd__number(number.at, number.length, &out->by) || !(out->by >= min && out->by <= max)) {
    char allowed[64];
    snprintf(allowed, sizeof allowed, "by= is %g to %g", min, max);
    return refuse(r, ETHD_E_RANGE, w, allowed);
  }
  return ETHD_OK;
}

static ethd_status read_for(const script_reader *r, script_word w, script_word number, ethd__injection *out) {
  double t;
  if (out->until_ns) return refuse(r, ETHD_E_DUPLICATE, w, "for= may occur once");
  if (!ethd__number(number.at, number.length, &t) || !(t >= 1e-9 && (t <= 1e6 || isinf(t))))
    return refuse(r, ETHD_E_RANGE, w, "for= is 1e-9 to 1e6 s, or inf");
  out->until_ns = isinf(t) ? INT64_MAX : out->from_ns + (int64_t)rint(1e9 * t);
  return ETHD_OK;
}

static ethd_status read_rest(const script_reader *r, const char *at, const char *end, ethd__injection *out) {
  ethd_status status = ETHD_OK;
  for (script_word w = next_word(&at, end); w.length && !status; w = next_word(&at, end)) {
    script_word by = behind(w, "by="), duration = behind(w, "for=");
    status = by.length         ? read_by(r, w, by, out)
             : duration.length ? read_for(r, w, duration, out)
                               : refuse(r, ETHD_E_SYNTAX, w, "by=NUMBER and for=SECONDS are allowed after the kind");
  }
  if (!status && kinds[out->kind].by && isnan(out->by))
    status = refuse(r, ETHD_E_ARGUMENT, (script_word){at, 0}, "this kind needs by=NUMBER");
  if (!out->until_ns) out->until_ns = out->from_ns + (int64_t)rint(1e9 * r->of.period);
  return status;
}

static ethd_status read_line(const script_reader *r, const char *at, const char *end, ethd__injection *out) {
  *out = (ethd__injection){.line = r->line, .by = (double)NAN};
  ethd_status status = read_time(r, next_word(&at, end), out);
  if (!status) status = read_channel(r, next_word(&at, end), out);
  if (!status) status = read_kind(r, next_word(&at, end), out);
  return status ? status : read_rest(r, at, end, out);
}

/* ---- the file ---- */

static bool is_blank(const char *at, const char *end) {
  for (; at < end; at++)
    if (!*at || !strchr(BLANKS, *at)) return false;
  return true;
}

static ethd_status read_lines(script_reader *r, const char *text, size_t length, ethd__script *out) {
  const char *end = text + length;
  for (const char *at = text; at < end; r->line++) {
    const char *stop = memchr(at, '\n', (size_t)(end - at));
    const char *next = stop ? stop + 1 : end;
    if (!stop) stop = end;
    const char *comment = memchr(at, '#', (size_t)(stop - at));
    if (comment) stop = comment;
    if (!is_blank(at, stop)) {
      if (out->count == ETHD_INJECT_LINES_MAX)
        return ethd__say(r->message, ETHD_E_FULL, "%s:%d: over %d injections", r->name, r->line, ETHD_INJECT_LINES_MAX);
      ethd_status status = read_line(r, at, stop, &out->at[out->count]);
      if (status) return status;
      out->count++;
    }
    at = next;
  }
  return ETHD_OK;
}

ethd_status ethd__script_parse(const char *text, size_t length, const char *name, ethd__script_of of, ethd__script *out,
                               char message[ETHD_MESSAGE_MAX]) {
  script_reader r = {.name = name, .message = message, .line = 1, .of = of};
  *out = (ethd__script){.at = calloc(ETHD_INJECT_LINES_MAX, sizeof *out->at)};
  if (!out->at) return ethd__no_memory(message, name);
  ethd_status status = read_lines(&r, text, length, out);
  if (status) ethd__script_free(out);
  return status;
}

ethd_status ethd__script_load(const char *path, ethd__script_of of, ethd__script *out, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *text = NULL;
  size_t length;
  *out = (ethd__script){.count = 0};
  ethd_status status = ethd_text_read(path, ETHD_INJECT_BYTES_MAX, &text, &length, message);
  return status ? status : ethd__script_parse(text, length, path, of, out, message);
}

void ethd__script_free(ethd__script *script) {
  free(script->at);
  *script = (ethd__script){.count = 0};
}
