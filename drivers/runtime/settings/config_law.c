#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"

ethd_status ethd__config_choose(const ethd_config *config, const ethd__key *key, const ethd__config_front *front,
                                void *setup) {
  const ethd_setup_part *part = front->part_of(key->section);
  char ids[ETHD_MESSAGE_MAX] = "", quote[ETHD_QUOTE_MAX];
  if (front->choose(setup, key->section, key->value, config->laws) == ETHD_OK) return ETHD_OK;
  for (uint32_t i = 0; i < part->count; i++) ethd__list_add(ids, part->methods[i].id);
  for (const ethd_law *const *law = config->laws; !part->methods && *law; law++)
    if ((*law)->kind == part->kind) ethd__list_add(ids, (*law)->id);
  if (part->methods || !key->file) return ethd__key_found(key, ETHD_E_UNKNOWN, ids);
  return ethd__key_refuse(key, ETHD_E_UNKNOWN, "found %s, %s is allowed; %s",
                          ethd__quote(key->value, strlen(key->value), quote), ids,
                          config->plugin_count ? "the files of [plugins] have no other law of this kind"
                                               : "a law of a plugin needs its file too: [plugins] file = NAME.so");
}

/* ---- preset ---- */

static const char *const preset_keys[] = {"eps_max", "t_max"};

static bool is_paper(const ethd_config *config) {
  const ethd_ini_key *preset = ethd_ini_find(&ethd__config_whole(config)->ini, "transition", "preset");
  return preset && strcmp(preset->value, "paper") == 0;
}

static void open_caps(const ethd_law *law, double *p) {
  for (size_t i = 0; i < sizeof preset_keys / sizeof *preset_keys; i++) {
    int row = ethd_params_find(law->params, law->param_count, preset_keys[i]);
    if (row >= 0) p[row] = (double)INFINITY;
  }
}

ethd_status ethd__config_preset(ethd__config *config, const ethd__key *key) {
  ethd_setup *setup = &config->config.setup;
  if (strcmp(key->value, "product") == 0) return ETHD_OK;
  if (strcmp(key->value, "paper") != 0) return ethd__key_found(key, ETHD_E_UNKNOWN, "product or paper");
  open_caps(&setup->transition->law, setup->transition_p);
  setup->v_hysteresis = 0;
  return ETHD_OK;
}

/* ---- a change of law ---- */

static double *values(const void *setup, const ethd_setup_part *part) {
  return (double *)(void *)((char *)setup + part->values);
}

/* Keeps chosen values, from the file or later; the old law's defaults become the new law's. */
static void keep_common(const ethd_config *config, const ethd__config_front *front, const ethd_setup_part *part,
                        const void *from, void *to) {
  const ethd_ini *ini = &ethd__config_whole(config)->ini;
  const ethd_method had = front->chosen(from, part), has = front->chosen(to, part);
  const double *old = values(from, part);
  double *p = values(to, part);
  for (uint32_t i = 0; i < had.param_count; i++) {
    const ethd_param *row = &had.params[i];
    int k = ethd_params_find(has.params, has.param_count, row->name);
    if (k >= 0 && (old[i] != row->def || ethd_ini_find(ini, part->section, row->name))) p[k] = old[i];
  }
}

ethd_status ethd__config_law(const ethd_config *config, const ethd__config_front *front, const char *kind,
                             const char *id, void *setup, char message[ETHD_MESSAGE_MAX]) {
  const ethd_setup_part *part = front->part_of(kind);
  ethd__key key = {NULL, 0, kind, "law", id, message};
  ethd__setup_copy changed;
  ethd_error error;
  if (!part || part->methods)
    return ethd__say(message, ETHD_E_ARGUMENT, "found %.40s, a law of tracking, contact or transition is allowed",
                     kind);
  memcpy(&changed, setup, front->bytes);
  ethd_status status = ethd__config_choose(config, &key, front, &changed);
  if (status) return status;
  if (front == &ethd__front_plane && part->kind == ETHD_TRANSITION && is_paper(config))
    open_caps(&changed.plane.transition->law, changed.plane.transition_p);
  keep_common(config, front, part, setup, &changed);
  status = ethd__config_check(config, front, &changed, &error);
  if (status < 0) {
    ethd_error_text(NULL, &error, message);
    return status;
  }
  memcpy(setup, &changed, front->bytes);
  return ETHD_OK;
}

ethd_status ethd_config_law(const ethd_config *config, const char *kind, const char *id, ethd_setup *setup,
                            char message[ETHD_MESSAGE_MAX]) {
  return ethd__config_law(config, &ethd__front_plane, kind, id, setup, message);
}

ethd_status ethd_config_space_law(const ethd_config *config, const char *kind, const char *id, ethd_space_setup *setup,
                                  char message[ETHD_MESSAGE_MAX]) {
  return ethd__config_law(config, &ethd__front_space, kind, id, setup, message);
}

ethd_status ethd_config_transition(const ethd_config *config, const char *id, ethd_setup *setup,
                                   char message[ETHD_MESSAGE_MAX]) {
  return ethd_config_law(config, "transition", id, setup, message);
}
