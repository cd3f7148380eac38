/* What all files that read a map need: names with a meaning, a register by its name, whole numbers, refusals. */
#include <math.h>
#include <string.h>

#include "servo/map_parts.h"
#include "text/key.h"
#include "text/text.h"

#define WORD_MAX 4294967295.0
#define R ETHD__SERVO_READ
#define W ETHD__SERVO_WRITE

const ethd__servo_role ethd__servo_roles[ETHD__SERVO_ROLES] = {
    [ETHD__SERVO_TORQUE1] = {"torque1", "A|Nm", W},
    [ETHD__SERVO_TORQUE2] = {"torque2", "A|Nm", W},
    [ETHD__SERVO_COUNTER] = {"counter", "1", W},
    [ETHD__SERVO_COUNTER2] = {"counter2", "1", W},
    [ETHD__SERVO_POSITION1] = {"position1", "count|turn|rad", R},
    [ETHD__SERVO_POSITION2] = {"position2", "count|turn|rad", R},
    [ETHD__SERVO_SPEED1] = {"speed1", "count/s|rpm|rad/s", R},
    [ETHD__SERVO_SPEED2] = {"speed2", "count/s|rpm|rad/s", R},
    [ETHD__SERVO_MEASURED1] = {"measured1", "A|Nm", R},
    [ETHD__SERVO_MEASURED2] = {"measured2", "A|Nm", R},
    [ETHD__SERVO_BUS_VOLTAGE] = {"bus_voltage", "V", R},
    [ETHD__SERVO_INDEX1] = {"index1", "count", R},
    [ETHD__SERVO_INDEX2] = {"index2", "count", R},
    [ETHD__SERVO_READING_X] = {"reading_x", "m", R},
    [ETHD__SERVO_READING_Y] = {"reading_y", "m", R},
    [ETHD__SERVO_READING_COUNT] = {"reading_count", "1", R},
    [ETHD__SERVO_READING_AGE] = {"reading_age", "s", R},
};

int32_t ethd__servo_find(const ethd__servo_map *map, const char *name, size_t length) {
  for (uint32_t i = 0; i < map->count; i++)
    if (strlen(map->registers[i].name) == length && !memcmp(map->registers[i].name, name, length)) return (int32_t)i;
  return -1;
}

bool ethd__servo_several(const ethd__servo_map *map) {
  for (uint32_t i = 0; i < map->count; i++)
    if (map->registers[i].bus_unit != map->unit) return true;
  return false;
}

bool ethd__servo_unit_has(const ethd__servo_map *map, int axis, bool (*is)(const ethd__servo_register *)) {
  int32_t torque = map->roles[ETHD__SERVO_TORQUE1 + axis];
  for (uint32_t i = 0; i < map->count && torque >= 0; i++)
    if (map->registers[i].bus_unit == map->registers[torque].bus_unit && is(&map->registers[i])) return true;
  return torque < 0;
}

ethd_status ethd__servo_refuse(const ethd__key_file *s, const ethd_ini_key *key, const char *allowed) {
  const ethd__key found = ethd__key_of(s->name, key, s->message);
  return ethd__key_found(&found, ETHD_E_RANGE, allowed);
}
