/* The parts of a configuration that only its own files need. */
#ifndef ETHD_FILE_CONFIG_PARTS_H
#define ETHD_FILE_CONFIG_PARTS_H

#include "ethd/config.h"
#include "text/ini.h"

/* What an ethd_config really is. */
typedef struct ethd__config {
  ethd_config config; /* first: the public part */
  ethd_ini ini;
  char *scene_path;
} ethd__config;

static inline const ethd__config *ethd__config_whole(const ethd_config *config) { return (const ethd__config *)config; }

/* A key that is being applied, for messages. file NULL: a command, not a file. */
typedef struct ethd__key {
  const char *file;
  int line;
  const char *section, *key, *value;
  char *message;
} ethd__key;

/* "file:line: section.key: ..."; returns `status`. */
ethd_status ethd__key_refuse(const ethd__key *key, ethd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* "... found "value", ALLOWED is allowed" */
ethd_status ethd__key_found(const ethd__key *key, ethd_status status, const char *allowed);

/* One key that needs no other: ranges of parameters are checked, relations are left to
   ethd_setup_check. */
ethd_status ethd__config_apply(const ethd__key *key, ethd_setup *setup);

/* Index in ethd_limit_rows, -1: the key is no limit. */
int ethd__config_limit(const char *section, const char *key);

/* The refusal of a key that its section has not under the laws of the setup. */
ethd_status ethd__config_unknown(const ethd__key *key, ethd_setup *setup);

/* Refuses a section that no configuration has: it may stand without any key. */
ethd_status ethd__config_section_known(const ethd_ini_section *section, const char *file, ethd_setup *setup,
                                       char message[ETHD_MESSAGE_MAX]);

/* The section's own table in a setup: law or method, its parameters and their values. */
typedef struct ethd__section {
  const char *id; /* of the law or method that rules */
  const ethd_param *params;
  uint32_t count;
  double *values;
} ethd__section;
int ethd__config_section(ethd_setup *setup, const char *section, ethd__section *out);

/* law = ..., method = ...: with the law's defaults. */
ethd_status ethd__config_choose(const ethd_config *config, const ethd__key *key, ethd_setup *setup);
/* "law", "method" or NULL */
const char *ethd__config_chooser(const char *section);

/* preset = paper on whatever the transition law has; a no-op for product. */
ethd_status ethd__config_preset(const ethd__key *key, ethd_setup *setup);

/* [plugins] file: opens, and adds its laws to config->laws. */
ethd_status ethd__config_plugin(ethd__config *config, const ethd__key *key);

/* ETHD_OK if dlopen may map the file: a complete ELF object for this machine. */
ethd_status ethd__plugin_file_check(const char *path, char what[ETHD_MESSAGE_MAX]);

#endif
