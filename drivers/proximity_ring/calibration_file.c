#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "proximity_ring/calibration.h"
#include "text/error_text.h"
#include "text/key.h"
#include "text/text.h"

typedef struct calibration_source {
  const char *name;
  char *message;
  ethd__calibration *out;
  uint32_t listed; /* bits of the sensors that have a section */
} calibration_source;

/* ---- numbers ---- */

typedef struct sensor_key {
  ethd_param param;
  size_t offset;
  ethd__level from, to; /* bits of the levels at which a sensor may have such a key of its own */
} sensor_key;

#define AT(member) offsetof(ethd__sensor, member)

static const sensor_key rows[] = {
    {{"a", "counts m^p", 1e-9, 1e9, 0, "factor of the law"}, AT(a), ETHD__LEVEL_GAIN, ETHD__LEVEL_LAW},
    {{"p", "1", 0.5, 8, 0, "power of the law"}, AT(p), ETHD__LEVEL_LAW, ETHD__LEVEL_LAW},
    {{"d0", "m", 0, 0.05, 0, "added to a distance"}, AT(d0), ETHD__LEVEL_GAIN, ETHD__LEVEL_LAW},
    {{"dark", "1", 0, 65534, 0, "counts without a finger"}, AT(dark), ETHD__LEVEL_NONE, ETHD__LEVEL_TABLE},
    {{"residual", "m", 0, 0.1, 0, "rms"}, AT(residual), ETHD__LEVEL_NONE, ETHD__LEVEL_TABLE},
};

#define ROWS (sizeof rows / sizeof *rows)

static ethd_status unknown(const calibration_source *r, const ethd__key *k, const char *allowed) {
  return ethd__key_refuse(k, ETHD_E_UNKNOWN, "unknown key at level %s; %s are allowed",
                          ethd__level_names[r->out->level], allowed);
}

static ethd_status word(const ethd__key *k, char out[ETHD__SERIAL_MAX]) {
  if (strlen(k->value) >= ETHD__SERIAL_MAX) return ethd__key_found(k, ETHD_E_SYNTAX, "at most 47 characters");
  strcpy(out, k->value);
  return ETHD_OK;
}

static const sensor_key *find(const char *key) {
  for (size_t i = 0; i < ROWS; i++)
    if (!strcmp(rows[i].param.name, key)) return &rows[i];
  return NULL;
}

static double *field(ethd__sensor *s, const sensor_key *r) { return (double *)((char *)s + r->offset); }

/* ---- sections ---- */

static ethd_status read_level(const calibration_source *r, const ethd_ini_key *k) {
  static const ethd_param level = {"level", "none|common|gain|law|table", 0, ETHD__LEVEL_COUNT - 1, 0, "what is known"};
  const ethd__key key = ethd__key_of(r->name, k, r->message);
  double value = 0;
  ethd_status status = ethd__key_value(&key, &level, &value);
  r->out->level = (ethd__level)value;
  return status;
}

static ethd_status read_general(const calibration_source *r, const ethd__key *k) {
  if (!strcmp(k->key, "level")) return ETHD_OK; /* has been read */
  if (!strcmp(k->key, "date")) return word(k, r->out->date);
  if (!strcmp(k->key, "serial")) return word(k, r->out->serial);
  if (!strcmp(k->key, "residual")) return ethd__key_value(k, &find("residual")->param, &r->out->residual);
  return unknown(r, k, "level, date, serial, residual");
}

static ethd_status read_law(const calibration_source *r, const ethd__key *k) {
  const sensor_key *which = find(k->key);
  double value;
  if (!which || which->from == ETHD__LEVEL_NONE) return unknown(r, k, "a, p, d0");
  if (r->out->level == ETHD__LEVEL_NONE || r->out->level == ETHD__LEVEL_TABLE)
    return ethd__say(r->message, ETHD_E_ARGUMENT, "%s:%d: [law]: level %s has none", r->name, k->line,
                     ethd__level_names[r->out->level]);
  ethd_status status = ethd__key_value(k, &which->param, &value);
  for (int i = 0; i < ETHD_RAYS && !status; i++) *field(&r->out->sensors[i], which) = value;
  return status;
}

static ethd_status read_point(const calibration_source *r, const ethd__key *k, ethd__sensor *s) {
  static const char allowed[] = "COUNTS_ABOVE_DARK METRES, counts falling and metres rising from point to point,";
  char expected[16];
  size_t n = strcspn(k->value, " \t"), gap = strspn(k->value + n, " \t");
  const char *second = k->value + n + gap;
  double above, at;
  snprintf(expected, sizeof expected, "point%u", s->points);
  if (s->points == ETHD__POINTS_MAX || strcmp(k->key, expected))
    return unknown(r, k, "dark, residual, serial, point0 to point23 in order");
  if (!ethd__number(k->value, n, &above) || !gap || !ethd__number(second, strlen(second), &at))
    return ethd__key_found(k, ETHD_E_SYNTAX, allowed);
  bool falls = s->points == 0 || (above < s->above[s->points - 1] && at > s->at[s->points - 1]);
  if (!(above > 0 && above < 65536 && at >= 0 && at <= ETHD__DISTANCE_MAX && falls))
    return ethd__key_found(k, ETHD_E_RANGE, allowed);
  s->above[s->points] = above;
  s->at[s->points++] = at;
  return ETHD_OK;
}

static ethd_status read_sensor(const calibration_source *r, const ethd__key *k, int sensor) {
  static const char *const allowed[] = {"dark, residual, serial", "dark, residual, serial",
                                        "dark, residual, serial, a, d0", "dark, residual, serial, a, p, d0",
                                        "dark, residual, serial, point0 to point23"};
  ethd__sensor *s = &r->out->sensors[sensor];
  const sensor_key *which = find(k->key);
  if (!strcmp(k->key, "serial")) return word(k, s->serial);
  if (which && which->from <= r->out->level && which->to >= r->out->level)
    return ethd__key_value(k, &which->param, field(s, which));
  if (!which && r->out->level == ETHD__LEVEL_TABLE) return read_point(r, k, s);
  return unknown(r, k, allowed[r->out->level]);
}

/* "sensor 0" to "sensor 15", else -1. */
static int sensor_of(const char *section) {
  char expected[16];
  for (int i = 0; i < ETHD_RAYS; i++) {
    snprintf(expected, sizeof expected, "sensor %d", i);
    if (!strcmp(section, expected)) return i;
  }
  return -1;
}

static ethd_status read_key(const calibration_source *r, const ethd__key *k) {
  if (!strcmp(k->section, "calibration")) return read_general(r, k);
  if (!strcmp(k->section, "law")) return read_law(r, k);
  return ETHD_OK;
}

static ethd_status check_sections(calibration_source *r, const ethd_ini *ini) {
  char quote[ETHD_QUOTE_MAX];
  for (uint32_t i = 0; i < ini->section_count; i++) {
    const ethd_ini_section *s = &ini->sections[i];
    int sensor = sensor_of(s->name);
    if (sensor >= 0) r->listed |= 1u << sensor;
    if (sensor < 0 && strcmp(s->name, "calibration") && strcmp(s->name, "law"))
      return ethd__say(r->message, ETHD_E_UNKNOWN,
                       "%s:%d: [%s]: unknown section; calibration, law, sensor 0 to sensor 15 are allowed", r->name,
                       s->line, ethd__quote(s->name, strlen(s->name), quote));
  }
  return ETHD_OK;
}

/* A level's keys must be present. */
static ethd_status check_whole(const calibration_source *r) {
  for (int i = 0; i < ETHD_RAYS && r->out->level >= ETHD__LEVEL_GAIN; i++) {
    if (!(r->listed >> i & 1))
      return ethd__say(r->message, ETHD_E_ARGUMENT, "%s: [sensor %d] is missing; level %s needs all 16", r->name, i,
                       ethd__level_names[r->out->level]);
    if (r->out->level == ETHD__LEVEL_TABLE && r->out->sensors[i].points < 2)
      return ethd__say(r->message, ETHD_E_ARGUMENT, "%s: [sensor %d] has %u points, 2 to 24 are allowed", r->name, i,
                       r->out->sensors[i].points);
  }
  return ETHD_OK;
}

static ethd_status read_all(calibration_source *r, const ethd_ini *ini) {
  const ethd_ini_key *level = ethd_ini_find(ini, "calibration", "level");
  if (!level) return ethd__say(r->message, ETHD_E_ARGUMENT, "%s: calibration.level is missing", r->name);
  ethd_status status = read_level(r, level);
  if (!status) status = check_sections(r, ini);
  for (int pass = 0; pass < 2; pass++) /* sensors once the common law is known */
    for (uint32_t i = 0; i < ini->count && !status; i++) {
      const ethd__key key = ethd__key_of(r->name, &ini->keys[i], r->message);
      int sensor = sensor_of(key.section);
      if (pass == (sensor >= 0)) status = sensor >= 0 ? read_sensor(r, &key, sensor) : read_key(r, &key);
    }
  return status ? status : check_whole(r);
}

ethd_status ethd__calibration_parse(const char *text, size_t length, const char *name, ethd__calibration *out,
                                    char message[ETHD_MESSAGE_MAX]) {
  ethd__calibration got = ethd__calibration_default();
  calibration_source r = {name, message, &got, 0};
  ethd_ini ini = {0};
  ethd_status status = ethd_ini_parse(text, length, name, NULL, NULL, &ini, message);
  if (status) return status;
  status = read_all(&r, &ini);
  ethd_ini_free(&ini);
  if (!status) *out = got;
  return status;
}

ethd_status ethd__calibration_load(const char *path, ethd__calibration *out, char message[ETHD_MESSAGE_MAX]) {
  ETHD__FREED char *text = NULL;
  size_t length;
  ethd_status status = ethd_text_read(path, ETHD_INI_BYTES_MAX, &text, &length, message);
  return status ? status : ethd__calibration_parse(text, length, path, out, message);
}

/* ---- writing ---- */

static void put(FILE *f, const char *key, double value) {
  if (!isnan(value)) fprintf(f, "%s = %.17g\n", key, value);
}

static void put_word(FILE *f, const char *key, const char *value) {
  if (value[0]) fprintf(f, "%s = %s\n", key, value);
}

static void put_sensor(FILE *f, const ethd__calibration *c, int sensor) {
  ethd__sensor s = c->sensors[sensor];
  fprintf(f, "\n[sensor %d]\n", sensor);
  put_word(f, "serial", s.serial);
  for (size_t i = 0; i < ROWS; i++)
    if (rows[i].from <= c->level && rows[i].to >= c->level) put(f, rows[i].param.name, *field(&s, &rows[i]));
  for (uint32_t i = 0; i < s.points && c->level == ETHD__LEVEL_TABLE; i++)
    fprintf(f, "point%u = %.17g %.17g\n", i, s.above[i], s.at[i]);
}

ethd_status ethd__calibration_save(const ethd__calibration *c, const char *path, char message[ETHD_MESSAGE_MAX]) {
  ethd_replace to;
  ethd_status status = ethd_replace_begin(path, &to, message);
  if (status) return status;
  fprintf(to.file,
          "; counts - dark = a / (d + d0)^p; a in counts m^p, d0 and residual (rms) in m, dark in counts\n"
          "[calibration]\nlevel = %s\n",
          ethd__level_names[c->level]);
  put_word(to.file, "date", c->date);
  put_word(to.file, "serial", c->serial);
  put(to.file, "residual", c->residual);
  if (c->level != ETHD__LEVEL_NONE && c->level != ETHD__LEVEL_TABLE) {
    ethd__sensor common = c->sensors[0];
    fprintf(to.file, "\n[law]\n");
    for (size_t i = 0; i < ROWS; i++)
      if (rows[i].from != ETHD__LEVEL_NONE) put(to.file, rows[i].param.name, *field(&common, &rows[i]));
  }
  for (int k = 0; k < ETHD_RAYS; k++) put_sensor(to.file, c, k);
  return ethd_replace_commit(&to, message);
}
