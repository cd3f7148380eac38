/* Reads a driver's keys in [device] by its own table. */
#include <stdio.h>
#include <string.h>

#include "device/settings.h"
#include "text/error_text.h"

ethd__key ethd__setting_key(const ethd_device_def *def, const ethd_setting *s, char message[ETHD_MESSAGE_MAX]) {
  return (ethd__key){def->file ? def->file : "the defaults", s->line, "device", s->key, s->value, message};
}

static ethd_status refuse_key(const ethd_driver *d, const ethd__key *key) {
  char list[ETHD_MESSAGE_MAX] = "";
  for (const char *const *other = d->keys; other && *other; other++) ethd__list_add(list, *other);
  for (uint32_t i = 0; i < d->param_count; i++) ethd__list_add(list, d->params[i].name);
  return ethd__key_refuse(key, ETHD_E_UNKNOWN, "%s %s%s", d->id, list[0] ? "knows " : "has no settings", list);
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
    const ethd__key found = ethd__setting_key(def, s, message);
    int key = find_key(driver, s->key), row = ethd_params_find(driver->params, driver->param_count, s->key);
    if (key >= 0)
      texts[key] = s;
    else if (row >= 0)
      status = ethd__key_value(&found, &driver->params[row], &values[row]);
    else
      status = refuse_key(driver, &found);
  }
  return status;
}
