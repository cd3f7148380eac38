#include "text/key.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "text/error_text.h"
#include "text/text.h"

/* ---- refusals ---- */

ethd_status ethd__key_refuse(const ethd__key *key, ethd_status status, const char *format, ...) {
  char what[ETHD_MESSAGE_MAX];
  va_list args;
  va_start(args, format);
  ethd__say_all(what, format, args);
  va_end(args);
  if (!key->file) return ethd__say(key->message, status, "%s.%s: %s", key->section, key->key, what);
  return ethd__say(key->message, status, "%s:%d: %s.%s: %s", key->file, key->line, key->section, key->key, what);
}

ethd_status ethd__key_found(const ethd__key *key, ethd_status status, const char *allowed) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__key_refuse(key, status, "found %s, %s is allowed", ethd__quote(key->value, strlen(key->value), quote),
                          allowed);
}

void ethd__list_add(char list[ETHD_MESSAGE_MAX], const char *word) {
  size_t n = strlen(list);
  snprintf(list + n, ETHD_MESSAGE_MAX - n, "%s%s", n ? ", " : "", word);
}

/* ---- one value ---- */

static bool is_whole(const ethd_param *row) { return !strcmp(row->unit, ETHD_WHOLE); }

static ethd_status refuse_range(const ethd__key *key, const ethd_param *row) {
  char allowed[ETHD_MESSAGE_MAX];
  const char *unit = is_whole(row) || !strcmp(row->unit, "1") ? "" : row->unit;
  ethd__say(allowed, ETHD_OK, "%s%.10g to %.10g%s%s", is_whole(row) ? "a whole number from " : "", row->min, row->max,
            *unit ? " " : "", unit);
  return ethd__key_found(key, ETHD_E_RANGE, allowed);
}

ethd_status ethd__key_value(const ethd__key *key, const ethd_param *row, double *out) {
  double value;
  if (ethd_param_words(row)) {
    int word = ethd_param_word(row, key->value);
    if (word < 0) return ethd__key_found(key, ETHD_E_UNKNOWN, row->unit);
    *out = word;
    return ETHD_OK;
  }
  bool (*read)(const char *, size_t, double *) = is_whole(row) ? ethd__whole : ethd__number;
  if (!read(key->value, strlen(key->value), &value) || !ethd__is_within(value, row->min, row->max))
    return refuse_range(key, row);
  *out = value;
  return ETHD_OK;
}

/* ---- tables ---- */

static bool is_row(const ethd__key_row *row, const char *section, const ethd_ini_key *key) {
  return !strcmp(row->param.name, key->key) && !strcmp(row->section ? row->section : section, key->section);
}

ethd_status ethd__keys_known(const ethd__key_file *file, const char *section, const ethd__key_row *rows, size_t count,
                             const char *text) {
  for (uint32_t i = 0; i < file->ini->count; i++) {
    const ethd_ini_key *k = &file->ini->keys[i];
    const ethd__key key = ethd__key_of(file->name, k, file->message);
    char list[ETHD_MESSAGE_MAX] = "";
    size_t row = 0;
    if ((section && strcmp(k->section, section)) || (text && !strcmp(k->key, text))) continue;
    while (row < count && !is_row(&rows[row], section, k)) row++;
    if (row < count) continue;
    if (text) ethd__list_add(list, text);
    for (row = 0; row < count; row++)
      if (!rows[row].section || !strcmp(rows[row].section, k->section)) ethd__list_add(list, rows[row].param.name);
    return ethd__key_refuse(&key, ETHD_E_UNKNOWN, *list ? "unknown key; %s are allowed" : "unknown section%s", list);
  }
  return ETHD_OK;
}

static void put(const ethd__key_row *row, double value, void *base) {
  char *at = (char *)base + row->offset;
  if (ethd_param_words(&row->param))
    memcpy(at, &(int32_t){(int32_t)value}, sizeof(int32_t));
  else if (is_whole(&row->param))
    memcpy(at, &(uint32_t){(uint32_t)value}, sizeof(uint32_t));
  else
    memcpy(at, &value, sizeof value);
}

static ethd_status missing(const ethd__key_file *file, const char *section, int line, const ethd_param *param) {
  char place[16] = "";
  if (line) snprintf(place, sizeof place, "%d:", line);
  return ethd__say(file->message, ETHD_E_UNKNOWN, "%s:%s %s.%s is missing: %s", file->name, place, section, param->name,
                   param->brief);
}

ethd_status ethd__keys_read(const ethd__key_file *file, const char *section, int line, const ethd__key_row *rows,
                            size_t count, void *base) {
  for (const ethd__key_row *row = rows; row < rows + count; row++) {
    const char *within = row->section ? row->section : section;
    const ethd_ini_key *own = ethd_ini_find(file->ini, within, row->param.name);
    double value = row->param.def;
    if (own) {
      const ethd__key key = ethd__key_of(file->name, own, file->message);
      ethd_status status = ethd__key_value(&key, &row->param, &value);
      if (status) return status;
    } else if (isnan(value)) {
      return missing(file, within, line, &row->param);
    }
    put(row, value, base);
  }
  return ETHD_OK;
}
