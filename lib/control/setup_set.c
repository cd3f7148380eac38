#include <math.h>
#include <stddef.h>

#include "control/setup.h"

#define AT(member) (uint32_t)offsetof(ethd_setup, member)

const ethd_setup_part ethd_setup_parts[ETHD_SETUP_PARTS] = {
    {"velocity", "method", ethd_velocity_methods, ETHD_VELOCITY_COUNT, 0, AT(velocity), AT(velocity_p)},
    {"finger_fit", "method", ethd_fit_methods, ETHD_FIT_COUNT, 0, AT(fit), AT(fit_p)},
    {"finger_filter", "method", ethd_filter_methods, ETHD_FILTER_COUNT, 0, AT(filter), AT(filter_p)},
    {"tracking", "law", NULL, 0, ETHD_TRACKING, AT(tracking), AT(tracking_p)},
    {"contact", "law", NULL, 0, ETHD_CONTACT, AT(contact), AT(contact_p)},
    {"transition", "law", NULL, 0, ETHD_TRANSITION, AT(transition), AT(transition_p)},
};

static ethd__setup_field field_of_limit(const ethd_limit *limit) {
  return (ethd__setup_field){
      {"limits", {limit->name, limit->unit, limit->min, limit->max, (double)NAN, limit->brief}, limit->count},
      AT(limits) + limit->offset};
}

static ethd__setup_field field_at(uint32_t index) {
  return index < ETHD__SETUP_FIELDS ? ethd__setup_fields[index]
                                    : field_of_limit(&ethd_limit_rows[index - ETHD__SETUP_FIELDS]);
}

static const ethd__named named = {ethd_setup_parts, ETHD_SETUP_PARTS,      ETHD__SETUP_FIELDS + ETHD_LIMITS,
                                  field_at,         ethd__setup_field_get, ethd__setup_field_set,
                                  ethd__setup_made};

const ethd_setup_part *ethd_setup_part_of(const char *section) { return ethd__named_part_of(&named, section); }

ethd_method ethd_setup_chosen(const ethd_setup *setup, const ethd_setup_part *part) {
  return ethd__named_chosen(&named, setup, part);
}

ethd_status ethd_setup_choose(ethd_setup *setup, const char *section, const char *id, const ethd_law *const *laws,
                              ethd_error *error) {
  return ethd__named_choose(&named, setup, section, id, laws, error);
}

ethd_status ethd_setup_key_at(const ethd_setup *setup, uint32_t index, ethd_setup_key *out) {
  return ethd__named_key_at(&named, setup, index, out);
}

ethd_status ethd_setup_set(ethd_setup *setup, const char *name, double value, ethd_error *error) {
  return ethd__named_set(&named, setup, name, value, error);
}

double ethd_setup_get(const ethd_setup *setup, const char *name) { return ethd__named_get(&named, setup, name); }
