/* From names and settings to an open device. */
#include <stdlib.h>
#include <string.h>

#include "device/stack.h"
#include "inject/inject.h"
#include "text/error_text.h"
#include "text/text.h"

#define BLANKS " \t"
#define INJECT "inject" /* the key that is no driver's */

/* ---- names ---- */

static ethd_status refuse_name(const ethd_device_def *def, const ethd_driver *const *from, const char *name,
                               size_t length, char *message) {
  char quote[ETHD_QUOTE_MAX], list[ETHD_MESSAGE_MAX / 2] = "";
  for (size_t i = 0; from[i]; i++) {
    if (i) strncat(list, ", ", sizeof list - strlen(list) - 1);
    strncat(list, from[i]->id, sizeof list - strlen(list) - 1);
  }
  return ethd__say(message, ETHD_E_UNKNOWN, "%s: device.driver: found %s; %s %s allowed",
                   def->file ? def->file : "the defaults", ethd__quote(name, length, quote), list,
                   from[1] ? "are" : "is");
}

static const ethd_driver *find(const ethd_driver *const *from, const char *name, size_t length) {
  for (; *from; from++)
    if (strlen((*from)->id) == length && memcmp((*from)->id, name, length) == 0) return *from;
  return NULL;
}

/* "servo, ring" into the stack's rows. */
static ethd_status name_drivers(ethd__stack *s, const char *ids, const ethd_driver *const *from,
                                const ethd_device_def *def, char *message) {
  for (const char *id = ids;; id++) {
    id += strspn(id, BLANKS);
    size_t length = strcspn(id, BLANKS ",");
    const ethd_driver *driver = find(from, id, length);
    if (!driver) return refuse_name(def, from, id, length, message);
    for (uint32_t i = 0; i < s->count; i++)
      if (s->at[i].driver == driver)
        return ethd__say(message, ETHD_E_DUPLICATE, "%s: device.driver: %s stands twice",
                         def->file ? def->file : "the defaults", driver->id);
    if (s->count == ETHD_DRIVERS_MAX)
      return ethd__say(message, ETHD_E_FULL, "%s: device.driver: at most %d drivers stand behind one device",
                       def->file ? def->file : "the defaults", ETHD_DRIVERS_MAX);
    s->at[s->count++].driver = driver;
    id += length;
    id += strspn(id, BLANKS);
    if (!*id) return ETHD_OK;
    if (*id != ',') return refuse_name(def, from, ids, strlen(ids), message);
  }
}

/* ---- settings ---- */

/* The key without its prefix "id."; NULL when the key isn't this driver's. */
static const char *own_key(const char *key, const char *id) {
  size_t length = strlen(id);
  return strncmp(key, id, length) == 0 && key[length] == '.' ? key + length + 1 : NULL;
}

/* Every key has an owner, so that each driver is given all of its own and nothing is left over. */
static ethd_status check_owners(const ethd__stack *s, const ethd_device_def *def, char *message) {
  for (uint32_t k = 0; s->count > 1 && k < def->setting_count; k++) {
    int owned = !strcmp(def->settings[k].key, INJECT);
    for (uint32_t i = 0; i < s->count; i++) owned |= own_key(def->settings[k].key, s->at[i].driver->id) != NULL;
    if (!owned)
      return ethd__say(message, ETHD_E_UNKNOWN,
                       "%s:%d: device.%s: with several drivers a key names its own, as in %s.%s",
                       def->file ? def->file : "", def->settings[k].line, def->settings[k].key, s->at[0].driver->id,
                       def->settings[k].key);
  }
  return ETHD_OK;
}

static uint32_t own_settings(const ethd__stack *s, uint32_t i, const ethd_device_def *def, ethd_setting *out) {
  uint32_t n = 0;
  for (uint32_t k = 0; k < def->setting_count; k++) {
    const char *key = own_key(def->settings[k].key, s->at[i].driver->id);
    if ((!key && s->count > 1) || !strcmp(def->settings[k].key, INJECT)) continue;
    out[n] = def->settings[k];
    if (key) out[n].key = key;
    n++;
  }
  return n;
}

/* ---- opening ---- */

static ethd_status open_one(ethd__stack *s, uint32_t i, const ethd_device_def *def, char *message) {
  const ethd_driver *driver = s->at[i].driver;
  if (driver->write && !driver->safe)
    return ethd__say(message, ETHD_E_ARGUMENT, "device.driver: %s takes torque and has no safe to let go", driver->id);
  ethd_setting *settings = calloc(def->setting_count + 1, sizeof *settings);
  if (!settings) return ethd__no_memory(message, NULL);
  ethd_device_def own = *def;
  own.settings = settings;
  own.setting_count = own_settings(s, i, def, settings);
  message[0] = 0;
  ethd_status status = driver->open(&own, &s->at[i].device, message);
  free(settings);
  if (status && !message[0])
    ethd__say(message, status, "device %s: open: %s", driver->id, ethd_status_sentence(status));
  return status;
}

static ethd_status open_all(ethd__stack *s, const char *ids, const ethd_driver *const *from, const ethd_device_def *def,
                            char *message) {
  ethd_status status = name_drivers(s, ids, from, def, message);
  if (!status) status = check_owners(s, def, message);
  for (uint32_t i = 0; !status && i < s->count; i++) status = open_one(s, i, def, message);
  if (!status && ethd__driver_stack.units(s) > ETHD_UNITS_MAX)
    status = ethd__say(message, ETHD_E_FULL, "device: the drivers ask for more than %d I/O threads", ETHD_UNITS_MAX);
  return status;
}

/* ---- what is to go wrong ---- */

/* Puts the injecting driver around an open device; closes it when that fails. */
static ethd_status inject(const ethd_device_def *def, const char *file, const ethd_driver **driver, void **device,
                          char *message) {
  ethd__script script = {.count = 0};
  char *path = ethd__path_join(def->folder, file);
  ethd_status status =
      path ? ethd__script_load(path, def->setup->period, &script, message) : ethd__no_memory(message, NULL);
  free(path);
  void *inner = *device;
  *device = NULL;
  if (status) {
    (*driver)->close(inner);
  } else {
    status = ethd__inject_around(*driver, inner, &script, device);
    if (status) ethd__say(message, status, "%s", ethd_status_sentence(status));
  }
  *driver = status ? NULL : &ethd__driver_inject;
  return status;
}

static const char *script_of(const ethd_device_def *def) {
  for (uint32_t k = 0; k < def->setting_count; k++)
    if (!strcmp(def->settings[k].key, INJECT)) return def->settings[k].value;
  return NULL;
}

ethd_status ethd_device_open(const char *ids, const ethd_driver *const *from, const ethd_device_def *def,
                             const ethd_driver **driver, void **device, char message[ETHD_MESSAGE_MAX]) {
  *driver = NULL;
  *device = NULL;
  ethd__stack *s = calloc(1, sizeof *s);
  if (!s) return ethd__no_memory(message, NULL);
  ethd_status status = open_all(s, ids, from ? from : ethd_drivers, def, message);
  if (status) {
    ethd__driver_stack.close(s);
    return status;
  }
  *driver = &ethd__driver_stack;
  *device = s;
  const char *script = script_of(def);
  return script ? inject(def, script, driver, device, message) : ETHD_OK;
}
