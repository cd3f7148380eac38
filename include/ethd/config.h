/* Configurations: an INI file becomes a setup and the choice of a device.
   Links from libethd-drivers and libethd.

   A file with a section [space] configures the controller in space (space.h), any other file the one in the plane
   (control.h). Sections that both have mean the same; sections of the other one are refused.

   Everything has a default, so an empty file is valid. Files are read strictly: unknown sections or keys, duplicates,
   values out of range, NaN, hex, trailing junk and over-long lines are errors with file:line, what was found and what
   is allowed. Paths in a file are relative to its folder. All [main]. */
#ifndef ETHD_CONFIG_H
#define ETHD_CONFIG_H

#include "ethd/control.h"
#include "ethd/driver.h"
#include "ethd/solids.h"
#include "ethd/space.h"

ETHD_BEGIN_DECLS

typedef struct ethd_config {
  ethd_setup setup;                   /* ready for ethd_control_create; setup.scene = scene */
  ethd_scene *scene;                  /* owned, without objects out of the arm's reach; NULL if none is configured */
  char *path;                         /* of the file, NULL for defaults */
  char *text;                         /* as it was read, for recordings */
  char *scene_text;                   /* as it was read, also of solids; NULL if there are none */
  char *folder;                       /* relative paths start here */
  uint32_t limits_given;              /* bit i: of ethd_limit_rows[i] */
  char device[ETHD_DRIVERS_TEXT_MAX]; /* the drivers' ids as written, "sim" by default */
  ethd_setting *settings;             /* the other keys of [device] */
  uint32_t setting_count;
  const ethd_law **laws; /* built-in laws and those of plugins; ends with NULL */
  char **plugins;        /* their files */
  uint32_t plugin_count;
  int32_t is_space;       /* 1: the file configures `space`, and `setup` has defaults */
  ethd_space_setup space; /* ready for ethd_space_create; it has the parameters on the solids' materials */
  ethd_solids *solids;    /* owned; NULL if none are configured */
} ethd_config;

/* The source of a configuration, for the functions below. */
typedef struct ethd_config_source {
  ethd_sizes sizes; /* of the headers with which the program was compiled */
  uint32_t config;  /* sizeof(ethd_config) of those headers */
  int32_t received; /* 1: another person made it */
  const char *path; /* of the file; with `text` a name for messages; NULL: none */
  const char *text; /* NULL: the file's */
  size_t length;    /* of text, bytes */
  const char *folder;
} ethd_config_source;

/* Reads a configuration for the functions below. ETHD_E_SIZE: the program was compiled with headers in which a struct
   that program and library both write has another size. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_make(const ethd_config_source *source, ethd_config **out,
                                                      char message[ETHD_MESSAGE_MAX]);

/* Reads a configuration; path NULL gives the defaults. On failure *out is NULL and message holds one line:
   ETHD_E_FILE, ETHD_E_SYNTAX, ETHD_E_UNKNOWN, ETHD_E_DUPLICATE, ETHD_E_MEMORY, the statuses of ethd_scene_parse or
   ethd_solids_parse, ethd_plugin_open and ethd_config_make, and those of ethd_setup_check or ethd_space_check. Its
   plugins are loaded, and their code runs. */
static inline ETHD_MUST_CHECK ethd_status ethd_config_load(const char *path, ethd_config **out,
                                                           char message[ETHD_MESSAGE_MAX]) {
  const ethd_config_source source = {ethd_sizes_here(), (uint32_t)sizeof(ethd_config), 0, path, NULL, 0, NULL};
  return ethd_config_make(&source, out, message);
}

/* Reads a file that another person made, in a recording or a study's folder, and runs none of its code: a plugin is
   refused (ETHD_E_LOAD), with a hint at the programs' option --plugins. Its scene is a regular file of that folder,
   reached without a link, and so is the file itself (ETHD_E_FILE). */
static inline ETHD_MUST_CHECK ethd_status ethd_config_load_received(const char *path, ethd_config **out,
                                                                    char message[ETHD_MESSAGE_MAX]) {
  const ethd_config_source source = {ethd_sizes_here(), (uint32_t)sizeof(ethd_config), 1, path, NULL, 0, NULL};
  return ethd_config_make(&source, out, message);
}

/* Reads a configuration from text. Messages call it `name`; relative paths start at `folder`. Fails as
   ethd_config_load does (ETHD_E_...). */
static inline ETHD_MUST_CHECK ethd_status ethd_config_parse(const char *text, size_t length, const char *name,
                                                            const char *folder, ethd_config **out,
                                                            char message[ETHD_MESSAGE_MAX]) {
  const ethd_config_source source = {ethd_sizes_here(), (uint32_t)sizeof(ethd_config), 0, name, text, length, folder};
  return ethd_config_make(&source, out, message);
}

/* The same for text that another person made: a plugin is refused as ethd_config_load_received refuses it
   (ETHD_E_LOAD), and none of its code runs. A scene outside of `folder` or behind a link isn't read (ETHD_E_FILE). */
static inline ETHD_MUST_CHECK ethd_status ethd_config_parse_received(const char *text, size_t length, const char *name,
                                                                     const char *folder, ethd_config **out,
                                                                     char message[ETHD_MESSAGE_MAX]) {
  const ethd_config_source source = {ethd_sizes_here(), (uint32_t)sizeof(ethd_config), 1, name, text, length, folder};
  return ethd_config_make(&source, out, message);
}

/* Frees the configuration with its scene; destroy the controllers that use it first. NULL is allowed. [main] */
ETHD_API void ethd_config_free(ethd_config *config);

/* Changes the law of a kind, "tracking", "contact" or "transition", in `setup`, not in config->setup. It keeps the
   values that were chosen for keys that the new law has too, and drops the rest; the file's preset still applies.
   ETHD_E_ARGUMENT: no such kind; ETHD_E_UNKNOWN: no law of that id; else the statuses of ethd_setup_check. A refusal
   changes nothing. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_law(const ethd_config *config, const char *kind, const char *id,
                                                     ethd_setup *setup, char message[ETHD_MESSAGE_MAX]);

/* As ethd_config_law of "transition": ETHD_E_UNKNOWN and the statuses of ethd_setup_check. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_transition(const ethd_config *config, const char *id,
                                                            ethd_setup *setup, char message[ETHD_MESSAGE_MAX]);

/* Sets "section.key" in `setup` as the file would ("contact.k_e", "2000"). It can't set keys that name a file, a law, a
   preset or a device (ETHD_E_ARGUMENT). ETHD_E_SYNTAX, ETHD_E_UNKNOWN, ETHD_E_RANGE and the statuses of
   ethd_setup_check. A refusal changes nothing. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_set(const ethd_config *config, const char *key, const char *value,
                                                     ethd_setup *setup, char message[ETHD_MESSAGE_MAX]);

/* As ethd_config_law and ethd_config_set for a setup of a configuration of space, with the statuses of ethd_space_check
   (ETHD_E_...). The parameters on the solids' materials follow from those of the contact law. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_space_law(const ethd_config *config, const char *kind, const char *id,
                                                           ethd_space_setup *setup, char message[ETHD_MESSAGE_MAX]);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_config_space_set(const ethd_config *config, const char *key,
                                                           const char *value, ethd_space_setup *setup,
                                                           char message[ETHD_MESSAGE_MAX]);

/* Writes the error of a library call as the text "file:line: name: sentence; found 3, allowed 0 to 2". */
ETHD_API void ethd_error_text(const char *file, const ethd_error *error, char message[ETHD_MESSAGE_MAX]);

ETHD_END_DECLS

#endif
