#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- keys that only files have ---- */

/* Returns the whole path of a driver's file, so that it means the same in a recording's folder; NULL: no memory. If
   there is no such file, opening it says so. */
static char *whole_path(const ethd__config *c, const char *name, size_t length) {
  char *relative = strndup(name, length), *joined = relative ? ethd__path_join(c->config.folder, relative) : NULL;
  char *path = joined ? realpath(joined, NULL) : NULL;
  free(relative);
  if (!path) return joined;
  free(joined);
  return path;
}

/* Adds the next name, of `length` bytes. */
static ethd_status add_driver(ethd__config *c, const ethd__key *key, const char *name, size_t length) {
  const size_t mark = strlen(ETHD_DRIVER_FILE);
  char *to = c->config.device, *path = NULL;
  size_t n = strlen(to), room = sizeof c->config.device - n;
  if (length > mark && strncmp(name, ETHD_DRIVER_FILE, mark) == 0) {
    path = whole_path(c, name + mark, length - mark);
    if (!path) return ethd__no_memory(key->message, key->file);
  }
  if (!length) return ethd__key_refuse(key, ETHD_E_SYNTAX, "a driver's name is missing before or after a comma");
  int written = path ? snprintf(to + n, room, "%s%s%s", n ? ", " : "", ETHD_DRIVER_FILE, path)
                     : snprintf(to + n, room, "%s%.*s", n ? ", " : "", (int)length, name);
  free(path);
  if (written >= 0 && (size_t)written < room) return ETHD_OK;
  return ethd__key_refuse(key, ETHD_E_SYNTAX, "names and paths of drivers together have at most %d bytes",
                          ETHD_DRIVERS_TEXT_MAX - 1);
}

static ethd_status driver(ethd__config *c, const ethd__key *key) {
  const char *name = key->value;
  ethd_status status = ETHD_OK;
  c->config.device[0] = 0;
  for (bool more = true; !status && more;) {
    name += strspn(name, " \t");
    size_t length = strcspn(name, ","), rest = length;
    while (length && (name[length - 1] == ' ' || name[length - 1] == '\t')) length--;
    status = add_driver(c, key, name, length);
    more = name[rest] == ',';
    name += rest + more;
  }
  return status;
}

static ethd_status device_setting(ethd__config *c, const ethd__key *key) {
  c->config.settings[c->config.setting_count++] = (ethd_setting){key->key, key->value, key->line};
  return ETHD_OK;
}

const ethd__section ethd__sections[] = {
    {"arm", {{0}}},
    {"ring", {{0}}},
    {"finger", {{0}}},
    {"loop", {{0}}},
    {"velocity", {{0}}},
    {"finger_fit", {{0}}},
    {"finger_filter", {{0}}},
    {"tracking", {{0}}},
    {"contact", {{0}}},
    {"transition", {{"preset", ETHD__PASS_PRESET, ethd__config_preset}}},
    {"scene", {{"file", ETHD__PASS_REST, ethd__config_scene}}},
    {"limits", {{0}}},
    {"device", {{"driver", ETHD__PASS_REST, driver}, {"*", ETHD__PASS_REST, device_setting}}},
    {"plugins", {{"file", ETHD__PASS_PLUGINS, ethd__config_plugin}}},
    {NULL, {{0}}},
};

static const ethd__section *find_section(const char *name) {
  for (const ethd__section *s = ethd__sections; s->name; s++)
    if (strcmp(s->name, name) == 0) return s;
  return NULL;
}

static const ethd__file_key *find_file_key(const char *section, const char *key) {
  const ethd__section *s = find_section(section);
  for (size_t i = 0; s && i < sizeof s->keys / sizeof *s->keys && s->keys[i].key; i++)
    if (strcmp(s->keys[i].key, key) == 0 || strcmp(s->keys[i].key, "*") == 0) return &s->keys[i];
  return NULL;
}

static bool chooses(const char *section, const char *key) {
  const ethd_setup_part *part = ethd_setup_part_of(section);
  return part && strcmp(part->chooser, key) == 0;
}

bool ethd__config_in_files_only(const char *section, const char *key) {
  return find_file_key(section, key) || chooses(section, key);
}

/* ---- any key ---- */

ethd_status ethd__config_read(ethd__config *whole, const ethd__key *key, ethd__pass pass) {
  ethd_config *c = &whole->config;
  const ethd__file_key *file_key = find_file_key(key->section, key->key);
  if (file_key) return file_key->pass == pass ? file_key->read(whole, key) : ETHD_OK;
  if (chooses(key->section, key->key))
    return pass == ETHD__PASS_CHOICES ? ethd__config_choose(c, key, &c->setup) : ETHD_OK;
  if (pass != ETHD__PASS_REST) return ETHD_OK;
  int limit = ethd__config_limit(key->section, key->key);
  if (limit >= 0) c->limits_given |= 1u << limit;
  return ethd__config_number(key, &c->setup);
}

/* ---- unknown keys and sections ---- */

/* "unknown section; arm, ... are allowed" */
static const char *unknown_section(char out[ETHD_MESSAGE_MAX]) {
  char list[ETHD_MESSAGE_MAX] = "";
  for (const ethd__section *s = ethd__sections; s->name; s++) ethd__list_add(list, s->name);
  snprintf(out, ETHD_MESSAGE_MAX, "unknown section; %.*s are allowed", ETHD_MESSAGE_MAX - 64, list);
  return out;
}

ethd_status ethd__config_section_known(const ethd_ini_section *section, const char *file,
                                       char message[ETHD_MESSAGE_MAX]) {
  char what[ETHD_MESSAGE_MAX];
  if (find_section(section->name)) return ETHD_OK;
  return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: [%s]: %s", file, section->line, section->name,
                   unknown_section(what));
}

ethd_status ethd__config_unknown(const ethd__key *key, const ethd_setup *setup) {
  const ethd__section *section = find_section(key->section);
  const ethd_setup_part *part = ethd_setup_part_of(key->section);
  char list[ETHD_MESSAGE_MAX] = "";
  ethd_setup_key row;
  if (!section) return ethd__key_refuse(key, ETHD_E_UNKNOWN, "%s", unknown_section(list));
  if (part) ethd__list_add(list, part->chooser);
  for (size_t i = 0; i < sizeof section->keys / sizeof *section->keys && section->keys[i].key; i++)
    ethd__list_add(list, section->keys[i].key);
  for (uint32_t i = 0; ethd_setup_key_at(setup, i, &row) == ETHD_OK; i++)
    if (strcmp(row.section, key->section) == 0) ethd__list_add(list, row.param.name);
  if (!part) return ethd__key_refuse(key, ETHD_E_UNKNOWN, "unknown key; %s are allowed", list);
  return ethd__key_refuse(key, ETHD_E_UNKNOWN, "not a key of %s, which has %s", ethd_setup_chosen(setup, part).id,
                          list);
}
