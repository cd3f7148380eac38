/* Laws from a shared object. Links from libethd.

   A plugin exports one data symbol:   const ethd_plugin_entry ethd_plugin = {sizeof(ethd_plugin_entry),
   ETHD_ABI, "mine", "1.0", laws, 1}; A host reads the file's table without calling any of its functions, but the
   system's loader runs the file's constructors before any check. So a plugin must be trusted like the program itself.
   The checks and fences (law.h) find mistakes; they don't stop an attacker. */
#ifndef ETHD_PLUGIN_H
#define ETHD_PLUGIN_H

#include "ethd/law.h"

ETHD_BEGIN_DECLS

typedef struct ethd_plugin_entry {
  uint32_t size;            /* sizeof(ethd_plugin_entry) as compiled */
  uint32_t abi;             /* ETHD_ABI, exact */
  const char *id, *version; /* 1 to 31 printable ASCII characters */
  const ethd_law *const *laws;
  uint32_t law_count; /* 1 to 64 */
} ethd_plugin_entry;

#define ETHD_PLUGIN_MIN (offsetof(ethd_plugin_entry, law_count) + sizeof(uint32_t))

/* Defined by the plugin, not by the library. */
extern ETHD_API const ethd_plugin_entry ethd_plugin;

/* Loads a plugin (RTLD_NOW | RTLD_LOCAL) and checks it and every law in it; it stays loaded until the process ends.
   Refusals: ETHD_E_LOAD (not a loadable file), ETHD_E_SYMBOL, ETHD_E_ABI, ETHD_E_SIZE,
   ETHD_E_STATE, ETHD_E_TABLE, ETHD_E_ARGUMENT (a law without step, or with a bad id or brief), ETHD_E_DUPLICATE (an id
   twice in the file). error->name says which law, parameter or field of a table. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_plugin_open(const char *path, const ethd_plugin_entry **out,
                                                      ethd_error *error);

ETHD_END_DECLS

#endif
