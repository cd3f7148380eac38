#include "servo/map.h"

#include <stdio.h>
#include <string.h>

#include "servo/map_parts.h"
#include "text/error_text.h"
#include "text/text.h"

static const char register_prefix[] = "register ";
const char *const ethd__servo_sequences[ETHD__SERVO_SEQUENCES] = {"identify", "enable", "disable", "clear"};

static bool is_register(const char *section) { return !strncmp(section, register_prefix, sizeof register_prefix - 1); }

static bool is_known(const char *section) {
  for (size_t i = 0; i < ETHD__SERVO_SEQUENCES; i++)
    if (!strcmp(section, ethd__servo_sequences[i])) return true;
  return is_register(section) || !strcmp(section, "bus") || !strcmp(section, "watchdog");
}

static int section_line(const ethd_ini *ini, const char *name) {
  for (uint32_t i = 0; i < ini->section_count; i++)
    if (!strcmp(ini->sections[i].name, name)) return ini->sections[i].line;
  return 0;
}

static ethd_status check_sections(const ethd__key_file *s) {
  char quote[ETHD_QUOTE_MAX];
  for (uint32_t i = 0; i < s->ini->section_count; i++) {
    const ethd_ini_section *section = &s->ini->sections[i];
    if (!is_known(section->name))
      return ethd__say(s->message, ETHD_E_UNKNOWN,
                       "%s:%d: found [%s], bus, watchdog, register NAME, identify, enable, disable, clear are allowed",
                       s->name, section->line, section->name);
    int first = section_line(s->ini, section->name);
    if (first != section->line)
      return ethd__say(s->message, ETHD_E_DUPLICATE, "%s:%d: section %s occurs twice, first on line %d", s->name,
                       section->line, ethd__quote(section->name, strlen(section->name), quote), first);
  }
  return ETHD_OK;
}

/* ---- registers ---- */

static ethd_status name_register(const ethd__key_file *s, const ethd_ini_section *section, ethd__servo_register *out) {
  const char *name = section->name + sizeof register_prefix - 1;
  size_t length = strlen(name);
  char quote[ETHD_QUOTE_MAX];
  if (!length || length >= sizeof out->name || strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_") != length)
    return ethd__say(s->message, ETHD_E_SYNTAX, "%s:%d: found %s, a register's name has 1 to %zu of a-z, 0-9 and _",
                     s->name, section->line, ethd__quote(name, length, quote), sizeof out->name - 1);
  memcpy(out->name, name, length + 1);
  out->line = section->line;
  out->role = out->echo = -1;
  for (int32_t i = 0; i < ETHD__SERVO_ROLES; i++)
    if (!strcmp(name, ethd__servo_roles[i].name)) out->role = i;
  return ETHD_OK;
}

static ethd_status read_registers(const ethd__key_file *s, ethd__servo_map *map) {
  for (uint32_t i = 0; i < s->ini->section_count; i++) {
    const ethd_ini_section *section = &s->ini->sections[i];
    if (!is_register(section->name)) continue;
    if (map->count == ETHD__SERVO_REGISTERS_MAX)
      return ethd__say(s->message, ETHD_E_FULL, "%s:%d: over %u registers", s->name, section->line,
                       ETHD__SERVO_REGISTERS_MAX);
    ethd__servo_register *r = &map->registers[map->count];
    ethd_status status = name_register(s, section, r);
    if (!status) status = ethd__servo_read_register(s, section, map, r);
    if (status) return status;
    if (r->role >= 0) map->roles[r->role] = (int32_t)map->count;
    map->count++;
  }
  return ETHD_OK;
}

/* ---- sources ---- */

/* True when the remark behind a line's value has the word "unconfirmed". */
static bool says_unconfirmed(const char *text, size_t length, int line) {
  const char *end = text + length, *next;
  for (; line > 1 && text < end; line--) {
    next = memchr(text, '\n', (size_t)(end - text));
    text = next ? next + 1 : end;
  }
  next = memchr(text, '\n', (size_t)(end - text));
  size_t n = (size_t)((next ? next : end) - text);
  const char *remark = memchr(text, ';', n);
  const char word[] = "unconfirmed";
  return remark && memmem(remark, (size_t)(text + n - remark), word, sizeof word - 1);
}

static void mark_unconfirmed(const ethd__key_file *s, const char *text, size_t length, ethd__servo_map *map) {
  char section[ETHD__SERVO_NAME_MAX + 16];
  for (uint32_t i = 0; i < map->count; i++) {
    snprintf(section, sizeof section, "%s%s", register_prefix, map->registers[i].name);
    const ethd_ini_key *address = ethd_ini_find(s->ini, section, "address");
    map->registers[i].unconfirmed = address && says_unconfirmed(text, length, address->line);
  }
}

/* ---- the whole ---- */

static ethd_status fill(const ethd__key_file *s, ethd__servo_map *map) {
  memset(map, 0, sizeof *map);
  for (int i = 0; i < ETHD__SERVO_ROLES; i++) map->roles[i] = -1;
  ethd_status status = check_sections(s);
  if (!status && !section_line(s->ini, "bus"))
    status = ethd__say(s->message, ETHD_E_UNKNOWN, "%s: section [bus] is missing", s->name);
  if (!status) status = ethd__servo_read_bus(s, section_line(s->ini, "bus"), map);
  if (!status) status = ethd__servo_read_watchdog(s, section_line(s->ini, "watchdog"), map);
  if (!status) status = read_registers(s, map);
  for (int i = 0; i < ETHD__SERVO_SEQUENCES && !status; i++)
    status = ethd__servo_read_steps(s, ethd__servo_sequences[i], map, &map->sequences[i]);
  return status ? status : ethd__servo_map_check(s, map);
}

ethd_status ethd__servo_map_parse(const char *text, size_t length, const char *name, ethd__servo_map *out,
                                  char message[ETHD_MESSAGE_MAX]) {
  ethd_ini ini;
  ethd_status status = ethd_ini_parse(text, length, name, NULL, NULL, &ini, message);
  if (status) return status;
  const ethd__key_file source = {&ini, name, message};
  status = fill(&source, out);
  if (!status) mark_unconfirmed(&source, text, length, out);
  ethd_ini_free(&ini);
  return status;
}

ethd_status ethd__servo_map_load(const char *path, const char *name, ethd__servo_map *out,
                                 char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *text = NULL;
  size_t length;
  ethd_status status = ethd_text_read(path, ETHD__SERVO_BYTES_MAX, &text, &length, message);
  return status ? status : ethd__servo_map_parse(text, length, name, out, message);
}
