/* Opens a device from the names of its drivers and their settings. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "device/device.h"
#include "device/driver_file.h"
#include "device/settings.h"
#include "text/error_text.h"
#include "text/text.h"

#define BLANKS " \t"
#define INJECT "inject"       /* two keys belong to no driver: a script of faults, */
#define HANG_TIME "hang_time" /* and the time limit for code of a driver's file, s */
#define HANG_TIME_DEFAULT 30  /* s: a fieldbus needs about ten seconds to start */

static const char *file_of(const ethd_device_def *def) { return def->file ? def->file : "the defaults"; }

static bool is_common(const char *key) { return !strcmp(key, INJECT) || !strcmp(key, HANG_TIME); }

/* ---- names ---- */

/* The device that is being opened. */
typedef struct naming {
  ethd_device *device;
  const ethd_driver *const *from;
  const ethd_device_def *def;
  char *message;
} naming;

static ethd_status refuse_name(const naming *n, const char *name, size_t length) {
  char quote[ETHD_QUOTE_MAX], list[ETHD_MESSAGE_MAX] = "";
  for (size_t i = 0; n->from[i]; i++) ethd__list_add(list, n->from[i]->id);
  return ethd__say(n->message, ETHD_E_UNKNOWN, "%s: device.driver: found %s; %s and file:PATH are allowed",
                   file_of(n->def), ethd__quote(name, length, quote), list);
}

static const ethd_driver *find(const ethd_driver *const *from, const char *name, size_t length) {
  for (; *from; from++)
    if (strlen((*from)->id) == length && memcmp((*from)->id, name, length) == 0) return *from;
  return NULL;
}

/* Loads the driver of a name like "file:mine.so", of `length` bytes, into row i. */
static ethd_status load_driver(const naming *n, uint32_t i, const char *name, size_t length) {
  char what[ETHD_MESSAGE_MAX], quote[ETHD_QUOTE_MAX];
  ethd_device *s = n->device;
  ETHD__FREED char *given = strndup(name + strlen(ETHD_DRIVER_FILE), length - strlen(ETHD_DRIVER_FILE));
  ETHD__FREED char *path = given ? ethd__path_join(n->def->folder, given) : NULL;
  ethd_status status = path ? ethd__driver_load(path, &s->at[i].own, what) : ethd__no_memory(what, NULL);
  s->at[i].driver = &s->at[i].own;
  s->at[i].is_foreign = true;
  if (!status) return ETHD_OK;
  const char *slash = memrchr(name, '/', length), *last = slash ? slash + 1 : name;
  return ethd__say(n->message, status, "%s: device.driver: %s: %.*s", file_of(n->def),
                   ethd__quote(last, (size_t)(name + length - last), quote), ETHD_MESSAGE_MAX / 2, what);
}

static ethd_status check_driver(const naming *n, const ethd_driver *driver) {
  char what[ETHD_MESSAGE_MAX];
  ethd_status status = ethd__driver_check(driver, what);
  if (!status) return ETHD_OK;
  return ethd__say(n->message, status, "%s: device.driver: %.*s", file_of(n->def), ETHD_MESSAGE_MAX / 2, what);
}

/* Refuses a driver without functions for the device's front: it may use a setup that doesn't exist. */
static ethd_status check_front(const naming *n, const ethd_driver *driver) {
  const ethd_driver d = ethd__driver_whole(driver);
  const bool plane = d.read || d.write, space = d.read_space || d.write_space;
  n->device->takes |= !!d.write_space;
  if (n->device->in_space ? space : plane || !space) return ETHD_OK;
  return ethd__say(n->message, ETHD_E_ARGUMENT, "%s: device.driver: %s has no part in a device in %s", file_of(n->def),
                   d.id, n->device->in_space ? "space" : "the plane");
}

/* Adds the driver of a name, of `length` bytes, to the device. */
static ethd_status add_driver(const naming *n, const char *name, size_t length) {
  ethd_device *s = n->device;
  size_t mark = strlen(ETHD_DRIVER_FILE);
  bool is_file = length > mark && !strncmp(name, ETHD_DRIVER_FILE, mark);
  const ethd_driver *known = is_file ? NULL : find(n->from, name, length);
  if (!is_file && !known) return refuse_name(n, name, length);
  if (s->count == ETHD_DRIVERS_MAX)
    return ethd__say(n->message, ETHD_E_FULL, "%s: device.driver: at most %d drivers stand behind one device",
                     file_of(n->def), ETHD_DRIVERS_MAX);
  uint32_t i = s->count;
  s->at[i].driver = known;
  ethd_status status = is_file ? load_driver(n, i, name, length) : check_driver(n, known);
  if (!status) status = check_front(n, s->at[i].driver);
  for (uint32_t k = 0; !status && k < i; k++)
    if (!strcmp(s->at[k].driver->id, s->at[i].driver->id))
      status = ethd__say(n->message, ETHD_E_DUPLICATE, "%s: device.driver: %s occurs twice", file_of(n->def),
                         s->at[i].driver->id);
  if (!status) { /* a table may be shorter than ours */
    s->at[i].own = s->only_prepares ? ethd__driver_prepared(s->at[i].driver) : ethd__driver_whole(s->at[i].driver);
    s->at[i].driver = &s->at[i].own;
  }
  s->count += !status;
  return status;
}

/* Adds the drivers of "servo, ring, file:mine.so" to the device. */
static ethd_status name_drivers(const naming *n, const char *ids) {
  for (const char *id = ids;; id++) {
    id += strspn(id, BLANKS);
    size_t length = strcspn(id, ","), rest = length;
    while (length && strchr(BLANKS, id[length - 1])) length--;
    ethd_status status = add_driver(n, id, length);
    id += rest;
    if (status || !*id) return status;
  }
}

/* ---- settings ---- */

/* Returns the key without its prefix "id."; NULL when the key isn't this driver's. */
static const char *own_key(const char *key, const char *id) {
  size_t length = strlen(id);
  return strncmp(key, id, length) == 0 && key[length] == '.' ? key + length + 1 : NULL;
}

/* Every key must belong to a driver, so that none is ignored. */
static ethd_status check_owners(const ethd_device *s, const ethd_device_def *def, char *message) {
  for (uint32_t k = 0; s->count > 1 && k < def->setting_count; k++) {
    bool owned = is_common(def->settings[k].key);
    for (uint32_t i = 0; i < s->count; i++) owned |= own_key(def->settings[k].key, s->at[i].driver->id) != NULL;
    if (!owned)
      return ethd__say(message, ETHD_E_UNKNOWN,
                       "%s:%d: device.%s: with several drivers a key needs its driver's name, as in %s.%s",
                       def->file ? def->file : "", def->settings[k].line, def->settings[k].key, s->at[0].driver->id,
                       def->settings[k].key);
  }
  return ETHD_OK;
}

/* Returns the key in the form that driver i gets, NULL if it belongs to another driver. */
static const char *given_key(const ethd_device *s, uint32_t i, const char *key) {
  const char *own = own_key(key, s->at[i].driver->id);
  if (own) return own;
  return s->count > 1 || is_common(key) ? NULL : key;
}

static const ethd_setting *find_common(const ethd_device_def *def, const char *key) {
  for (uint32_t k = 0; k < def->setting_count; k++)
    if (!strcmp(def->settings[k].key, key)) return &def->settings[k];
  return NULL;
}

static uint32_t own_settings(const ethd_device *s, uint32_t i, const ethd_device_def *def, ethd_setting *out) {
  uint32_t n = 0;
  for (uint32_t k = 0; k < def->setting_count; k++) {
    const char *key = given_key(s, i, def->settings[k].key);
    if (!key) continue;
    out[n] = def->settings[k];
    out[n++].key = key;
  }
  return n;
}

/* Refuses a setting that occurs twice. A file can't have the same key twice, but a single driver's key may occur with
   and without its id. */
static ethd_status check_twice(const ethd_device_def *own, char *message) {
  for (uint32_t k = 0; k < own->setting_count; k++)
    for (uint32_t first = 0; first < k; first++)
      if (!strcmp(own->settings[first].key, own->settings[k].key))
        return ethd__say(message, ETHD_E_DUPLICATE, "%s:%d: device.%s: occurs twice, first on line %d", file_of(own),
                         own->settings[k].line, own->settings[k].key, own->settings[first].line);
  return ETHD_OK;
}

/* ---- opening ---- */

/* Checks the units and limits of an open driver. */
static ethd_status check_open(ethd_device *s, uint32_t i, char *message) {
  const ethd_driver *driver = s->at[i].driver;
  ethd_error error;
  s->at[i].units = driver->units ? driver->units(s->at[i].state) : 0;
  if (s->at[i].units > ETHD_UNITS_MAX || ethd_device_units(s) > ETHD_UNITS_MAX)
    return ethd__say(message, ETHD_E_FULL, "device: the drivers ask for more than %d I/O threads", ETHD_UNITS_MAX);
  if (!driver->limits) return ETHD_OK;
  ethd_limits limits = driver->limits(s->at[i].state);
  ethd_status status = ethd_limits_check(&limits, &error);
  return status ? ethd__say(message, status, "device %s: limits: %s: %s", driver->id, error.name,
                            ethd_status_sentence(status))
                : ETHD_OK;
}

/* Makes one printable line of a message from a file's code. */
static void one_line(char message[ETHD_MESSAGE_MAX]) {
  message[ETHD_MESSAGE_MAX - 1] = 0;
  for (char *p = message; *p; p++)
    if ((unsigned char)*p < ' ' || *p == 0x7f) *p = '?';
}

/* Opens driver i with its own settings. */
static ethd_status open_with(ethd_device *s, uint32_t i, const ethd_device_def *own, char *message) {
  const ethd_driver *driver = s->at[i].driver;
  message[0] = 0;
  ethd__device_foreign(s, i, s->only_prepares ? "prepare" : "open");
  ethd_status status = driver->open(own, &s->at[i].state, message);
  one_line(message);
  if (status && !message[0])
    ethd__say(message, status, "device %s: open: %s", driver->id, ethd_status_sentence(status));
  if (!status) status = check_open(s, i, message);
  ethd__device_foreign(s, i, NULL);
  return status;
}

static ethd_status open_one(ethd_device *s, uint32_t i, const ethd_device_def *def, char *message) {
  ETHD__FREED ethd_setting *settings = calloc(def->setting_count + 1, sizeof *settings);
  if (!settings) return ethd__no_memory(message, NULL);
  ethd_device_def own = *def;
  own.settings = settings;
  own.setting_count = own_settings(s, i, def, settings);
  ethd_status status = check_twice(&own, message);
  return status ? status : open_with(s, i, &own, message);
}

static ethd_status read_hang_time(ethd_device *s, const ethd_device_def *def, char *message) {
  static const ethd_param row = {HANG_TIME, "s", 1, 3600, HANG_TIME_DEFAULT, "for a driver that doesn't return"};
  double value = row.def;
  const ethd_setting *own = find_common(def, HANG_TIME);
  const ethd__key key = own ? ethd__setting_key(def, own, message) : (ethd__key){0};
  ethd_status status = own ? ethd__key_value(&key, &row, &value) : ETHD_OK;
  s->hang_time = (unsigned)value;
  return status;
}

/* Asks driver i, prepared and not opened, which joints it will measure. */
static ethd_status add_joints(const naming *n, uint32_t i, uint32_t *measured) {
  ethd_device *s = n->device;
  const ethd_driver own = s->at[i].own;
  s->at[i].own = ethd__driver_prepared(&own);
  ethd_status status = open_one(s, i, n->def, n->message);
  if (!status) *measured |= own.joints(s->at[i].state);
  if (s->at[i].state) own.close(s->at[i].state);
  s->at[i].state = NULL;
  s->at[i].own = own;
  return status;
}

/* A step needs the angles of both joints; a driver that doesn't name its joints may have both. No device has been
   touched yet. */
static ethd_status check_joints(const naming *n, const char *ids) {
  char quote[ETHD_QUOTE_MAX];
  uint32_t measured = 0;
  for (uint32_t i = 0; i < n->device->count; i++)
    if (!n->device->at[i].own.joints || !n->device->at[i].own.prepare) return ETHD_OK;
  for (uint32_t i = 0; i < n->device->count; i++) {
    ethd_status status = add_joints(n, i, &measured);
    if (status) return status;
  }
  if (measured != 1 && measured != 2) return ETHD_OK;
  return ethd__say(n->message, ETHD_E_ARGUMENT,
                   "%s: device.driver: %s measures joint %u alone; both joints are needed: in one map, whose registers "
                   "may be in several units (bus_unit), or from a second driver",
                   file_of(n->def), ethd__quote(ids, strlen(ids), quote), measured);
}

static ethd_status check_takes(const naming *n, const char *ids) {
  char quote[ETHD_QUOTE_MAX];
  if (!n->device->in_space || n->device->takes) return ETHD_OK;
  return ethd__say(n->message, ETHD_E_ARGUMENT, "%s: device.driver: %s: none takes commands in space", file_of(n->def),
                   ethd__quote(ids, strlen(ids), quote));
}

static ethd_status open_all(const naming *n, const char *ids) {
  ethd_device *s = n->device;
  ethd_status status = name_drivers(n, ids);
  if (!status) status = check_takes(n, ids);
  if (!status) status = check_owners(s, n->def, n->message);
  if (!status) status = read_hang_time(s, n->def, n->message);
  if (!status && !s->in_space) status = check_joints(n, ids);
  for (uint32_t i = 0; !status && i < s->count; i++) status = open_one(s, i, n->def, n->message);
  return status;
}

/* ---- faults to inject ---- */

/* Loads the script, which happens before anything is opened. */
static ethd_status load_script(const naming *n, const char *file) {
  ethd__script script = {.count = 0};
  ETHD__FREED char *path = ethd__path_join(n->def->folder, file);
  if (!path) return ethd__no_memory(n->message, NULL);
  const bool in_space = n->device->in_space;
  const double period = in_space ? n->def->space->period : n->def->setup->period;
  ethd_status status = ethd__script_load(path, (ethd__script_of){period, in_space}, &script, n->message);
  if (status) return status;
  n->device->inject = ethd__inject_create(&script, in_space);
  if (n->device->inject) return ETHD_OK;
  ethd__script_free(&script);
  return ethd__no_memory(n->message, NULL);
}

/* Opens the drivers, with a script of faults if there is one. */
static ethd_status open_device(const naming *n, const char *ids, ethd_device **out) {
  *out = NULL;
  if (!n->device) return ethd__no_memory(n->message, NULL);
  n->device->process = getpid();
  n->device->in_space = n->def->space != NULL;
  const ethd_setting *script = find_common(n->def, INJECT);
  ethd_status status = script ? load_script(n, script->value) : ETHD_OK;
  if (!status) status = open_all(n, ids);
  if (status)
    ethd_device_close(n->device);
  else
    *out = n->device;
  return status;
}

ethd_status ethd_device_open(const char *ids, const ethd_driver *const *from, const ethd_device_def *def,
                             ethd_device **out, char message[ETHD_MESSAGE_MAX]) {
  const naming n = {calloc(1, sizeof(ethd_device)), from ? from : ethd_drivers, def, message};
  return open_device(&n, ids, out);
}

ethd_status ethd_device_prepare(const char *ids, const ethd_device_def *def, ethd_device **out,
                                char message[ETHD_MESSAGE_MAX]) {
  const naming n = {calloc(1, sizeof(ethd_device)), ethd_drivers, def, message};
  if (n.device) n.device->only_prepares = true;
  return open_device(&n, ids, out);
}
