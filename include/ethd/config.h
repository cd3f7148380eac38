/* Configurations: an INI file (interfaces of the programs) to a setup, strictly.
   Links from libethd-drivers and libethd.

   Everything has a default: an empty file is valid. Unknown sections or keys, duplicates, values out of
   range, NaN, hex, trailing junk, over-long lines are errors with file:line, what was found and what is
   allowed. Paths in a file are relative to its folder. All [main]. */
#ifndef ETHD_CONFIG_H
#define ETHD_CONFIG_H

#include "ethd/control.h"
#include "ethd/driver.h"

ETHD_BEGIN_DECLS

typedef struct ethd_config {
  ethd_setup setup;                   /* ready to create a controller with; setup.scene = scene */
  ethd_scene *scene;                  /* owned; without what the arm can't reach; NULL without a scene */
  char *path;                         /* of the file, NULL for defaults */
  char *text;                         /* as it was read, for recordings */
  char *scene_text;                   /* likewise; NULL without a scene */
  char *folder;                       /* relative paths start here */
  uint32_t limits_given;              /* bit i: of ethd_limit_rows[i] */
  char device[ETHD_DRIVERS_TEXT_MAX]; /* the drivers' ids as written, "sim" by default */
  ethd_setting *settings;             /* the other keys of [device] */
  uint32_t setting_count;
  const ethd_law **laws; /* built in and of plugins; ends with NULL */
  char **plugins;        /* their files */
  uint32_t plugin_count;
} ethd_config;

/* path NULL: defaults. On failure *out is NULL and message holds the one line. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_load(const char *path, ethd_config **out,
                                                      char message[ETHD_MESSAGE_MAX]);

/* The same of a file that somebody else made, in a recording or a study's folder: nothing of theirs runs. A plugin is
   refused, with a hint at the programs' option --plugins. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_load_received(const char *path, ethd_config **out,
                                                               char message[ETHD_MESSAGE_MAX]);

/* The same from text; `name` stands for the file in messages, relative paths start at `folder`. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_parse(const char *text, size_t length, const char *name,
                                                       const char *folder, ethd_config **out,
                                                       char message[ETHD_MESSAGE_MAX]);

/* The configuration with its scene; controllers made of it are destroyed before. NULL is fine. [main] */
ETHD_API void ethd_config_free(ethd_config *config);

/* Changes the transition law in `setup`: values that were chosen for keys that the new law has too are
   kept, the rest is dropped; the file's preset counts. Doesn't touch config->setup. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_transition(const ethd_config *config, const char *id,
                                                            ethd_setup *setup, char message[ETHD_MESSAGE_MAX]);

/* Sets "section.key" in `setup` as the file would ("contact.k_e", "2000"); file, law, preset and
   device keys can't be set so. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_set(const ethd_config *config, const char *key, const char *value,
                                                     ethd_setup *setup, char message[ETHD_MESSAGE_MAX]);

/* "file:line: name: sentence; found 3, allowed 0 to 2" of an error that a call of the library left. */
ETHD_API void ethd_error_text(const char *file, const ethd_error *error, char message[ETHD_MESSAGE_MAX]);

ETHD_END_DECLS

#endif
