#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- keys that only files have ---- */

/* Returns the absolute path of a driver's file, so that it is valid in a recording's folder too; NULL: no memory. A
   missing file is reported when it is opened. */
static char *whole_path(const ethd__config *c, const char *name, size_t length) {
  ETHD__FREED char *relative = strndup(name, length);
  char *joined = relative ? ethd__path_join(c->config.folder, relative) : NULL;
  char *path = joined ? realpath(joined, NULL) : NULL;
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

#define PLANE ETHD__PLANE
#define SPACE ETHD__SPACE
#define BOTH ETHD__BOTH

const ethd__section ethd__sections[] = {
    {"arm", PLANE, {{0}}},
    {"ring", PLANE, {{0}}},
    {"finger", PLANE, {{0}}},
    {"loop", PLANE, {{0}}},
    {"space", SPACE, {{0}}},
    {"ability", SPACE, {{0}}},
    {"velocity", PLANE, {{0}}},
    {"finger_fit", PLANE, {{0}}},
    {"finger_filter", BOTH, {{0}}},
    {"tracking", BOTH, {{0}}},
    {"contact", BOTH, {{0}}},
    {"transition", PLANE, {{"preset", ETHD__PASS_PRESET, ethd__config_preset}}},
    {"transition", SPACE, {{0}}},
    {"scene", BOTH, {{"file", ETHD__PASS_REST, ethd__config_scene}}},
    {"limits", PLANE, {{0}}},
    {"device", BOTH, {{"driver", ETHD__PASS_REST, driver}, {"*", ETHD__PASS_REST, device_setting}}},
    {"plugins", BOTH, {{"file", ETHD__PASS_PLUGINS, ethd__config_plugin}}},
    {NULL, 0, {{0}}},
};

static const ethd__section *find_section(unsigned fronts, const char *name) {
  for (const ethd__section *s = ethd__sections; s->name; s++)
    if (s->fronts & fronts && strcmp(s->name, name) == 0) return s;
  return NULL;
}

static const ethd__file_key *find_file_key(const ethd__config_front *front, const char *section, const char *key) {
  const ethd__section *s = find_section(front->bit, section);
  for (size_t i = 0; s && i < sizeof s->keys / sizeof *s->keys && s->keys[i].key; i++)
    if (strcmp(s->keys[i].key, key) == 0 || strcmp(s->keys[i].key, "*") == 0) return &s->keys[i];
  return NULL;
}

static bool chooses(const ethd__config_front *front, const char *section, const char *key) {
  const ethd_setup_part *part = front->part_of(section);
  return part && strcmp(part->chooser, key) == 0;
}

bool ethd__config_in_files_only(const ethd__config_front *front, const char *section, const char *key) {
  return find_file_key(front, section, key) || chooses(front, section, key);
}

/* ---- any key ---- */

ethd_status ethd__config_read(ethd__config *whole, const ethd__key *key, ethd__pass pass) {
  ethd_config *c = &whole->config;
  const ethd__config_front *front = ethd__front_of(c);
  void *setup = c->is_space ? (void *)&c->space : &c->setup;
  const ethd__file_key *file_key = find_file_key(front, key->section, key->key);
  if (file_key) return file_key->pass == pass ? file_key->read(whole, key) : ETHD_OK;
  if (chooses(front, key->section, key->key))
    return pass == ETHD__PASS_CHOICES ? ethd__config_choose(c, key, front, setup) : ETHD_OK;
  if (pass != ETHD__PASS_REST) return ETHD_OK;
  int limit = ethd__config_limit(key->section, key->key);
  if (limit >= 0) c->limits_given |= 1u << limit;
  return ethd__config_number(key, front, setup);
}

/* ---- unknown keys and sections ---- */

/* "unknown section; arm, ... are allowed" */
static const char *unknown_section(unsigned front, char out[ETHD_MESSAGE_MAX]) {
  char list[ETHD_MESSAGE_MAX] = "";
  for (const ethd__section *s = ethd__sections; s->name; s++)
    if (s->fronts & front) ethd__list_add(list, s->name);
  snprintf(out, ETHD_MESSAGE_MAX, "unknown section; %.*s are allowed", ETHD_MESSAGE_MAX - 64, list);
  return out;
}

ethd_status ethd__config_section_known(const ethd_ini_section *section, const ethd_ini_section *space, const char *file,
                                       char message[ETHD_MESSAGE_MAX]) {
  const unsigned front = space ? ETHD__SPACE : ETHD__PLANE;
  char what[ETHD_MESSAGE_MAX];
  if (find_section(front, section->name)) return ETHD_OK;
  if (space && find_section(ETHD__PLANE, section->name))
    return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: [%s]: is a section of the plane, but [space] in line %d is there",
                     file, section->line, section->name, space->line);
  if (find_section(ETHD__SPACE, section->name))
    return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: [%s]: is a section of space, but there is no [space]", file,
                     section->line, section->name);
  return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: [%s]: %s", file, section->line, section->name,
                   unknown_section(front, what));
}

ethd_status ethd__config_unknown(const ethd__key *key, const ethd__config_front *front, const void *setup) {
  const ethd__section *section = find_section(front->bit, key->section);
  const ethd_setup_part *part = front->part_of(key->section);
  char list[ETHD_MESSAGE_MAX] = "";
  ethd_setup_key row;
  if (!section) return ethd__key_refuse(key, ETHD_E_UNKNOWN, "%s", unknown_section(front->bit, list));
  if (part) ethd__list_add(list, part->chooser);
  for (size_t i = 0; i < sizeof section->keys / sizeof *section->keys && section->keys[i].key; i++)
    ethd__list_add(list, section->keys[i].key);
  for (uint32_t i = 0; front->key_at(setup, i, &row) == ETHD_OK; i++)
    if (strcmp(row.section, key->section) == 0) ethd__list_add(list, row.param.name);
  if (!part) return ethd__key_refuse(key, ETHD_E_UNKNOWN, "unknown key; %s are allowed", list);
  return ethd__key_refuse(key, ETHD_E_UNKNOWN, "not a key of %s, which has %s", front->chosen(setup, part).id, list);
}
