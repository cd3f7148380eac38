#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"

static void list(char out[ETHD_MESSAGE_MAX], const char *id) {
  size_t n = strlen(out);
  snprintf(out + n, ETHD_MESSAGE_MAX - n, "%s%s", n ? ", " : "", id);
}

ethd_status ethd__config_choose(const ethd_config *config, const ethd__config_key *key, ethd_setup *setup) {
  const ethd_setup_part *part = ethd_setup_part_of(key->section);
  char ids[ETHD_MESSAGE_MAX] = "", quote[ETHD_QUOTE_MAX];
  if (ethd_setup_choose(setup, key->section, key->value, config->laws, NULL) == ETHD_OK) return ETHD_OK;
  for (uint32_t i = 0; i < part->count; i++) list(ids, part->methods[i].id);
  for (const ethd_law *const *law = config->laws; !part->methods && *law; law++)
    if ((*law)->kind == part->kind) list(ids, (*law)->id);
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

ethd_status ethd__config_preset(ethd__config *config, const ethd__config_key *key) {
  ethd_setup *setup = &config->config.setup;
  if (strcmp(key->value, "product") == 0) return ETHD_OK;
  if (strcmp(key->value, "paper") != 0) return ethd__key_found(key, ETHD_E_UNKNOWN, "product or paper");
  open_caps(&setup->transition->law, setup->transition_p);
  setup->v_hysteresis = 0;
  return ETHD_OK;
}

/* ---- a change of law ---- */

/* Keeps values that were chosen, in the file or later; values that were the old law's defaults become the new law's. */
static void keep_common(const ethd_config *config, const ethd_law *from, const double *old, const ethd_law *to,
                        double *p) {
  const ethd_ini *ini = &ethd__config_whole(config)->ini;
  for (uint32_t i = 0; i < from->param_count; i++) {
    const ethd_param *row = &from->params[i];
    int k = ethd_params_find(to->params, to->param_count, row->name);
    if (k >= 0 && (old[i] != row->def || ethd_ini_find(ini, "transition", row->name))) p[k] = old[i];
  }
}

ethd_status ethd_config_transition(const ethd_config *config, const char *id, ethd_setup *setup,
                                   char message[ETHD_MESSAGE_MAX]) {
  ethd__config_key key = {NULL, 0, "transition", "law", id, message};
  ethd_setup changed = *setup;
  ethd_error error;
  const ethd_law *from = &setup->transition->law;
  ethd_status status = ethd__config_choose(config, &key, &changed);
  if (status) return status;
  const ethd_law *to = &changed.transition->law;
  if (is_paper(config)) open_caps(to, changed.transition_p);
  keep_common(config, from, setup->transition_p, to, changed.transition_p);
  status = ethd__config_check(config, &changed, &error);
  if (status < 0) {
    ethd_error_text(NULL, &error, message);
    return status;
  }
  *setup = changed;
  return ETHD_OK;
}
