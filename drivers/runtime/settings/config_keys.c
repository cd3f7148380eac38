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

/* Reads and sets the numbers that the key holds, one by one. */
static ethd_status read_values(const ethd_setup_key *row, const ethd__key *key, const ethd__config_front *front,
                               void *setup) {
  char name[96], word[256];
  const char *p = key->value;
  for (uint32_t i = 0; i < row->count; i++) {
    size_t n = row->count > 1 ? strcspn(p += strspn(p, " \t"), " \t") : strlen(p);
    ethd__key one = *key;
    double value;
    if (!n || n >= sizeof word) return ethd__key_found(key, ETHD_E_SYNTAX, row->param.brief);
    snprintf(word, sizeof word, "%.*s", (int)n, p);
    one.value = word;
    p += n;
    ethd_status status = ethd__key_value(&one, &row->param, &value);
    if (status) return status;
    snprintf(name, sizeof name, row->count > 1 ? "%s.%s[%u]" : "%s.%s", row->section, row->param.name, i);
    status = front->set(setup, name, value);
    if (status) return ethd__key_refuse(key, status, "%s", ethd_status_sentence(status));
  }
  return *p ? ethd__key_found(key, ETHD_E_SYNTAX, row->param.brief) : ETHD_OK;
}

ethd_status ethd__config_number(const ethd__key *key, const ethd__config_front *front, void *setup) {
  ethd_setup_key row;
  for (uint32_t i = 0; front->key_at(setup, i, &row) == ETHD_OK; i++)
    if (strcmp(row.section, key->section) == 0 && strcmp(row.param.name, key->key) == 0)
      return read_values(&row, key, front, setup);
  return ethd__config_unknown(key, front, setup);
}

/* ---- a number that a command sets ---- */

ethd_status ethd__config_set(const ethd_config *config, const ethd__config_front *front, const char *name,
                             const char *value, void *setup, char message[ETHD_MESSAGE_MAX]) {
  char section[64], quote[ETHD_QUOTE_MAX];
  ethd_error error;
  ethd__setup_copy changed;
  const char *dot = strchr(name, '.');
  if (!dot || (size_t)(dot - name) >= sizeof section)
    return ethd__say(message, ETHD_E_SYNTAX, "found %s, section.key is allowed",
                     ethd__quote(name, strlen(name), quote));
  memcpy(section, name, (size_t)(dot - name));
  section[dot - name] = 0;
  ethd__key key = {NULL, 0, section, dot + 1, value, message};
  if (ethd__config_in_files_only(front, section, key.key))
    return ethd__key_refuse(&key, ETHD_E_ARGUMENT, "can't be set here; only the file can contain it");
  memcpy(&changed, setup, front->bytes);
  ethd_status status = ethd__config_number(&key, front, &changed);
  if (status) return status;
  status = ethd__config_check(config, front, &changed, &error);
  if (status < 0) {
    ethd_error_text(NULL, &error, message);
    return status;
  }
  memcpy(setup, &changed, front->bytes);
  return ETHD_OK;
}

ethd_status ethd_config_set(const ethd_config *config, const char *name, const char *value, ethd_setup *setup,
                            char message[ETHD_MESSAGE_MAX]) {
  return ethd__config_set(config, &ethd__front_plane, name, value, setup, message);
}

ethd_status ethd_config_space_set(const ethd_config *config, const char *name, const char *value,
                                  ethd_space_setup *setup, char message[ETHD_MESSAGE_MAX]) {
  return ethd__config_set(config, &ethd__front_space, name, value, setup, message);
}
