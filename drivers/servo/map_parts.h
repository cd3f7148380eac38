/* Shared by the files that read a map. All [main]. */
#ifndef ETHD__SERVO_MAP_PARTS_H
#define ETHD__SERVO_MAP_PARTS_H

#include "servo/map.h"
#include "text/key.h"

/* Refuses a value: "file:line: section.key: found X, `allowed` is allowed". */
ethd_status ethd__servo_refuse(const ethd__key_file *s, const ethd_ini_key *key, const char *allowed);

/* Read the keys of [bus] and [watchdog] into the map and those of [register NAME] into a register; missing keys get
   their defaults. `line` is that of the section, 0 without one. */
ethd_status ethd__servo_read_bus(const ethd__key_file *s, int line, ethd__servo_map *map);
ethd_status ethd__servo_read_watchdog(const ethd__key_file *s, int line, ethd__servo_map *map);
ethd_status ethd__servo_read_register(const ethd__key_file *s, const ethd_ini_section *section,
                                      const ethd__servo_map *map, ethd__servo_register *out);

/* Reads the steps of one sequence. */
ethd_status ethd__servo_read_steps(const ethd__key_file *s, const char *section, const ethd__servo_map *map,
                                   ethd__servo_steps *out);

/* Finds the register of this name; -1: none. */
int32_t ethd__servo_find(const ethd__servo_map *map, const char *name, size_t length);

/* Checks the conditions between keys: overlaps, limits, echoes, roles. */
ethd_status ethd__servo_map_check(const ethd__key_file *s, ethd__servo_map *map);

#endif
