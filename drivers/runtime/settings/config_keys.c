#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- numbers ---- */

int ethd__config_limit(const char *section, const char *key) {
  for (int i = 0; strcmp(section, "limits") == 0 && i < ETHD_LIMITS; i++)
    if (strcmp(ethd_limit_rows[i].name, key) == 0) return i;
  return -1;
}

/* Reads one number, or as many as the key holds, or the index of a word. */
static ethd_status read_values(const ethd_setup_key *row, const ethd__key *key, double values[ETHD_RAYS]) {
  const char *allowed = row->count == 1 ? "a decimal number" : row->param.brief, *p = key->value;
  if (ethd_param_words(&row->param)) {
    values[0] = ethd_param_word(&row->param, key->value);
    return values[0] < 0 ? ethd__key_found(key, ETHD_E_UNKNOWN, row->param.unit) : ETHD_OK;
  }
  for (uint32_t i = 0; i < row->count; i++) {
    size_t n = strcspn(p += strspn(p, " \t"), " \t");
    if (!ethd__number(p, n, &values[i]) || isnan(values[i])) return ethd__key_found(key, ETHD_E_SYNTAX, allowed);
    p += n;
  }
  return p[strspn(p, " \t")] ? ethd__key_found(key, ETHD_E_SYNTAX, allowed) : ETHD_OK;
}

static ethd_status set_values(const ethd_setup_key *row, const ethd__key *key, const double *values,
                              ethd_setup *setup) {
  char name[96];
  for (uint32_t i = 0; i < row->count; i++) {
    const ethd_param *p = &row->param;
    snprintf(name, sizeof name, row->count > 1 ? "%s.%s[%u]" : "%s.%s", row->section, p->name, i);
    ethd_status status = ethd_setup_set(setup, name, values[i], NULL);
    if (status)
      return ethd__key_refuse(key, status, "found %.10g, %.10g to %.10g %s is allowed", values[i], p->min, p->max,
                              p->unit);
  }
  return ETHD_OK;
}

ethd_status ethd__config_number(const ethd__key *key, ethd_setup *setup) {
  ethd_setup_key row;
  double values[ETHD_RAYS];
  for (uint32_t i = 0; ethd_setup_key_at(setup, i, &row) == ETHD_OK; i++) {
    if (strcmp(row.section, key->section) != 0 || strcmp(row.param.name, key->key) != 0) continue;
    ethd_status status = read_values(&row, key, values);
    return status ? status : set_values(&row, key, values, setup);
  }
  return ethd__config_unknown(key, setup);
}

/* ---- a number that a command sets ---- */

ethd_status ethd_config_set(const ethd_config *config, const char *name, const char *value, ethd_setup *setup,
                            char message[ETHD_MESSAGE_MAX]) {
  char section[64], quote[ETHD_QUOTE_MAX];
  ethd_error error;
  const char *dot = strchr(name, '.');
  if (!dot || (size_t)(dot - name) >= sizeof section)
    return ethd__say(message, ETHD_E_SYNTAX, "found %s, section.key is allowed",
                     ethd__quote(name, strlen(name), quote));
  memcpy(section, name, (size_t)(dot - name));
  section[dot - name] = 0;
  ethd__key key = {NULL, 0, section, dot + 1, value, message};
  if (ethd__config_in_files_only(section, key.key))
    return ethd__key_refuse(&key, ETHD_E_ARGUMENT, "can't be set, only the file can say it");
  ethd_setup changed = *setup;
  ethd_status status = ethd__config_number(&key, &changed);
  if (status) return status;
  status = ethd__config_check(config, &changed, &error);
  if (status < 0) {
    ethd_error_text(NULL, &error, message);
    return status;
  }
  *setup = changed;
  return ETHD_OK;
}
