#include <math.h>
#include <stdio.h>
#include <string.h>

#include "settings/config_parts.h"
#include "text/error_text.h"

static const char *const kinds[] = {"tracking", "contact", "transition"};

static const ethd_law *find_law(const ethd_config *config, uint32_t kind, const char *id) {
  for (const ethd_law *const *law = config->laws; *law; law++)
    if ((*law)->kind == kind && strcmp((*law)->id, id) == 0) return *law;
  return NULL;
}

static void list_laws(const ethd_config *config, uint32_t kind, char list[ETHD_MESSAGE_MAX]) {
  size_t n = 0;
  list[0] = 0;
  for (const ethd_law *const *law = config->laws; *law; law++)
    if ((*law)->kind == kind && n < ETHD_MESSAGE_MAX)
      n += (size_t)snprintf(list + n, ETHD_MESSAGE_MAX - n, "%s%s", n ? ", " : "", (*law)->id);
}

static ethd_status choose_law(const ethd_config *config, uint32_t kind, const ethd__key *key, ethd_setup *setup) {
  char list[ETHD_MESSAGE_MAX];
  const ethd_law *law = find_law(config, kind, key->value);
  if (!law) {
    list_laws(config, kind, list);
    return ethd__key_found(key, ETHD_E_UNKNOWN, list);
  }
  if (kind == ETHD_TRACKING)
    ethd_setup_tracking(setup, (const ethd_tracking_law *)law);
  else if (kind == ETHD_CONTACT)
    ethd_setup_contact(setup, (const ethd_contact_law *)law);
  else
    ethd_setup_transition(setup, (const ethd_transition_law *)law);
  return ETHD_OK;
}

/* Index of the method, or -1 and the refusal. */
static int find_method(const ethd_method *methods, int count, const ethd__key *key, ethd_status *status) {
  char list[ETHD_MESSAGE_MAX] = "";
  size_t n = 0;
  for (int i = 0; i < count; i++) {
    if (strcmp(methods[i].id, key->value) == 0) return i;
    n += (size_t)snprintf(list + n, sizeof list - n, "%s%s", i ? ", " : "", methods[i].id);
  }
  *status = ethd__key_found(key, ETHD_E_UNKNOWN, list);
  return -1;
}

static ethd_status choose_method(const ethd__key *key, ethd_setup *setup) {
  ethd_status status = ETHD_OK;
  int i;
  if (strcmp(key->section, "velocity") == 0) {
    i = find_method(ethd_velocity_methods, ETHD_VELOCITY_COUNT, key, &status);
    if (i >= 0) ethd_setup_velocity(setup, (ethd_velocity_method)i);
  } else if (strcmp(key->section, "finger_fit") == 0) {
    i = find_method(ethd_fit_methods, ETHD_FIT_COUNT, key, &status);
    if (i >= 0) ethd_setup_fit(setup, (ethd_fit_method)i);
  } else {
    i = find_method(ethd_filter_methods, ETHD_FILTER_COUNT, key, &status);
    if (i >= 0) ethd_setup_filter(setup, (ethd_filter_method)i);
  }
  return status;
}

ethd_status ethd__config_choose(const ethd_config *config, const ethd__key *key, ethd_setup *setup) {
  for (uint32_t kind = 0; kind < 3; kind++)
    if (strcmp(kinds[kind], key->section) == 0) return choose_law(config, kind, key, setup);
  return choose_method(key, setup);
}

/* ---- preset ---- */

static const char *const preset_keys[] = {"eps_max", "t_max"};

static int is_paper(const ethd_config *config) {
  const ethd_ini_key *preset = ethd_ini_find(&ethd__config_whole(config)->ini, "transition", "preset");
  return preset && strcmp(preset->value, "paper") == 0;
}

static void open_caps(const ethd_law *law, double *p) {
  for (size_t i = 0; i < sizeof preset_keys / sizeof *preset_keys; i++) {
    int row = ethd_params_find(law->params, law->param_count, preset_keys[i]);
    if (row >= 0) p[row] = (double)INFINITY;
  }
}

ethd_status ethd__config_preset(const ethd__key *key, ethd_setup *setup) {
  if (strcmp(key->value, "product") == 0) return ETHD_OK;
  if (strcmp(key->value, "paper") != 0) return ethd__key_found(key, ETHD_E_UNKNOWN, "product or paper");
  open_caps(&setup->transition->law, setup->transition_p);
  setup->v_hysteresis = 0;
  return ETHD_OK;
}

/* ---- a change of law ---- */

/* Values that were chosen, in the file or since, are kept; those that were the old law's defaults become
   the new law's. */
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
  ethd__key key = {NULL, 0, "transition", "law", id, message};
  ethd_setup changed = *setup;
  ethd_error error;
  const ethd_law *from = &setup->transition->law;
  ethd_status status = choose_law(config, ETHD_TRANSITION, &key, &changed);
  if (status) return status;
  const ethd_law *to = &changed.transition->law;
  if (is_paper(config)) open_caps(to, changed.transition_p);
  keep_common(config, from, setup->transition_p, to, changed.transition_p);
  status = ethd_setup_check(&changed, &error);
  if (status < 0) {
    ethd_error_text(NULL, &error, message);
    return status;
  }
  *setup = changed;
  return ETHD_OK;
}

static int stands_in_files_only(const char *section, const char *key) {
  const char *chooser = ethd__config_chooser(section);
  return strcmp(section, "device") == 0 || strcmp(section, "plugins") == 0 || strcmp(section, "scene") == 0 ||
         (chooser && strcmp(chooser, key) == 0) || strcmp(key, "preset") == 0 ||
         (strcmp(section, "arm") == 0 && strncmp(key, "mass_", 5) == 0);
}

ethd_status ethd_config_set(const ethd_config *config, const char *name, const char *value, ethd_setup *setup,
                            char message[ETHD_MESSAGE_MAX]) {
  char section[64], quote[ETHD_QUOTE_MAX];
  ethd_error error;
  (void)config;
  const char *dot = strchr(name, '.');
  if (!dot || (size_t)(dot - name) >= sizeof section)
    return ethd__say(message, ETHD_E_SYNTAX, "found %s, section.key is allowed",
                     ethd__quote(name, strlen(name), quote));
  memcpy(section, name, (size_t)(dot - name));
  section[dot - name] = 0;
  ethd__key key = {NULL, 0, section, dot + 1, value, message};
  if (stands_in_files_only(section, key.key))
    return ethd__key_refuse(&key, ETHD_E_ARGUMENT, "can't be set, it stands in the file only");
  ethd_setup changed = *setup;
  ethd_status status = ethd__config_apply(&key, &changed);
  if (status) return status;
  status = ethd_setup_check(&changed, &error);
  if (status < 0) {
    ethd_error_text(NULL, &error, message);
    return status;
  }
  *setup = changed;
  return ETHD_OK;
}
