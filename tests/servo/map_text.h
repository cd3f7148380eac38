/* A register map's text, and what the parser makes of it: what the tests of maps share. */
#ifndef ETHD_TESTS_SERVO_MAP_TEXT_H
#define ETHD_TESTS_SERVO_MAP_TEXT_H

#include "servo/map.h"
#include "unit/rig.h"

enum { MAP_TEXT_MAX = 1 << 16 };
extern char text[MAP_TEXT_MAX], message[ETHD_MESSAGE_MAX];
extern ethd__servo_map map;

/* Reads a file into `text`. */
void read_map(const char *path);

/* Parses a map, named m.map, into `map`. */
ethd_status try(const char *changed);

/* A register of `map`, which must be there. */
const ethd__servo_register *named(const char *name);

#endif
