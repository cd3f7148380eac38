#include "servo/map_text.h"

#include <stdlib.h>
#include <string.h>

#include "text/text.h"

char text[MAP_TEXT_MAX];
ethd__servo_map map;

void read_map(const char *path) {
  char *found;
  size_t length;
  ck_assert_msg(ethd_text_read(path, sizeof text - 1, &found, &length, message) == ETHD_OK, "%s", message);
  memcpy(text, found, length + 1);
  free(found);
}

ethd_status try(const char *changed) { return ethd__servo_map_parse(changed, strlen(changed), "m.map", &map, message); }

const ethd__servo_register *named(const char *name) {
  for (uint32_t i = 0; i < map.count; i++)
    if (!strcmp(map.registers[i].name, name)) return &map.registers[i];
  ck_abort_msg("no register %s", name);
}
