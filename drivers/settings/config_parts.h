/* The parts of a configuration that only its own files need. */
#ifndef ETHD_FILE_CONFIG_PARTS_H
#define ETHD_FILE_CONFIG_PARTS_H

#include <stdbool.h>

#include "ethd/config.h"
#include "text/ini.h"

/* What an ethd_config really is. */
typedef struct ethd__config {
  ethd_config config; /* first: the public part */
  ethd_ini ini;
  char *scene_path;
  bool received; /* from somebody else: its plugins stay closed */
} ethd__config;

static inline const ethd__config *ethd__config_whole(const ethd_config *config) { return (const ethd__config *)config; }

/* A key that is being applied, for messages. file NULL: a command, not a file. */
typedef struct ethd__config_key {
  const char *file;
  int line;
  const char *section, *key, *value;
  char *message;
} ethd__config_key;

/* "file:line: section.key: ..."; returns `status`. */
ethd_status ethd__key_refuse(const ethd__config_key *key, ethd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* "... found "value", ALLOWED is allowed" */
ethd_status ethd__key_found(const ethd__config_key *key, ethd_status status, const char *allowed);

/* ---- config_sections.c: one row for each section ---- */

/* Keys that don't hold a number are read before those that do: what a number means depends on them, wherever they
   stand in the file. */
typedef enum ethd__pass { ETHD__PASS_PLUGINS, ETHD__PASS_CHOICES, ETHD__PASS_PRESET, ETHD__PASS_REST } ethd__pass;
#define ETHD__PASSES 4

/* A key that stands in files only. */
typedef struct ethd__file_key {
  const char *key; /* "*": any, as of [device] */
  ethd__pass pass;
  ethd_status (*read)(ethd__config *config, const ethd__config_key *key);
} ethd__file_key;

/* Besides these a section has what ethd_setup_part_of(name) chooses and the numbers that the setup has by its name. */
typedef struct ethd__section {
  const char *name;
  ethd__file_key keys[2];
} ethd__section;

#define ETHD__SECTIONS 14
extern const ethd__section ethd__sections[ETHD__SECTIONS];

/* Reads the key if it belongs to this pass. */
ethd_status ethd__config_read(ethd__config *config, const ethd__config_key *key, ethd__pass pass);

/* Whether commands can't set the key. */
bool ethd__config_in_files_only(const char *section, const char *key);

/* The refusal of a key that its section doesn't have under the laws of the setup. */
ethd_status ethd__config_unknown(const ethd__config_key *key, const ethd_setup *setup);

/* Refuses a section that no configuration has: it may stand without any key. */
ethd_status ethd__config_section_known(const ethd_ini_section *section, const char *file,
                                       char message[ETHD_MESSAGE_MAX]);

/* ---- config_keys.c: numbers ---- */

/* Reads a number, a word or several numbers into the setup. Ranges are checked, relations between keys are left to
   ethd_setup_check. */
ethd_status ethd__config_number(const ethd__config_key *key, ethd_setup *setup);

/* Index in ethd_limit_rows, -1: the key is no limit. */
int ethd__config_limit(const char *section, const char *key);

/* ---- the keys of files ---- */

/* law = ..., method = ...: with default parameters. */
ethd_status ethd__config_choose(const ethd_config *config, const ethd__config_key *key, ethd_setup *setup);

/* [scene] file: reads the scene. */
ethd_status ethd__config_scene(ethd__config *config, const ethd__config_key *key);

/* preset = paper on whatever the transition law has; a no-op for product. */
ethd_status ethd__config_preset(ethd__config *config, const ethd__config_key *key);

/* Code of a plugin runs from here on (what: its file, or what it does), or no longer (NULL): a program that wants to
   end it when it doesn't return hooks in here. NULL: nobody does. [main] */
extern void (*ethd__foreign_code)(const char *what);

/* ethd_setup_check, in which laws of the configuration's plugins may run. */
ethd_status ethd__config_check(const ethd_config *config, const ethd_setup *setup, ethd_error *error);

/* [plugins] file: opens, and adds its laws to config->laws. */
ethd_status ethd__config_plugin(ethd__config *config, const ethd__config_key *key);

/* ETHD_OK if dlopen may map the file: a complete ELF object for this machine. */
ethd_status ethd__plugin_file_check(const char *path, char what[ETHD_MESSAGE_MAX]);

#endif
