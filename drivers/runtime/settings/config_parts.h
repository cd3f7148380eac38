/* The private parts of a configuration. */
#ifndef ETHD__SETTINGS_CONFIG_PARTS_H
#define ETHD__SETTINGS_CONFIG_PARTS_H

#include <stdbool.h>

#include "settings/front.h"
#include "text/key.h"

/* An ethd_config with its private parts. */
typedef struct ethd__config {
  ethd_config config; /* first: the public part */
  ethd_ini ini;
  char *scene_path;
  bool received; /* it comes from another person, so its plugins stay closed */
} ethd__config;

static inline const ethd__config *ethd__config_whole(const ethd_config *config) { return (const ethd__config *)config; }

/* ---- config_sections.c: one row for each section ---- */

/* Keys without a number are read before those with one, at any place in the file, because the meaning of a number
   depends on them. */
typedef enum ethd__pass { ETHD__PASS_PLUGINS, ETHD__PASS_CHOICES, ETHD__PASS_PRESET, ETHD__PASS_REST } ethd__pass;
#define ETHD__PASSES 4

/* A key that only files have. */
typedef struct ethd__file_key {
  const char *key; /* "*": any key, as in [device] */
  ethd__pass pass;
  ethd_status (*read)(ethd__config *config, const ethd__key *key);
} ethd__file_key;

/* A section. It has these keys, the key that part_of(name) chooses, and the numbers that the setup has under
   its name. */
typedef struct ethd__section {
  const char *name;
  unsigned fronts; /* the fronts with this section */
  ethd__file_key keys[2];
} ethd__section;

extern const ethd__section ethd__sections[]; /* a NULL name ends it */

/* Reads the key if it belongs to this pass. */
ethd_status ethd__config_read(ethd__config *config, const ethd__key *key, ethd__pass pass);

/* Returns true if commands can't set the key. */
bool ethd__config_in_files_only(const ethd__config_front *front, const char *section, const char *key);

/* Refuses a key that its section doesn't have under the laws of the setup. */
ethd_status ethd__config_unknown(const ethd__key *key, const ethd__config_front *front, const void *setup);

/* Refuses a section that no configuration of this front has, even without keys. `space`: the file's section [space],
   NULL: it has none. */
ethd_status ethd__config_section_known(const ethd_ini_section *section, const ethd_ini_section *space, const char *file,
                                       char message[ETHD_MESSAGE_MAX]);

/* ---- config_keys.c: numbers ---- */

/* Reads a number, a word or several numbers into the setup. Ranges are checked, relations between keys are left to
   the front's check. */
ethd_status ethd__config_number(const ethd__key *key, const ethd__config_front *front, void *setup);

/* Do what ethd_config_set and ethd_config_law do, for a setup of either front. */
ethd_status ethd__config_set(const ethd_config *config, const ethd__config_front *front, const char *name,
                             const char *value, void *setup, char message[ETHD_MESSAGE_MAX]);
ethd_status ethd__config_law(const ethd_config *config, const ethd__config_front *front, const char *kind,
                             const char *id, void *setup, char message[ETHD_MESSAGE_MAX]);

/* Returns the index in ethd_limit_rows, -1 if the key isn't a limit. */
int ethd__config_limit(const char *section, const char *key);

/* ---- the keys of files ---- */

/* Applies law = ... or method = ..., with default parameters. */
ethd_status ethd__config_choose(const ethd_config *config, const ethd__key *key, const ethd__config_front *front,
                                void *setup);

/* [scene] file: reads the scene. */
ethd_status ethd__config_scene(ethd__config *config, const ethd__key *key);

/* Applies preset = paper to the parameters that the transition law has; product changes nothing. */
ethd_status ethd__config_preset(ethd__config *config, const ethd__key *key);

#define ETHD__PATIENCE 5 /* s: no plugin needs longer to be loaded, and no law to check its parameters */

/* A hook for a program that ends plugins which don't return; NULL: none. Before code of a plugin runs it is called with
   `what`, the plugin's file or action, and the seconds that it may take; after that with NULL. [main] */
extern void (*ethd__foreign_code)(const char *what, unsigned patience);

/* Calls the hook: code of the configuration's plugins runs from here on, or no longer (NULL). Does nothing without
   plugins. */
void ethd__config_foreign(const ethd_config *config, const char *what);

/* Calls the front's check, which may run the plugins' laws. */
ethd_status ethd__config_check(const ethd_config *config, const ethd__config_front *front, void *setup,
                               ethd_error *error);

/* [plugins] file: opens the plugin and adds its laws to config->laws. */
ethd_status ethd__config_plugin(ethd__config *config, const ethd__key *key);

/* Returns ETHD_OK if dlopen may map the file, which must be a complete ELF object for this machine. */
ethd_status ethd__plugin_file_check(const char *path, char what[ETHD_MESSAGE_MAX]);

#endif
