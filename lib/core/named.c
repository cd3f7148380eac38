#include "core/named.h"

#include <math.h>
#include <string.h>

#include "error.h"
#include "fp_mode.h"

_Static_assert(sizeof(ethd_velocity_method) == sizeof(unsigned), "a method is copied as a number");
_Static_assert(sizeof(ethd_fit_method) == sizeof(unsigned), "a method is copied as a number");
_Static_assert(sizeof(ethd_filter_method) == sizeof(unsigned), "a method is copied as a number");

/* ---- choices ---- */

void ethd__setup_values(const ethd_param *params, uint32_t count, double p[ETHD_PARAMS_MAX]) {
  memset(p, 0, ETHD_PARAMS_MAX * sizeof *p);
  ethd_params_default(params, ethd__setup_room(params, count), p);
}

const ethd_setup_part *ethd__named_part_of(const ethd__named *named, const char *section) {
  for (uint32_t i = 0; i < named->part_count; i++)
    if (strcmp(named->parts[i].section, section) == 0) return &named->parts[i];
  return NULL;
}

/* Describes a law in the terms of a method. */
static ethd_method described(const ethd_law *law) {
  if (!law) return (ethd_method){0};
  return (ethd_method){law->id, law->brief, law->params, ethd__setup_room(law->params, law->param_count)};
}

ethd_method ethd__named_chosen(const ethd__named *named, const void *setup, const ethd_setup_part *part) {
  const char *chosen = (const char *)setup + part->chosen;
  const ethd_law *law;
  unsigned method;
  if (named->made(setup, NULL) < 0) return (ethd_method){0};
  if (part->methods) {
    memcpy(&method, chosen, sizeof method);
    return method < part->count ? part->methods[method] : (ethd_method){0};
  }
  memcpy(&law, chosen, sizeof law); /* the first member of every law's struct */
  return described(law);
}

static void choose(const ethd__named *named, void *setup, const ethd_setup_part *part, const void *chosen,
                   size_t size) {
  double *values = (double *)(void *)((char *)setup + part->values);
  memcpy((char *)setup + part->chosen, chosen, size);
  ethd_method method = ethd__named_chosen(named, setup, part);
  ethd__setup_values(method.params, method.param_count, values);
}

ethd_status ethd__named_choose(const ethd__named *named, void *setup, const char *section, const char *id,
                               const ethd_law *const *laws, ethd_error *error) {
  const ethd_setup_part *part = ethd__named_part_of(named, section);
  ethd_status status = named->made(setup, error);
  if (status < 0) return status;
  if (!part) return ethd__error(error, ETHD_E_UNKNOWN, section);
  for (unsigned i = 0; i < part->count; i++)
    if (strcmp(part->methods[i].id, id) == 0) return choose(named, setup, part, &i, sizeof i), ETHD_OK;
  for (; !part->methods && *laws; laws++)
    if ((*laws)->kind == part->kind && strcmp((*laws)->id, id) == 0)
      return choose(named, setup, part, laws, sizeof *laws), ETHD_OK;
  return ethd__error(error, ETHD_E_UNKNOWN, id);
}

/* ---- numbers ---- */

/* Finds the `index`-th number of a setup: the front's own, then parameters of the chosen parts. */
static bool find_at(const ethd__named *named, const void *setup, uint32_t index, ethd__setup_field *out) {
  if (index < named->field_count) return *out = named->field_at(index), true;
  index -= named->field_count;
  for (const ethd_setup_part *part = named->parts; part < named->parts + named->part_count; part++) {
    ethd_method method = ethd__named_chosen(named, setup, part);
    if (index < method.param_count) {
      *out = (ethd__setup_field){{part->section, method.params[index], 1},
                                 part->values + index * (uint32_t)sizeof(double)};
      return true;
    }
    index -= method.param_count;
  }
  return false;
}

ethd_status ethd__named_key_at(const ethd__named *named, const void *setup, uint32_t index, ethd_setup_key *out) {
  ethd__setup_field field;
  if (!find_at(named, setup, index, &field)) return ETHD_STATUS_EMPTY;
  *out = field.key;
  return ETHD_OK;
}

/* Returns the rest of a name after "section.key", NULL if the name is another key's. */
static const char *after(const ethd_setup_key *key, const char *name) {
  size_t section = strlen(key->section), own = strlen(key->param.name);
  if (strncmp(name, key->section, section) != 0 || name[section] != '.') return NULL;
  if (strncmp(name + section + 1, key->param.name, own) != 0) return NULL;
  name += section + 1 + own;
  return *name == 0 || *name == '[' ? name : NULL;
}

/* Returns 2 for "[2]"; for a text that isn't an index ETHD_RAYS, an index that no key has. */
static uint32_t index_of(const char *text) {
  uint32_t index = 0;
  const char *at = text + 1;
  for (; *at >= '0' && *at <= '9' && index < ETHD_RAYS; at++) index = 10 * index + (uint32_t)(*at - '0');
  return at > text + 1 && at[0] == ']' && !at[1] ? index : ETHD_RAYS;
}

static ethd_status find(const ethd__named *named, const void *setup, const char *name, ethd__setup_field *out,
                        uint32_t *index, ethd_error *error) {
  const char *rest = NULL;
  ethd_status status = named->made(setup, error);
  if (status < 0) return status;
  for (uint32_t i = 0; !rest && find_at(named, setup, i, out); i++) rest = after(&out->key, name);
  if (!rest) return ethd__error(error, ETHD_E_UNKNOWN, name);
  if (!*rest && out->key.count > 1)
    return ethd__refuse(error, ETHD_E_ARGUMENT, name, (ethd__found){(double)NAN, 0, out->key.count - 1});
  *index = *rest ? index_of(rest) : 0;
  if (*index >= out->key.count || (*rest && out->key.count == 1))
    return ethd__refuse(error, ETHD_E_RANGE, name, (ethd__found){(double)NAN, 0, out->key.count - 1});
  return ETHD_OK;
}

ETHD__FP_APART static ethd_status set(const ethd__named *named, void *setup, const char *name, double value,
                                      ethd_error *error) {
  ethd__setup_field field;
  uint32_t index;
  ethd_status status = find(named, setup, name, &field, &index, error);
  if (status < 0) return status;
  status = ethd_params_check(&field.key.param, 1, &value, error);
  if (status < 0) return ethd__error_prefix(error, field.key.section), status;
  named->set(setup, &field, index, value);
  return ETHD_OK;
}

ethd_status ethd__named_set(const ethd__named *named, void *setup, const char *name, double value, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, set(named, setup, name, value, error));
}

double ethd__named_get(const ethd__named *named, const void *setup, const char *name) {
  ethd__setup_field field;
  uint32_t index;
  return find(named, setup, name, &field, &index, NULL) < 0 ? (double)NAN : named->get(setup, &field, index);
}
