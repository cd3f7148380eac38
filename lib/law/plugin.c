#include "ethd/plugin.h"

#include <dlfcn.h>
#include <string.h>

#include "error.h"
#include "line.h"

#define LAWS_MAX 64
#define WORD_MAX 31

static ethd_status check_laws(const ethd_plugin_entry *entry, ethd_error *error) {
  for (uint32_t i = 0; i < entry->law_count; i++) {
    ethd_status status = ethd_law_check(entry->laws[i], error);
    if (status < 0) return status;
    for (uint32_t j = 0; j < i; j++)
      if (entry->laws[j]->kind == entry->laws[i]->kind && !strcmp(entry->laws[j]->id, entry->laws[i]->id))
        return ethd__error(error, ETHD_E_DUPLICATE, entry->laws[i]->id);
  }
  return ETHD_OK;
}

static ethd_status check_entry(const ethd_plugin_entry *entry, ethd_error *error) {
  if (entry->abi != ETHD_ABI)
    return ethd__refuse(error, ETHD_E_ABI, "ethd_plugin.abi", (ethd__found){entry->abi, ETHD_ABI, ETHD_ABI});
  if (entry->size < ETHD_PLUGIN_MIN)
    return ethd__refuse(error, ETHD_E_SIZE, "ethd_plugin.size",
                        (ethd__found){entry->size, (double)ETHD_PLUGIN_MIN, (double)INFINITY});
  if (!ethd__is_line(entry->id, WORD_MAX) || !ethd__is_line(entry->version, WORD_MAX) || !entry->laws)
    return ethd__error(error, ETHD_E_ARGUMENT, "ethd_plugin");
  if (entry->law_count < 1 || entry->law_count > LAWS_MAX)
    return ethd__refuse(error, ETHD_E_RANGE, "ethd_plugin.law_count", (ethd__found){entry->law_count, 1, LAWS_MAX});
  return check_laws(entry, error);
}

ethd_status ethd_plugin_open(const char *path, const ethd_plugin_entry **out, ethd_error *error) {
  *out = NULL;
  if (!path || !path[0]) return ethd__error(error, ETHD_E_LOAD, "path"); /* dlopen would open the program itself */
  void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!handle) return ethd__error(error, ETHD_E_LOAD, path);
  const ethd_plugin_entry *entry = dlsym(handle, "ethd_plugin");
  ethd_status status = entry ? check_entry(entry, error) : ethd__error(error, ETHD_E_SYMBOL, "ethd_plugin");
  if (status < 0) {
    dlclose(handle);
    return status;
  }
  *out = entry;
  return ETHD_OK;
}
