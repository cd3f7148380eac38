#include "device/driver_file.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <string.h>

#include "settings/config_parts.h"
#include "settings/plugin_fault.h"
#include "text/error_text.h"
#include "text/text.h"

#define WORD_MAX 31
#define KEYS_MAX 64

/* ---- tables ---- */

static bool is_word(const char *text) {
  return ethd__text_is_word(text, WORD_MAX, "abcdefghijklmnopqrstuvwxyz0123456789_-");
}

static bool keys_are_words(const char *const *keys) {
  for (int i = 0; keys && keys[i]; i++)
    if (i == KEYS_MAX || !is_word(keys[i])) return false;
  return true;
}

/* Returns a fault of the table's functions; NULL: none. */
static const char *functions_fault(const ethd_driver *d) {
  if (!d->open || !d->close) return d->open ? "has no close" : "has no open";
  if (d->write && !d->safe) return "takes torque and has no safe to remove it";
  if (d->write_space && !d->safe) return "takes commands in space and has no safe to end them";
  if ((unsigned)d->safe_is > ETHD_SAFE_BRAKES) return "has a safe_is that isn't one of ethd_safe_state";
  if (!d->units != !d->service) return d->units ? "has units of I/O and no service" : "has a service and no units";
  return NULL;
}

#define VERSION_AT 28

/* The position of each struct's size in ETHD_DRIVER_ABI. */
static const struct {
  const char *name;
  uint32_t at, mask, size;
} sizes[] = {{"ethd_sense", 21, 127, sizeof(ethd_sense)},  {"ethd_space_sense", 15, 63, sizeof(ethd_space_sense)},
             {"ethd_limits", 9, 63, sizeof(ethd_limits)},  {"ethd_space_command", 6, 7, sizeof(ethd_space_command)},
             {"ethd_command", 3, 7, sizeof(ethd_command)}, {"ethd_dynamics", 0, 7, sizeof(ethd_dynamics)}};

#define FITS(type, bits)                                                                                     \
  _Static_assert(sizeof(type) < 8u << (bits) && sizeof(type) % 8 == 0, "ETHD_DRIVER_ABI has " #bits " bits " \
                                                                       "for " #type)
FITS(ethd_sense, 7);
FITS(ethd_space_sense, 6);
FITS(ethd_limits, 6);
FITS(ethd_space_command, 3);
FITS(ethd_command, 3);
FITS(ethd_dynamics, 3);

/* Versions 1 and 2 had no bits of their own: 2 was 20000 and the sum of the sizes. */
static uint32_t version_of(uint32_t abi) {
  if (abi >> VERSION_AT) return abi >> VERSION_AT;
  return abi < 10000 ? abi : abi / 10000;
}

static ethd_status refuse_abi(uint32_t abi, char *what) {
  const uint32_t version = version_of(abi), own = version_of(ETHD_DRIVER_ABI);
  if (version != own)
    return ethd__say(
        what, ETHD_E_ABI,
        "it was built for version %u of the drivers' interface, this is version %u: build it with these headers",
        version, own);
  uint32_t i = 0;
  while ((abi >> sizes[i].at & sizes[i].mask) == sizes[i].size / 8) i++; /* one of them differs */
  return ethd__say(what, ETHD_E_ABI, "it was built with an %s of %u bytes, here it has %u: build it with these headers",
                   sizes[i].name, 8 * (abi >> sizes[i].at & sizes[i].mask), sizes[i].size);
}

/* The ABI comes first: if it differs, the following fields can't be trusted. */
static ethd_status check_head(const ethd_driver *d, char *what) {
  if (!d->abi) return ethd__say(what, ETHD_E_ABI, "its table doesn't say its abi: .abi = ETHD_DRIVER_ABI is needed");
  if (d->abi != ETHD_DRIVER_ABI) return refuse_abi(d->abi, what);
  if (d->size < ETHD_DRIVER_MIN || d->size > sizeof *d)
    return ethd__say(what, ETHD_E_SIZE, "its table has %u bytes, %zu to %zu are allowed: build it with these headers",
                     d->size, ETHD_DRIVER_MIN, sizeof *d);
  return ETHD_OK;
}

/* Checks a table that is as large as ours. */
static ethd_status check_rest(const ethd_driver *d, char *what) {
  char row[ETHD_MESSAGE_MAX];
  if (!is_word(d->id)) return ethd__say(what, ETHD_E_ARGUMENT, "its id isn't 1 to 31 of a-z 0-9 - _");
  if (!ethd__text_is_line(d->brief, ETHD_BRIEF_MAX))
    return ethd__say(what, ETHD_E_ARGUMENT, "the brief of %s isn't one line of 1 to %d printable characters", d->id,
                     ETHD_BRIEF_MAX);
  ethd_status status = ethd__table_fault(d->params, d->param_count, row);
  if (status) return ethd__say(what, status, "%s: params: %s", d->id, row);
  if (!keys_are_words(d->keys))
    return ethd__say(what, ETHD_E_TABLE, "%s: keys: not words, or no NULL behind them", d->id);
  const char *fault = functions_fault(d);
  return fault ? ethd__say(what, ETHD_E_ARGUMENT, "%s %s", d->id, fault) : ETHD_OK;
}

ethd_driver ethd__driver_whole(const ethd_driver *driver) {
  ethd_driver out = {.size = 0};
  memcpy(&out, driver, driver->size);
  out.size = sizeof out;
  return out;
}

ethd_status ethd__driver_check(const ethd_driver *driver, char what[ETHD_MESSAGE_MAX]) {
  ethd_status status = check_head(driver, what);
  if (status) return status;
  const ethd_driver whole = ethd__driver_whole(driver);
  return check_rest(&whole, what);
}

/* ---- files ---- */

static void foreign(const char *what) {
  if (ethd__foreign_code) ethd__foreign_code(what, ETHD__PATIENCE);
}

static ethd_status load(const char *path, ethd_driver *out, char *what) {
  ETHD__FREED char *own =
      strchr(path, '/') ? NULL : ethd__path_join(".", path); /* else dlopen searches the libraries' folders */
  void *handle = dlopen(own ? own : path, RTLD_NOW | RTLD_LOCAL);
  if (!handle) return ethd__say(what, ETHD_E_LOAD, "%s", dlerror());
  const ethd_driver *table = dlsym(handle, "ethd_driver_plugin");
  ethd_status status = table ? ethd__driver_check(table, what)
                             : ethd__say(what, ETHD_E_SYMBOL, "it is no driver: it has no symbol ethd_driver_plugin");
  if (status)
    dlclose(handle);
  else
    *out = ethd__driver_whole(table);
  return status;
}

ethd_status ethd__driver_load(const char *path, ethd_driver *out, char what[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__plugin_file_check(path, what);
  if (status) return status;
  foreign(path);
  status = load(path, out, what);
  foreign(NULL);
  return status;
}
