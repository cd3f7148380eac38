#include "tune/tuned.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "text/text.h"

typedef struct rewriting {
  const ethd__tune_space *space;
  ethd__tune_gains gains;
  bool done[ETHD_TUNE_KEYS_MAX];
  bool other_folder;
  char section[ETHD_TUNE_KEY_MAX];
  size_t blank; /* blank lines that aren't written yet, because keys that the section lacks go before them */
  FILE *out;
} rewriting;

/* Returns the part of a key's name behind its section; NULL: the key belongs to another section. */
static const char *in_section(const char *name, const char *section) {
  size_t n = strlen(section);
  return !strncmp(name, section, n) && name[n] == '.' ? name + n + 1 : NULL;
}

/* Writes the keys that the section still lacks. */
static void finish_section(rewriting *w) {
  for (size_t k = 0; k < w->space->count; k++) {
    const char *key = in_section(w->space->keys[k].name, w->section);
    if (!key || w->done[k]) continue;
    fprintf(w->out, "%s = %s\n", key, w->gains.text[k]);
    w->done[k] = true;
  }
}

static bool is_path(const char *section, const char *key) {
  return (!strcmp(key, "file") && (!strcmp(section, "scene") || !strcmp(section, "plugins"))) ||
         (!strcmp(section, "device") && strchr("pmc", *key));
}

/* Writes the whole path of a file of the folder, and any other value as it is. */
static void put_path(rewriting *w, const char *value, size_t length) {
  ETHD__FREED char *name = strndup(value, length),
                   *path = name ? ethd__path_join(w->space->config->folder, name) : NULL;
  ETHD__FREED char *whole = path && !access(path, F_OK) ? realpath(path, NULL) : NULL;
  fputs(whole ? whole : name ? name : "", w->out);
}

/* Writes a line KEY = VALUE ; comment with a new value. */
static void put_key(rewriting *w, const char *line, size_t length) {
  const char *equals = memchr(line, '=', length), *end = line + length;
  size_t n = (size_t)(equals - line);
  while (n && isspace((unsigned char)line[n - 1])) n--;
  const char *value = equals + 1, *stop;
  while (value < end && isspace((unsigned char)*value)) value++;
  for (stop = value; stop < end && !(*stop == ';' && isspace((unsigned char)stop[-1])); stop++) {
  }
  while (stop > value && isspace((unsigned char)stop[-1])) stop--;
  char key[ETHD_TUNE_KEY_MAX];
  snprintf(key, sizeof key, "%.*s", (int)(n < sizeof key ? n : sizeof key - 1), line);
  fwrite(line, 1, (size_t)(value - line), w->out);
  const char *tuned = NULL;
  for (size_t k = 0; k < w->space->count && !tuned; k++) {
    const char *name = in_section(w->space->keys[k].name, w->section);
    if (name && !strcmp(name, key)) tuned = w->gains.text[k], w->done[k] = true;
  }
  if (tuned)
    fputs(tuned, w->out);
  else if (w->other_folder && is_path(w->section, key))
    put_path(w, value, (size_t)(stop - value));
  else
    fwrite(value, 1, (size_t)(stop - value), w->out);
  fwrite(stop, 1, (size_t)(end - stop), w->out);
}

static void put_blanks(rewriting *w) {
  for (; w->blank; w->blank--) putc('\n', w->out);
}

static void put_line(rewriting *w, const char *line, size_t length) {
  if (!length) {
    w->blank++;
    return;
  }
  if (*line == '[') {
    finish_section(w);
    put_blanks(w);
    size_t n = strcspn(line + 1, "]\n");
    snprintf(w->section, sizeof w->section, "%.*s", (int)(n < sizeof w->section ? n : 0), line + 1);
  }
  put_blanks(w);
  if (*line != '#' && *line != ';' && *line != '[' && memchr(line, '=', length))
    put_key(w, line, length);
  else
    fwrite(line, 1, length, w->out);
  putc('\n', w->out);
}

static void finish(rewriting *w) {
  finish_section(w);
  w->blank = 0;
  for (size_t k = 0; k < w->space->count; k++) {
    if (w->done[k]) continue;
    snprintf(w->section, sizeof w->section, "%.*s", (int)strcspn(w->space->keys[k].name, "."), w->space->keys[k].name);
    fprintf(w->out, "\n[%s]\n", w->section);
    finish_section(w);
  }
}

char *ethd__tuned_text(const ethd__tune_space *space, const ethd__tune_point *point, const char *head,
                       bool other_folder) {
  ethd__printed out;
  rewriting w = {.space = space, .other_folder = other_folder, .out = ethd__print_begin(&out)};
  ethd__space_gains(space, point, &w.gains);
  for (const char *line = head; *line; line += strcspn(line, "\n"), line += *line == '\n')
    fprintf(w.out, "# %.*s\n", (int)strcspn(line, "\n"), line);
  for (const char *line = space->config->text ? space->config->text : ""; *line;) {
    size_t n = strcspn(line, "\n");
    put_line(&w, line, n && line[n - 1] == '\r' ? n - 1 : n);
    line += n + (line[n] == '\n');
  }
  finish(&w);
  return ethd__print_end(&out);
}
