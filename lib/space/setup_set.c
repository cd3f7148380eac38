#include <math.h>
#include <stddef.h>

#include "core/named.h"
#include "space/plan.h"

#define AT(member) (uint32_t)offsetof(ethd_space_setup, member)

_Static_assert(sizeof(ethd_space_kind) == sizeof(int32_t), "a word is copied as a number");
_Static_assert(sizeof(ethd_effector) == sizeof(int32_t), "a word is copied as a number");

const ethd_setup_part ethd_space_parts[ETHD_SPACE_PARTS] = {
    {"finger_filter", "method", ethd_filter_methods, ETHD_FILTER_COUNT, 0, AT(filter), AT(filter_p)},
    {"tracking", "law", NULL, 0, ETHD_TRACKING, AT(tracking), AT(tracking_p)},
    {"contact", "law", NULL, 0, ETHD_CONTACT, AT(contact), AT(contact_p)},
    {"transition", "law", NULL, 0, ETHD_TRANSITION, AT(transition), AT(transition_p)},
};

/* ---- its own numbers: those of ETHD_SPACE_NUMBERS, then these ---- */

static const ethd__setup_field others[] = {
    {{"space",
      {"command", "force|velocity", 0, 1, ETHD_SPACE_VELOCITY, "what the device takes; it can't change while it runs"},
      1},
     AT(kind)},
    {{"space", {"effector", "ring|cap|plate", 0, 2, ETHD_EFFECTOR_RING, "what meets the finger"}, 1}, AT(effector)},
    {{"ability",
      {"speed", "m/s", 0, (double)INFINITY, (double)NAN, "highest speed of the device; not given: not known"},
      1},
     AT(ability.speed)},
    {{"ability", {"acceleration", "m/s2", 0, (double)INFINITY, (double)NAN, "largest acceleration of the device"}, 1},
     AT(ability.acceleration)},
    {{"ability", {"delay", "s", 0, (double)INFINITY, (double)NAN, "time from a command to its motion"}, 1},
     AT(ability.delay)},
    {{"ability", {"mass", "kg", 0, (double)INFINITY, (double)NAN, "effective mass of the effector"}, 1},
     AT(ability.mass)},
    {{"ability", {"force", "N", 0, (double)INFINITY, (double)NAN, "that the device reaches"}, 1}, AT(ability.force)},
    {{"ability", {"friction", "N", 0, (double)INFINITY, (double)NAN, "Coulomb friction at the effector"}, 1},
     AT(ability.friction)},
};
#define OTHERS (uint32_t)(sizeof others / sizeof *others)

static ethd__setup_field field_at(uint32_t index) {
  if (index >= ETHD_SPACE_NUMBER_COUNT) return others[index - ETHD_SPACE_NUMBER_COUNT];
  return (ethd__setup_field){{"space", ethd_space_numbers[index], 1}, AT(period) + index * (uint32_t)sizeof(double)};
}

static bool is_word(const ethd__setup_field *field) {
  return field->offset == AT(kind) || field->offset == AT(effector);
}

static double get(const void *setup, const ethd__setup_field *field, uint32_t index) {
  const char *at = (const char *)setup + field->offset;
  return is_word(field) ? *(const int32_t *)(const void *)at : ((const double *)(const void *)at)[index];
}

static void set(void *setup, const ethd__setup_field *field, uint32_t index, double value) {
  char *at = (char *)setup + field->offset;
  if (is_word(field))
    *(int32_t *)(void *)at = (int32_t)value;
  else
    ((double *)(void *)at)[index] = value;
}

static const ethd__named named = {
    ethd_space_parts, ETHD_SPACE_PARTS, ETHD_SPACE_NUMBER_COUNT + OTHERS, field_at, get, set, ethd__space_setup_made};

/* ---- by names ---- */

const ethd_setup_part *ethd_space_part_of(const char *section) { return ethd__named_part_of(&named, section); }

ethd_method ethd_space_chosen(const ethd_space_setup *setup, const ethd_setup_part *part) {
  return ethd__named_chosen(&named, setup, part);
}

ethd_status ethd_space_choose(ethd_space_setup *setup, const char *section, const char *id, const ethd_law *const *laws,
                              ethd_error *error) {
  return ethd__named_choose(&named, setup, section, id, laws, error);
}

ethd_status ethd_space_key_at(const ethd_space_setup *setup, uint32_t index, ethd_setup_key *out) {
  return ethd__named_key_at(&named, setup, index, out);
}

ethd_status ethd_space_set(ethd_space_setup *setup, const char *name, double value, ethd_error *error) {
  return ethd__named_set(&named, setup, name, value, error);
}

double ethd_space_get(const ethd_space_setup *setup, const char *name) { return ethd__named_get(&named, setup, name); }
