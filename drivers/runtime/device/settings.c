/* Reads a driver's keys in [device] by its own table. */
#include <stdio.h>
#include <string.h>

#include "device/settings.h"
#include "text/error_text.h"
#include "text/text.h"

static ethd_status refuse(const ethd_device_def *def, const ethd_setting *s, ethd_status status, const char *allowed,
                          char *message) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(message, status, "%s:%d: device.%s: found %s, %s is allowed", def->file ? def->file : "the defaults",
                   s->line, s->key, ethd__quote(s->value, strlen(s->value), quote), allowed);
}

ethd_status ethd__setting_refuse(const ethd_device_def *def, const char *key, const char *allowed,
                                 char message[ETHD_MESSAGE_MAX]) {
  const ethd_setting *s = NULL;
  for (uint32_t k = 0; k < def->setting_count; k++)
    if (!strcmp(def->settings[k].key, key)) s = &def->settings[k];
  if (s) return refuse(def, s, ETHD_E_RANGE, allowed, message);
  return ethd__say(message, ETHD_E_RANGE, "device.%s: %s is allowed", key, allowed);
}

static void add_name(char *list, size_t room, const char *name) {
  size_t n = strlen(list);
  snprintf(list + n, room - n, "%s%s", n ? ", " : "", name);
}

static ethd_status refuse_key(const ethd_driver *d, const ethd_device_def *def, const ethd_setting *s, char *message) {
  char list[ETHD_MESSAGE_MAX] = "";
  for (const char *const *key = d->keys; key && *key; key++) add_name(list, sizeof list, *key);
  for (uint32_t i = 0; i < d->param_count; i++) add_name(list, sizeof list, d->params[i].name);
  return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: device.%s: %s %s%s", def->file ? def->file : "the defaults",
                   s->line, s->key, d->id, list[0] ? "knows " : "has no settings", list);
}

static ethd_status set_value(const ethd_device_def *def, const ethd_setting *s, const ethd_param *row, double *out,
                             char *message) {
  char allowed[80];
  double value;
  if (ethd_param_words(row)) {
    int word = ethd_param_word(row, s->value);
    if (word < 0) return refuse(def, s, ETHD_E_UNKNOWN, row->unit, message);
    *out = word;
    return ETHD_OK;
  }
  snprintf(allowed, sizeof allowed, "%.10g to %.10g%s%s", row->min, row->max, strcmp(row->unit, "1") ? " " : "",
           strcmp(row->unit, "1") ? row->unit : "");
  if (!ethd__number(s->value, strlen(s->value), &value) || !ethd__is_within(value, row->min, row->max))
    return refuse(def, s, ETHD_E_RANGE, allowed, message);
  *out = value;
  return ETHD_OK;
}

static int find_key(const ethd_driver *d, const char *name) {
  for (int i = 0; d->keys && d->keys[i]; i++)
    if (!strcmp(d->keys[i], name)) return i;
  return -1;
}

ethd_status ethd_settings_read(const ethd_driver *driver, const ethd_device_def *def, double *values,
                               const ethd_setting **texts, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (uint32_t k = 0; !status && k < def->setting_count; k++) {
    const ethd_setting *s = &def->settings[k];
    int key = find_key(driver, s->key), row = ethd_params_find(driver->params, driver->param_count, s->key);
    if (key >= 0)
      texts[key] = s;
    else if (row >= 0)
      status = set_value(def, s, &driver->params[row], &values[row], message);
    else
      status = refuse_key(driver, def, s, message);
  }
  return status;
}
