/* Lists what a map leaves open, for the user who enables the drive. */
#include "servo/map.h"
#include "servo/words.h"

uint32_t ethd__servo_unconfirmed(const ethd__servo_map *map) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < map->count; i++) n += map->registers[i].unconfirmed;
  return n;
}

static bool has_echo(const ethd__servo_register *r) { return r->echo >= 0; }
static bool has_mask(const ethd__servo_register *r) { return r->fault_mask; }

/* Whether each unit that has a torque has such a register, too. */
static bool each(const ethd__servo_map *map, bool (*is)(const ethd__servo_register *)) {
  return ethd__servo_unit_has(map, 0, is) && ethd__servo_unit_has(map, 1, is);
}

static bool any_mask(const ethd__servo_map *map) {
  for (uint32_t i = 0; i < map->count; i++)
    if (has_mask(&map->registers[i])) return true;
  return false;
}

static bool is_watched(const ethd__servo_map *map, int torque, int measured) {
  if (map->roles[torque] < 0) return true;
  return map->roles[measured] >= 0 && map->registers[map->roles[measured]].tolerance > 0;
}

/* A threshold that the torque can't reach watches nothing. A frozen joint shows by a change of the torque, which may be
   twice the largest torque. */
static bool reaches(const ethd__servo_map *map, double (*threshold)(const ethd__servo_register *), double swing) {
  for (int i = 0; i < 2; i++) {
    int32_t position = map->roles[ETHD__SERVO_POSITION1 + i], torque = map->roles[ETHD__SERVO_TORQUE1 + i];
    if (position < 0) continue;
    if (threshold(&map->registers[position]) >= swing * ethd__servo_most(&map->registers[torque])) return false;
  }
  return true;
}

static double freezes_at(const ethd__servo_register *r) { return r->freeze_torque; }
static double reverses_at(const ethd__servo_register *r) { return r->reverse_torque; }

static bool all_count(const ethd__servo_map *map) {
  for (int i = 0; i < 2; i++) {
    int32_t r = map->roles[ETHD__SERVO_POSITION1 + i];
    if (r >= 0 && !(map->registers[r].counts > 0 && map->registers[r].type != ETHD__SERVO_F32)) return false;
  }
  return true;
}

const char *ethd__servo_risk(const ethd__servo_map *map, uint32_t i) {
  const char *risks[12];
  uint32_t n = 0;
  if (map->watchdog == ETHD__SERVO_WATCH_NONE)
    risks[n++] = "no watchdog: when this computer dies, the drive holds its last torque";
  if (map->resumes) risks[n++] = "the drive goes on by itself when the bus comes back: zero is written first";
  if (!each(map, has_echo)) risks[n++] = "no echo: a stale answer or a lost set-point isn't noticed";
  if (!each(map, has_mask)) risks[n++] = "no fault mask: the drive's faults aren't noticed";
  if (!is_watched(map, ETHD__SERVO_TORQUE1, ETHD__SERVO_MEASURED1) ||
      !is_watched(map, ETHD__SERVO_TORQUE2, ETHD__SERVO_MEASURED2))
    risks[n++] = "no measured torque with a tolerance: a drive that doesn't follow isn't noticed";
  if (!all_count(map)) {
    risks[n++] = "a position that isn't in counts: an encoder that jumps, stands still or is reversed isn't noticed";
  } else {
    if (!reaches(map, freezes_at, 2))
      risks[n++] = "freeze_torque is out of reach: an encoder that stands still isn't noticed";
    if (!reaches(map, reverses_at, 1)) risks[n++] = "reverse_torque is out of reach: a reversed encoder isn't noticed";
  }
  if (map->roles[ETHD__SERVO_BUS_VOLTAGE] < 0) risks[n++] = "no bus_voltage: the supply isn't watched";
  if (any_mask(map) && !map->sequences[ETHD__SERVO_CLEAR].count)
    risks[n++] = "no [clear] steps: only the procedure of its manual ends a fault of the drive";
  if (!map->sequences[ETHD__SERVO_DISABLE].count) risks[n++] = "no [disable] steps: a stop only writes zero torque";
  return i < n ? risks[i] : NULL;
}
