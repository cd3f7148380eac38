#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- refusals ---- */

ethd_status ethd__key_refuse(const ethd__key *key, ethd_status status, const char *format, ...) {
  char what[ETHD_MESSAGE_MAX];
  va_list args;
  va_start(args, format);
  vsnprintf(what, sizeof what, format, args);
  va_end(args);
  if (!key->file) return ethd__say(key->message, status, "%s.%s: %s", key->section, key->key, what);
  return ethd__say(key->message, status, "%s:%d: %s.%s: %s", key->file, key->line, key->section, key->key, what);
}

ethd_status ethd__key_found(const ethd__key *key, ethd_status status, const char *allowed) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__key_refuse(key, status, "found %s, %s is allowed", ethd__quote(key->value, strlen(key->value), quote),
                          allowed);
}

/* ---- keys that stand in the setup itself ---- */

typedef enum kind { NUMBER, MECHANISM, LAGS } kind;

typedef struct field {
  const char *section, *key;
  kind kind;
  size_t offset;
} field;

#define AT(member) offsetof(ethd_setup, member)

static const field fields[] = {
    {"arm", "mechanism", MECHANISM, AT(arm.mechanism)},
    {"arm", "link1", NUMBER, AT(arm.link1)},
    {"arm", "link2", NUMBER, AT(arm.link2)},
    {"ring", "radius", NUMBER, AT(ring_radius)},
    {"finger", "radius", NUMBER, AT(finger_radius)},
    {"finger", "radius_max", NUMBER, AT(finger_radius_max)},
    {"finger_fit", "lag", LAGS, AT(ray_lag)},
    {"loop", "period", NUMBER, AT(period)},
    {"transition", "swap_time", NUMBER, AT(swap_time)},
    {"transition", "v_hysteresis", NUMBER, AT(v_hysteresis)},
};

#define FIELD_COUNT (sizeof fields / sizeof *fields)

static ethd_status read_number(const ethd__key *key, double *out) {
  double value;
  if (!ethd__number(key->value, strlen(key->value), &value) || isnan(value))
    return ethd__key_found(key, ETHD_E_SYNTAX, "a decimal number");
  *out = value;
  return ETHD_OK;
}

/* `count` numbers, at most ETHD_RAYS. */
static ethd_status read_numbers(const ethd__key *key, uint32_t count, const char *allowed, double *out) {
  const char *p = key->value;
  double w[ETHD_RAYS];
  for (uint32_t i = 0; i < count; i++) {
    size_t n = strcspn(p += strspn(p, " \t"), " \t");
    if (!ethd__number(p, n, &w[i]) || isnan(w[i])) return ethd__key_found(key, ETHD_E_SYNTAX, allowed);
    p += n;
  }
  if (p[strspn(p, " \t")]) return ethd__key_found(key, ETHD_E_SYNTAX, allowed);
  memcpy(out, w, count * sizeof *w);
  return ETHD_OK;
}

static ethd_status read_limit(const ethd_limit *limit, const ethd__key *key, ethd_limits *limits) {
  double *out = ethd_limit_of(limits, limit);
  return limit->count == 1 ? read_number(key, out) : read_numbers(key, limit->count, limit->brief, out);
}

int ethd__config_limit(const char *section, const char *key) {
  for (int i = 0; strcmp(section, "limits") == 0 && i < ETHD_LIMITS; i++)
    if (strcmp(ethd_limit_rows[i].name, key) == 0) return i;
  return -1;
}

static ethd_status read_mechanism(const ethd__key *key, ethd_mechanism *out) {
  if (strcmp(key->value, "parallel") == 0)
    *out = ETHD_ARM_PARALLEL;
  else if (strcmp(key->value, "serial") == 0)
    *out = ETHD_ARM_SERIAL;
  else
    return ethd__key_found(key, ETHD_E_UNKNOWN, "parallel or serial");
  return ETHD_OK;
}

static ethd_status read_field(const field *f, const ethd__key *key, ethd_setup *setup) {
  void *at = (char *)setup + f->offset;
  switch (f->kind) {
  case LAGS: return read_numbers(key, ETHD_RAYS, "a time in s for each of the 16 rays", at);
  case MECHANISM: return read_mechanism(key, at);
  default: return read_number(key, at);
  }
}

/* ---- parameters of laws and methods ---- */

static const struct {
  const char *section, *chooser;
} choosers[] = {{"velocity", "method"}, {"finger_fit", "method"}, {"finger_filter", "method"},
                {"tracking", "law"},    {"contact", "law"},       {"transition", "law"}};

const char *ethd__config_chooser(const char *section) {
  for (size_t i = 0; i < sizeof choosers / sizeof *choosers; i++)
    if (strcmp(choosers[i].section, section) == 0) return choosers[i].chooser;
  return NULL;
}

static ethd__section of_method(const ethd_method *method, double *values) {
  return (ethd__section){method->id, method->params, method->param_count, values};
}

static ethd__section of_law(const ethd_law *law, double *values) {
  return (ethd__section){law->id, law->params, law->param_count, values};
}

int ethd__config_section(ethd_setup *s, const char *section, ethd__section *out) {
  if (strcmp(section, "velocity") == 0)
    *out = of_method(&ethd_velocity_methods[s->velocity], s->velocity_p);
  else if (strcmp(section, "finger_fit") == 0)
    *out = of_method(&ethd_fit_methods[s->fit], s->fit_p);
  else if (strcmp(section, "finger_filter") == 0)
    *out = of_method(&ethd_filter_methods[s->filter], s->filter_p);
  else if (strcmp(section, "tracking") == 0)
    *out = of_law(&s->tracking->law, s->tracking_p);
  else if (strcmp(section, "contact") == 0)
    *out = of_law(&s->contact->law, s->contact_p);
  else if (strcmp(section, "transition") == 0)
    *out = of_law(&s->transition->law, s->transition_p);
  else
    return 0;
  return 1;
}

static ethd_status read_word(const ethd_param *row, const ethd__key *key, double *out) {
  int word = ethd_param_word(row, key->value);
  if (word < 0) return ethd__key_found(key, ETHD_E_UNKNOWN, row->unit);
  *out = word;
  return ETHD_OK;
}

static ethd_status read_param(const ethd_param *row, const ethd__key *key, double *out) {
  double value = 0;
  if (ethd_param_words(row)) return read_word(row, key, out);
  ethd_status status = read_number(key, &value);
  if (status) return status;
  if (!(value >= row->min && value <= row->max))
    return ethd__key_refuse(key, ETHD_E_RANGE, "found %.10g, %.10g to %.10g %s is allowed", value, row->min, row->max,
                            row->unit);
  *out = value;
  return ETHD_OK;
}

/* ---- any key ---- */

ethd_status ethd__config_apply(const ethd__key *key, ethd_setup *setup) {
  ethd__section own;
  for (size_t i = 0; i < FIELD_COUNT; i++)
    if (strcmp(fields[i].section, key->section) == 0 && strcmp(fields[i].key, key->key) == 0)
      return read_field(&fields[i], key, setup);
  int limit = ethd__config_limit(key->section, key->key);
  if (limit >= 0) return read_limit(&ethd_limit_rows[limit], key, &setup->limits);
  if (ethd__config_section(setup, key->section, &own)) {
    int i = ethd_params_find(own.params, own.count, key->key);
    if (i >= 0) return read_param(&own.params[i], key, &own.values[i]);
  }
  return ethd__config_unknown(key, setup);
}

/* Keys that the files of a configuration take care of before they come here. */
static const char *const file_keys[][2] = {{"arm", "mass_x"}, {"arm", "mass_y"},    {"transition", "preset"},
                                           {"scene", "file"}, {"device", "driver"}, {"plugins", "file"}};

static void add(char list[ETHD_MESSAGE_MAX], const char *word) {
  size_t n = strlen(list);
  snprintf(list + n, ETHD_MESSAGE_MAX - n, "%s%s", n ? ", " : "", word);
}

static void list_keys(const char *section, const ethd__section *own, char list[ETHD_MESSAGE_MAX]) {
  if (ethd__config_chooser(section)) add(list, ethd__config_chooser(section));
  for (size_t i = 0; i < sizeof file_keys / sizeof *file_keys; i++)
    if (strcmp(file_keys[i][0], section) == 0) add(list, file_keys[i][1]);
  for (size_t i = 0; i < FIELD_COUNT; i++)
    if (strcmp(fields[i].section, section) == 0) add(list, fields[i].key);
  for (int i = 0; strcmp(section, "limits") == 0 && i < ETHD_LIMITS; i++) add(list, ethd_limit_rows[i].name);
  for (uint32_t i = 0; i < own->count; i++) add(list, own->params[i].name);
}

static const char sections[] = "unknown section; arm, ring, finger, loop, velocity, finger_fit, finger_filter, "
                               "tracking, contact, transition, scene, limits, device, plugins are allowed";

ethd_status ethd__config_section_known(const ethd_ini_section *section, const char *file, ethd_setup *setup,
                                       char message[ETHD_MESSAGE_MAX]) {
  char list[ETHD_MESSAGE_MAX] = "";
  ethd__section own = {0};
  (void)ethd__config_section(setup, section->name, &own);
  list_keys(section->name, &own, list);
  if (list[0]) return ETHD_OK;
  return ethd__say(message, ETHD_E_UNKNOWN, "%s:%d: [%s]: %s", file, section->line, section->name, sections);
}

ethd_status ethd__config_unknown(const ethd__key *key, ethd_setup *setup) {
  char list[ETHD_MESSAGE_MAX] = "";
  ethd__section own = {0};
  int has_law = ethd__config_section(setup, key->section, &own);
  list_keys(key->section, &own, list);
  if (!list[0]) return ethd__key_refuse(key, ETHD_E_UNKNOWN, "%s", sections);
  if (has_law) return ethd__key_refuse(key, ETHD_E_UNKNOWN, "not a key of %s, which has %s", own.id, list);
  return ethd__key_refuse(key, ETHD_E_UNKNOWN, "unknown key; %s are allowed", list);
}
