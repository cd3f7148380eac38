#include "text/ini.h"

#include <ini.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"

#define LINE_MAX_LENGTH 197u /* inih keeps 200 bytes of a line with its end */
#define NAME_MAX_LENGTH 49u  /* and 50 bytes of a section's name */

typedef struct feed {
  const char *at, *end;
  int line;
  const char *name, *repeats, *prose;
  ethd_ini *out;
  ethd_status status;
  char *message;
} feed;

#define REFUSE(f, code, ...) ((f)->status = ethd__say((f)->message, code, __VA_ARGS__))

/* ---- lines, before inih sees them ---- */

typedef struct key_span {
  const char *text;
  size_t length;
} key_span;

static bool blank(char c) { return c == ' ' || c == '\t'; }

static key_span trimmed(key_span s) {
  while (s.length && blank(*s.text)) s.text++, s.length--;
  while (s.length && blank(s.text[s.length - 1])) s.length--;
  return s;
}

/* Returns a line up to its comment. Builds of inih differ in what they take for a comment, so this decides for all. */
static key_span uncommented(key_span s) {
  s = trimmed(s);
  if (s.length && (*s.text == '#' || *s.text == ';')) s.length = 0;
  for (size_t i = 1; i < s.length; i++)
    if (s.text[i] == ';' && blank(s.text[i - 1])) s.length = i;
  return trimmed(s);
}

static key_span next_line(feed *f) {
  const char *newline = memchr(f->at, '\n', (size_t)(f->end - f->at));
  key_span s = {f->at, (size_t)((newline ? newline : f->end) - f->at)};
  f->at = newline ? newline + 1 : f->end;
  f->line++;
  if (s.length && s.text[s.length - 1] == '\r') s.length--;
  return s;
}

static void check_text(feed *f, key_span s) {
  for (size_t i = 0; i < s.length; i++) {
    unsigned char c = (unsigned char)s.text[i];
    if (c >= ' ' && c != 0x7f) continue;
    if (c == '\t') continue;
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: a byte %u: this isn't text", f->name, f->line, c);
    return;
  }
}

/* Keeps a section here, because inih doesn't report one without keys. */
static void keep_section(feed *f, key_span name) {
  ethd_ini *ini = f->out;
  if (ini->section_count == ETHD_INI_SECTIONS_MAX) {
    REFUSE(f, ETHD_E_RANGE, "%s:%d: over %u sections", f->name, f->line, ETHD_INI_SECTIONS_MAX);
    return;
  }
  char *copy = strndup(name.text, name.length);
  if (!copy) f->status = ethd__no_memory(f->message, f->name);
  if (copy) ini->sections[ini->section_count++] = (ethd_ini_section){copy, f->line};
}

static void check_section(feed *f, key_span s) {
  char quote[ETHD_QUOTE_MAX];
  const char *close = memchr(s.text, ']', s.length);
  if (!close)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: found %s, a section needs its ]", f->name, f->line,
           ethd__quote(s.text, s.length, quote));
  else if (close != s.text + s.length - 1)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: found %s, nothing is allowed after ]", f->name, f->line,
           ethd__quote(s.text, s.length, quote));
  else if (s.length - 2 > NAME_MAX_LENGTH)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: a section's name of %zu characters, at most %u are allowed", f->name, f->line,
           s.length - 2, NAME_MAX_LENGTH);
  else
    keep_section(f, (key_span){s.text + 1, s.length - 2});
}

/* Returns true for key = value; inih would take ':' for '=' too. */
static bool is_pair(key_span s) {
  const char *equals = memchr(s.text, '=', s.length);
  return equals && !memchr(s.text, ':', (size_t)(equals - s.text));
}

static void check_line(feed *f, key_span s) {
  char quote[ETHD_QUOTE_MAX];
  check_text(f, s);
  s = uncommented(s);
  if (f->status || !s.length) return;
  if (s.length > LINE_MAX_LENGTH)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: a line of %zu characters, at most %u are allowed", f->name, f->line, s.length,
           LINE_MAX_LENGTH);
  else if (*s.text == '[')
    check_section(f, s);
  else if (!is_pair(s))
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: found %s, [section] or key = value is allowed", f->name, f->line,
           ethd__quote(s.text, s.length, quote));
}

/* Returns whether the line is a key in a section of prose, which inih doesn't see. */
static bool is_prose(const feed *f, key_span s) {
  char section[NAME_MAX_LENGTH + 3];
  s = trimmed(s);
  if (!f->prose || !f->out->section_count || !s.length || strchr("[#;", *s.text)) return false;
  snprintf(section, sizeof section, " %s ", f->out->sections[f->out->section_count - 1].name);
  return strstr(f->prose, section) != NULL;
}

/* ---- keys, as inih hands them on, or lines of prose ---- */

static bool repeatable(const feed *f, const char *section, const char *key) {
  size_t n = strlen(section);
  return f->repeats && strncmp(f->repeats, section, n) == 0 && f->repeats[n] == '.' &&
         strcmp(f->repeats + n + 1, key) == 0;
}

static bool check_key(feed *f, const char *section, const char *key, const char *value) {
  const ethd_ini_key *twin = ethd_ini_find(f->out, section, key);
  if (!*section)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: %s: a key before the first [section]", f->name, f->line, key);
  else if (!*key)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: %s: a value without a key", f->name, f->line, section);
  else if (!*value)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: %s.%s: found nothing, a value is needed", f->name, f->line, section, key);
  else if (twin && !repeatable(f, section, key))
    REFUSE(f, ETHD_E_DUPLICATE, "%s:%d: %s.%s: occurs twice, first on line %d", f->name, f->line, section, key,
           twin->line);
  else if (f->out->count == ETHD_INI_KEYS_MAX)
    REFUSE(f, ETHD_E_RANGE, "%s:%d: over %u keys", f->name, f->line, ETHD_INI_KEYS_MAX);
  return !f->status;
}

static int take_key(void *user, const char *section, const char *key, const char *value) {
  feed *f = user;
  if (f->status || !check_key(f, section, key, value)) return 0;
  ethd_ini_key *k = &f->out->keys[f->out->count++];
  *k = (ethd_ini_key){strdup(section), strdup(key), strdup(value), f->line};
  if (!k->section || !k->key || !k->value) f->status = ethd__no_memory(f->message, f->name);
  return !f->status;
}

static void take_prose(feed *f, key_span s) {
  char quote[ETHD_QUOTE_MAX];
  check_text(f, s);
  if (!f->status && !is_pair(s))
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: found %s, [section] or key = value is allowed", f->name, f->line,
           ethd__quote(s.text, s.length, quote));
  if (f->status) return;
  size_t equals = (size_t)((const char *)memchr(s.text, '=', s.length) - s.text);
  key_span left = trimmed((key_span){s.text, equals}),
           right = trimmed((key_span){s.text + equals + 1, s.length - equals - 1});
  char *key = strndup(left.text, left.length);
  ETHD__FREED char *value = strndup(right.text, right.length);
  if (!key || !value)
    f->status = ethd__no_memory(f->message, f->name);
  else
    (void)take_key(f, f->out->sections[f->out->section_count - 1].name, key, value);
  free(key);
}

/* Gives inih its lines in place of fgets. It can't take a line that starts in the first column for a continuation. */
static char *read_line(char *out, int room, void *user) {
  feed *f = user;
  if (f->status || f->at >= f->end) return NULL;
  key_span s = next_line(f);
  if (is_prose(f, s)) {
    take_prose(f, trimmed(s));
    s.length = 0;
  }
  check_line(f, s);
  s = uncommented(s);
  if (!f->status && s.length + 1 > (size_t)room)
    REFUSE(f, ETHD_E_SYNTAX, "%s:%d: a line of %zu characters; this build of inih reads at most %d", f->name, f->line,
           s.length, room - 1);
  if (f->status) return NULL;
  memcpy(out, s.text, s.length);
  out[s.length] = 0;
  return out;
}

ethd_status ethd_ini_parse(const char *text, size_t length, const char *name, const char *repeats, const char *prose,
                           ethd_ini *out, char message[ETHD_MESSAGE_MAX]) {
  feed f = {text, text + length, 0, name, repeats, prose, out, ETHD_OK, message};
  *out = (ethd_ini){.keys = calloc(ETHD_INI_KEYS_MAX, sizeof *out->keys),
                    .sections = calloc(ETHD_INI_SECTIONS_MAX, sizeof *out->sections)};
  if (!out->keys || !out->sections) {
    ethd_ini_free(out);
    return ethd__no_memory(message, name);
  }
  if (length > ETHD_INI_BYTES_MAX)
    REFUSE(&f, ETHD_E_RANGE, "%s: %zu bytes, at most %zu are allowed", name, length, ETHD_INI_BYTES_MAX);
  if (length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) f.at += 3;
  locale_t own = uselocale(ethd__c_locale); /* by which inih knows spaces: some have one within a letter of UTF-8 */
  int line = ini_parse_stream(read_line, &f, take_key, &f);
  uselocale(own);
  if (!f.status && line) REFUSE(&f, ETHD_E_SYNTAX, "%s:%d: a line that cannot be read", name, line);
  if (f.status) ethd_ini_free(out);
  return f.status;
}

const ethd_ini_key *ethd_ini_find(const ethd_ini *ini, const char *section, const char *key) {
  for (uint32_t i = 0; i < ini->count; i++)
    if (strcmp(ini->keys[i].section, section) == 0 && strcmp(ini->keys[i].key, key) == 0) return &ini->keys[i];
  return NULL;
}

void ethd_ini_free(ethd_ini *ini) {
  for (uint32_t i = 0; i < ini->count; i++) {
    free(ini->keys[i].section);
    free(ini->keys[i].key);
    free(ini->keys[i].value);
  }
  for (uint32_t i = 0; i < ini->section_count; i++) free(ini->sections[i].name);
  free(ini->keys);
  free(ini->sections);
  *ini = (ethd_ini){0};
}
