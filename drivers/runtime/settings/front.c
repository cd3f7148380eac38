#include "settings/front.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The functions of a front: those of control.h or space.h behind a `void *`. */
#define FRONT(front, type)                                                                                           \
  static ethd_method front##_chosen(const void *setup, const ethd_setup_part *part) {                                \
    return type##_chosen(setup, part);                                                                               \
  }                                                                                                                  \
  static ethd_status front##_choose(void *setup, const char *section, const char *id, const ethd_law *const *laws) { \
    return type##_choose(setup, section, id, laws, NULL);                                                            \
  }                                                                                                                  \
  static ethd_status front##_key_at(const void *setup, uint32_t index, ethd_setup_key *out) {                        \
    return type##_key_at(setup, index, out);                                                                         \
  }                                                                                                                  \
  static ethd_status front##_set(void *setup, const char *name, double value) {                                      \
    return type##_set(setup, name, value, NULL);                                                                     \
  }                                                                                                                  \
  static double front##_get(const void *setup, const char *name) { return type##_get(setup, name); }

FRONT(plane, ethd_setup)
FRONT(space, ethd_space)

static ethd_status plane_check(const ethd_config *config, void *setup, ethd_error *error) {
  (void)config;
  return ethd_setup_check(setup, error);
}

const ethd__config_front ethd__front_plane = {ETHD__PLANE,  sizeof(ethd_setup), ethd_setup_part_of,
                                              plane_chosen, plane_choose,       plane_key_at,
                                              plane_set,    plane_get,          plane_check};

/* Refuses value i of a material; `row`: what is allowed, NULL: the law has no such parameter. */
static ethd_status refuse(const ethd_material *m, uint32_t i, ethd_status status, const ethd_param *row,
                          ethd_error *error) {
  const double nan = (double)NAN;
  *error =
      (ethd_error){status, m->line, "", row ? m->values[i].value : nan, row ? row->min : nan, row ? row->max : nan};
  snprintf(error->name, sizeof error->name, "material.%s.%s", m->name, m->values[i].name);
  return status;
}

/* Makes the contact law's parameters for one material: the setup's, replaced by those that the material gives. */
static ethd_status take_material(const ethd_law *law, const ethd_material *m, double *p, ethd_error *error) {
  for (uint32_t i = 0; i < m->count; i++) {
    int k = ethd_params_find(law->params, law->param_count, m->values[i].name);
    if (k < 0) return refuse(m, i, ETHD_E_UNKNOWN, NULL, error);
    ethd_status status = ethd_params_check(&law->params[k], 1, &m->values[i].value, NULL);
    if (status < 0) return refuse(m, i, status, &law->params[k], error);
    p[k] = m->values[i].value;
  }
  return ETHD_OK;
}

/* Names a number as in a configuration. */
static ethd_status check_numbers(const ethd_space_setup *s, ethd_error *error) {
  char name[sizeof error->name];
  const ethd_status status = ethd_space_check(s, error);
  if (status >= 0 || ethd_params_find(ethd_space_numbers, ETHD_SPACE_NUMBER_COUNT, error->name) < 0) return status;
  snprintf(name, sizeof name, "space.%.40s", error->name);
  memcpy(error->name, name, sizeof name);
  return status;
}

static ethd_status space_check(const ethd_config *config, void *setup, ethd_error *error) {
  ethd_space_setup *s = setup;
  const ethd_material *m;
  s->materials = 0;
  ethd_status status = check_numbers(s, error);
  for (size_t i = 0; status >= 0 && config->solids && (m = ethd_solids_material(config->solids, i)); i++) {
    memcpy(s->material_p[i], s->contact_p, sizeof s->contact_p);
    status = take_material(&s->contact->law, m, s->material_p[i], error);
    s->materials = (uint32_t)i + 1;
  }
  if (status < 0 || !s->materials) return status;
  return ethd_space_check(s, error);
}

const ethd__config_front ethd__front_space = {ETHD__SPACE,        sizeof(ethd_space_setup),
                                              ethd_space_part_of, space_chosen,
                                              space_choose,       space_key_at,
                                              space_set,          space_get,
                                              space_check};
