/* Checks of a map that need more than one key. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "ethd/param.h"
#include "servo/map_parts.h"
#include "servo/words.h"
#include "text/error_text.h"

#define R ETHD__SERVO_READ
#define W ETHD__SERVO_WRITE
#define ZERO 1e-9 /* of the largest torque: less counts as none */

/* Refuses at the line of a register's key, or of its section when it doesn't have that key. */
static ethd_status refuse(const ethd__key_file *s, const ethd__servo_register *r, const char *name, const char *format,
                          ...) __attribute__((format(printf, 4, 5)));
static ethd_status refuse(const ethd__key_file *s, const ethd__servo_register *r, const char *name, const char *format,
                          ...) {
  char section[ETHD__SERVO_NAME_MAX + 16], text[256];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  snprintf(section, sizeof section, "register %s", r->name);
  const ethd_ini_key *key = ethd_ini_find(s->ini, section, name);
  return ethd__say(s->message, ETHD_E_RANGE, "%s:%d: %s.%s: %s", s->name, key ? key->line : r->line, section, name,
                   text);
}

static bool has(const ethd__key_file *s, const ethd__servo_register *r, const char *key) {
  char section[ETHD__SERVO_NAME_MAX + 16];
  snprintf(section, sizeof section, "register %s", r->name);
  return ethd_ini_find(s->ini, section, key) != NULL;
}

static bool unit_is(const ethd__servo_register *r, const char *words) {
  const ethd_param units = {.unit = ethd__servo_units}, allowed = {.unit = words};
  char word[16];
  const char *at = units.unit;
  for (int i = 0; i < r->unit; i++) at = strchr(at, '|') + 1;
  snprintf(word, sizeof word, "%.*s", (int)strcspn(at, "|"), at);
  /* a table of one word has no '|' */
  return strchr(words, '|') ? ethd_param_word(&allowed, word) >= 0 : !strcmp(words, word);
}

/* ---- one register ---- */

static ethd_status check_unit(const ethd__key_file *s, const ethd__servo_register *r) {
  if (unit_is(r, "A") && !(r->torque_constant > 0))
    return refuse(s, r, "torque_constant", "is missing: unit = A needs it");
  if (unit_is(r, "count|count/s") && !(r->counts > 0))
    return refuse(s, r, "counts", "is missing: counts for each turn of the motor");
  if (unit_is(r, "count") && (r->counts != rint(r->counts) || r->scale != 1 || r->offset != 0))
    return refuse(s, r, "counts", "a counter has whole counts, scale = 1 and offset = 0");
  if (r->role < 0) return ETHD_OK;
  const ethd__servo_role *role = &ethd__servo_roles[r->role];
  if (!unit_is(r, role->units)) return refuse(s, r, "unit", "%s is allowed", role->units);
  if (r->direction != role->direction)
    return refuse(s, r, "direction", "%s is allowed", role->direction == R ? "read" : "write");
  return ETHD_OK;
}

static bool is_counter(const ethd__servo_register *r) {
  return r->role == ETHD__SERVO_COUNTER || r->role == ETHD__SERVO_COUNTER2;
}

static ethd_status check_words(const ethd__key_file *s, const ethd__servo_register *r) {
  if (r->type >= ETHD__SERVO_U32 && r->order == ETHD__SERVO_NO_ORDER)
    return refuse(s, r, "order", "is missing: two words need high-first or low-first");
  if (r->direction == W && r->space == ETHD__SERVO_INPUT)
    return refuse(s, r, "space", "an input register can't be written, holding is allowed");
  if (r->type != ETHD__SERVO_F32 && r->bits > 16 * ethd__servo_words(r))
    return refuse(s, r, "bits", "found %u, its words have %u", r->bits, 16 * ethd__servo_words(r));
  if (r->type == ETHD__SERVO_F32 && unit_is(r, "count")) return refuse(s, r, "type", "counts are whole numbers");
  if (is_counter(r) && r->type != ETHD__SERVO_U16) return refuse(s, r, "type", "u16 is allowed");
  if (r->role == ETHD__SERVO_READING_COUNT && r->type == ETHD__SERVO_F32)
    return refuse(s, r, "type", "a type of whole numbers is allowed");
  return ETHD_OK;
}

static ethd_status check_masks(const ethd__key_file *s, const ethd__servo_register *r) {
  uint32_t most = ethd__servo_words(r) == 2 ? UINT32_MAX : UINT16_MAX;
  if (!(r->fault_mask | r->enabled_mask)) return ETHD_OK;
  const char *key = r->fault_mask ? "fault_mask" : "enabled_mask";
  if (r->direction != R || r->type == ETHD__SERVO_F32)
    return refuse(s, r, key, "only whole numbers that are read have bits");
  if (r->fault_mask > most || r->enabled_mask > most) return refuse(s, r, key, "is wider than the register");
  if (r->healthy & ~r->fault_mask) return refuse(s, r, "healthy", "has bits outside of fault_mask");
  if (r->enabled & ~r->enabled_mask) return refuse(s, r, "enabled", "has bits outside of enabled_mask");
  return ETHD_OK;
}

static ethd_status check_torque(const ethd__key_file *s, const ethd__servo_register *r) {
  double least, most, low = (r->min - r->offset) / r->scale, high = (r->max - r->offset) / r->scale;
  if (!has(s, r, "min") || !has(s, r, "max"))
    return refuse(s, r, has(s, r, "min") ? "max" : "min", "is missing: a command needs its limits");
  if (!(r->min < 0 && r->max > 0)) return refuse(s, r, "min", "min < 0 < max is allowed");
  ethd__servo_range(r, &least, &most);
  if (!(fmin(low, high) >= least && fmax(low, high) <= most))
    return refuse(s, r, "max", "the limits are raw %.10g and %.10g, the type holds %.10g to %.10g", low, high, least,
                  most);
  if (fabs(ethd__servo_joint(r, ethd__servo_raw(r, 0))) > ZERO * ethd__servo_most(r))
    return refuse(s, r, "offset", "no torque is raw %.10g, a number of its type is needed", -r->offset / r->scale);
  return ETHD_OK;
}

static ethd_status check_register(const ethd__key_file *s, const ethd__servo_register *r) {
  ethd_status status = check_words(s, r);
  if (!status) status = check_unit(s, r);
  if (!status) status = check_masks(s, r);
  if (!status && (r->role == ETHD__SERVO_TORQUE1 || r->role == ETHD__SERVO_TORQUE2)) status = check_torque(s, r);
  if (status) return status;
  if (r->role == ETHD__SERVO_BUS_VOLTAGE && !(has(s, r, "min") && has(s, r, "max") && r->min < r->max))
    return refuse(s, r, "min", "min < max are needed: outside of them the supply is a fault");
  if (is_counter(r) && !(r->max >= 1 && r->max == rint(fmin(r->max, 1e12))))
    return refuse(s, r, "max", "a counter counts to a whole number from 1");
  if (r->absolute && r->role != ETHD__SERVO_POSITION1 && r->role != ETHD__SERVO_POSITION2)
    return refuse(s, r, "absolute", "only position1 and position2 can be");
  if (r->tolerance > 0 && r->role != ETHD__SERVO_MEASURED1 && r->role != ETHD__SERVO_MEASURED2)
    return refuse(s, r, "tolerance", "only measured1 and measured2 have one");
  return ETHD_OK;
}

/* ---- echoes, overlaps, use ---- */

static ethd_status link_echo(const ethd__key_file *s, ethd__servo_map *map, ethd__servo_register *r) {
  char section[ETHD__SERVO_NAME_MAX + 16];
  snprintf(section, sizeof section, "register %s", r->name);
  const ethd_ini_key *key = ethd_ini_find(s->ini, section, "echo");
  if (!key) return ETHD_OK;
  r->echo = ethd__servo_find(map, key->value, strlen(key->value));
  if (r->echo < 0) return refuse(s, r, "echo", "the map has no [register %.40s]", key->value);
  if (r->direction != W || r->role < 0) return refuse(s, r, "echo", "only torque1, torque2 and counters have one");
  if (map->registers[r->echo].direction != R) return refuse(s, r, "echo", "%s isn't read", key->value);
  if (map->registers[r->echo].type != r->type) return refuse(s, r, "echo", "%s is of another type", key->value);
  if (map->registers[r->echo].bus_unit != r->bus_unit) return refuse(s, r, "echo", "%s is of another unit", key->value);
  map->registers[r->echo].cyclic = true;
  return ETHD_OK;
}

static bool overlap(const ethd__servo_map *map, const ethd__servo_register *a, const ethd__servo_register *b) {
  if (a->bus_unit != b->bus_unit || a->space != b->space) return false;
  if (map->addressing == ETHD__SERVO_BY_VALUE) return a->address == b->address;
  return a->address < b->address + ethd__servo_words(b) && b->address < a->address + ethd__servo_words(a);
}

static bool same_words(const ethd__servo_register *a, const ethd__servo_register *b) {
  return a->address == b->address && a->type == b->type && (a->order == b->order || ethd__servo_words(a) == 1);
}

static ethd_status check_overlaps(const ethd__key_file *s, const ethd__servo_map *map) {
  for (uint32_t i = 0; i < map->count; i++)
    for (uint32_t j = 0; j < i; j++) {
      const ethd__servo_register *a = &map->registers[i], *b = &map->registers[j];
      if (!overlap(map, a, b)) continue;
      if (!same_words(a, b))
        return refuse(s, a, "address", "overlaps [register %s] of line %d, which is of another type or place", b->name,
                      b->line);
      if (a->direction == b->direction && a->direction == W)
        return refuse(s, a, "address", "[register %s] of line %d writes there too", b->name, b->line);
    }
  return ETHD_OK;
}

static bool in_steps(const ethd__servo_map *map, uint32_t i) {
  for (int q = 0; q < ETHD__SERVO_SEQUENCES; q++)
    for (uint32_t k = 0; k < map->sequences[q].count; k++)
      if (map->sequences[q].at[k].at == (int32_t)i) return true;
  return false;
}

static bool is_echo(const ethd__servo_map *map, int32_t i) {
  for (uint32_t k = 0; k < map->count; k++)
    if (map->registers[k].echo == i) return true;
  return false;
}

/* The loop needs these values in every exchange. */
static ethd_status check_every(const ethd__key_file *s, const ethd__servo_map *map) {
  for (uint32_t i = 0; i < map->count; i++) {
    const ethd__servo_register *r = &map->registers[i];
    bool may = r->role < 0 || r->role == ETHD__SERVO_MEASURED1 || r->role == ETHD__SERVO_MEASURED2 ||
               r->role == ETHD__SERVO_BUS_VOLTAGE || r->role == ETHD__SERVO_INDEX1 || r->role == ETHD__SERVO_INDEX2;
    if (r->every > 1 && (r->direction != R || !may || is_echo(map, (int32_t)i)))
      return refuse(s, r, "every",
                    "only measured torques, index marks, bus_voltage and masks may be read less often, and no echoes");
  }
  return ETHD_OK;
}

static ethd_status check_use(const ethd__key_file *s, ethd__servo_map *map) {
  for (uint32_t i = 0; i < map->count; i++) {
    ethd__servo_register *r = &map->registers[i];
    r->cyclic |= r->role >= 0 || r->fault_mask || r->enabled_mask;
    if (!r->cyclic && !in_steps(map, i))
      return ethd__say(s->message, ETHD_E_UNKNOWN,
                       "%s:%d: register %s: nothing uses it: it has no known name, no mask, no step and is no echo",
                       s->name, r->line, r->name);
  }
  return ETHD_OK;
}

/* ---- the whole ---- */

static bool both_or_none(const ethd__servo_map *map, int a, int b) {
  return (map->roles[a] < 0) == (map->roles[b] < 0);
}

static bool same_unit(const ethd__servo_map *map) {
  return map->registers[map->roles[ETHD__SERVO_COUNTER]].bus_unit ==
         map->registers[map->roles[ETHD__SERVO_COUNTER2]].bus_unit;
}

/* Read in every exchange. */
static bool is_measured(const ethd__servo_register *r) { return r->cyclic && r->direction == R && r->every == 1; }

static ethd_status check_roles(const ethd__key_file *s, const ethd__servo_map *map) {
  const int32_t *roles = map->roles;
  const char *wrong = NULL;
  if (roles[ETHD__SERVO_TORQUE1] < 0 && roles[ETHD__SERVO_TORQUE2] < 0) wrong = "a torque1 or a torque2 is missing";
  if (!both_or_none(map, ETHD__SERVO_TORQUE1, ETHD__SERVO_POSITION1)) wrong = "torque1 and position1 go together";
  if (!both_or_none(map, ETHD__SERVO_TORQUE2, ETHD__SERVO_POSITION2)) wrong = "torque2 and position2 go together";
  if (!both_or_none(map, ETHD__SERVO_READING_X, ETHD__SERVO_READING_Y) ||
      !both_or_none(map, ETHD__SERVO_READING_X, ETHD__SERVO_READING_COUNT) ||
      (roles[ETHD__SERVO_READING_AGE] >= 0 && roles[ETHD__SERVO_READING_X] < 0))
    wrong = "reading_x, reading_y and reading_count go together";
  for (int i = 0; i < 2; i++)
    if (roles[ETHD__SERVO_INDEX1 + i] >= 0 &&
        (roles[ETHD__SERVO_POSITION1 + i] < 0 ||
         map->registers[roles[ETHD__SERVO_INDEX1 + i]].type != map->registers[roles[ETHD__SERVO_POSITION1 + i]].type))
      wrong = "index1 and index2 are counts of position1 and position2, of the same type";
  if (roles[ETHD__SERVO_COUNTER2] >= 0 && (roles[ETHD__SERVO_COUNTER] < 0 || same_unit(map)))
    wrong = "counter2 is the counter of a second unit, beside counter in the first";
  for (int axis = 0; axis < 2 && !wrong; axis++) {
    if (map->watchdog == ETHD__SERVO_WATCH_COUNTER && !ethd__servo_unit_has(map, axis, is_counter))
      wrong = ethd__servo_several(map) ? "watchdog.kind = counter needs a counter in each unit that has a torque"
                                       : "watchdog.kind = counter needs a [register counter]";
    if (!ethd__servo_unit_has(map, axis, is_measured))
      wrong = "nothing is read in each exchange from a unit that has a torque: it could vanish unseen";
  }
  return wrong ? ethd__say(s->message, ETHD_E_UNKNOWN, "%s: %s", s->name, wrong) : ETHD_OK;
}

ethd_status ethd__servo_map_check(const ethd__key_file *s, ethd__servo_map *map) {
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; i < map->count && !status; i++) status = check_register(s, &map->registers[i]);
  for (uint32_t i = 0; i < map->count && !status; i++) status = link_echo(s, map, &map->registers[i]);
  if (!status) status = check_overlaps(s, map);
  if (!status) status = check_use(s, map);
  if (!status) status = check_every(s, map);
  return status ? status : check_roles(s, map);
}
