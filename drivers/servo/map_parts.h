/* What the files that read a map share. All [main]. */
#ifndef ETHD__SERVO_MAP_PARTS_H
#define ETHD__SERVO_MAP_PARTS_H

#include "servo/map.h"
#include "text/ini.h"

/* What is being read, and where a refusal goes. */
typedef struct ethd__servo_source {
  const ethd_ini *ini;
  const char *name; /* of the file */
  char *message;
} ethd__servo_source;

/* Reads a whole number of at most 32 bits, decimal or with 0x. */
bool ethd__servo_whole(const char *text, double *out);

/* Refuses a value: "file:line: section.key: found X, `allowed` is allowed". */
ethd_status ethd__servo_refuse(const ethd__servo_source *s, const ethd_ini_key *key, const char *allowed);

/* Read the keys of [bus] and [watchdog] into the map and those of [register NAME] into a register; keys that aren't
   there get their defaults. `line` is that of the section, 0 without one. */
ethd_status ethd__servo_read_bus(const ethd__servo_source *s, int line, ethd__servo_map *map);
ethd_status ethd__servo_read_watchdog(const ethd__servo_source *s, int line, ethd__servo_map *map);
ethd_status ethd__servo_read_register(const ethd__servo_source *s, const ethd_ini_section *section,
                                      const ethd__servo_map *map, ethd__servo_register *out);

/* Reads the steps of one sequence. */
ethd_status ethd__servo_read_steps(const ethd__servo_source *s, const char *section, const ethd__servo_map *map,
                                   ethd__servo_steps *out);

/* Finds the register of this name; -1: none. */
int32_t ethd__servo_find(const ethd__servo_map *map, const char *name, size_t length);

/* Checks what one key alone can't show: overlaps, limits, echoes, roles. */
ethd_status ethd__servo_map_check(const ethd__servo_source *s, ethd__servo_map *map);

#endif
