#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/report.h"
#include "settings/config_parts.h"
#include "text/text.h"

static void word(const char *key, const char *value, const char *brief) {
  printf("%-13s = %-12s ; %s\n", key, value, brief);
}

/* Writes the fewest digits that give the same number again. */
static void exact(double value, char out[32]) {
  for (int digits = 6; digits <= 17; digits++) {
    snprintf(out, 32, "%.*g", digits, value);
    if (strtod(out, NULL) == value) return;
  }
}

static void number(const char *key, double value, const char *unit, const char *brief) {
  char text[32];
  exact(value, text);
  printf("%-13s = %-12s ; %s%s%s\n", key, text, unit, brief[0] ? ", " : "", brief);
}

static void choice(const ethd_param *row, double value) {
  const char *at = row->unit;
  for (int i = 0; i < (int)value; i++) at += strcspn(at, "|") + 1;
  printf("%-13s = %-12.*s ; %s\n", row->name, (int)strcspn(at, "|"), at, row->brief);
}

/* Prints several numbers under one key, unless all of them have their default. */
static void numbers(const ethd__config_front *front, const void *setup, const ethd_setup_key *key) {
  char line[512] = "";
  bool differs = false;
  for (uint32_t i = 0; i < key->count; i++) {
    char name[96], text[32];
    snprintf(name, sizeof name, "%s.%s[%u]", key->section, key->param.name, i);
    double value = front->get(setup, name);
    exact(value, text);
    strcat(strcat(line, " "), text);
    differs |= value != key->param.def;
  }
  if (differs) printf("%-13s =%s ; %s, %s\n", key->param.name, line, key->param.unit, key->param.brief);
}

static void value(const ethd__config_front *front, const void *setup, const ethd_setup_key *key) {
  char name[96];
  snprintf(name, sizeof name, "%s.%s", key->section, key->param.name);
  if (key->count > 1)
    numbers(front, setup, key);
  else if (isnan(front->get(setup, name)))
    return; /* an unknown value isn't printed */
  else if (ethd_param_words(&key->param))
    choice(&key->param, front->get(setup, name));
  else
    number(key->param.name, front->get(setup, name), key->param.unit, key->param.brief);
}

/* Prints what is chosen and the numbers; only the limits that were given. */
static void section(const ethd_config *c, const char *name) {
  const ethd__config_front *front = ethd__front_of(c);
  const void *s = ethd__front_setup(c);
  const ethd_setup_part *part = front->part_of(name);
  ethd_setup_key key;
  printf("%s[%s]\n", strcmp(name, c->is_space ? "space" : "arm") ? "\n" : "", name);
  if (part) word(part->chooser, front->chosen(s, part).id, front->chosen(s, part).brief);
  for (uint32_t i = 0; front->key_at(s, i, &key) == ETHD_OK; i++) {
    int limit = ethd__config_limit(key.section, key.param.name);
    if (strcmp(key.section, name) == 0 && (limit < 0 || (c->limits_given >> limit & 1))) value(front, s, &key);
  }
}

/* The following functions print the other contents of sections. */
static void difference(const ethd_config *c) {
  printf("; d_beta = R_r - R_f,max = %.10g m\n", c->setup.ring_radius - c->setup.finger_radius_max);
}

static void other_limits(const ethd_config *c) {
  if (c->limits_given != (1u << ETHD_LIMITS) - 1) printf("; the others are the device's own\n");
}

static void scene(const ethd_config *c) {
  const ethd_ini_key *file = ethd_ini_find(&ethd__config_whole(c)->ini, "scene", "file");
  ethd_scene_info info;
  ethd_solids_info solids;
  if (!file) printf("; none: there is no wall%s\n", c->is_space ? "" : " (ethd-tap puts the paper's there)");
  if (file && c->is_space) {
    ethd_solids_describe(c->solids, &solids);
    printf("file          = %s ; %zu object%s, %zu material%s\n", file->value, solids.objects, ethd__s(solids.objects),
           solids.materials, ethd__s(solids.materials));
  }
  if (!file || c->is_space) return;
  ethd_scene_describe(c->scene, &info);
  printf("file          = %s ; %zu object%s, %zu material%s, %zu out of the arm's reach\n", file->value, info.objects,
         ethd__s(info.objects), info.materials, ethd__s(info.materials),
         ethd_scene_out_of_reach(c->scene, &c->setup.arm, c->setup.ring_radius));
}

static void device(const ethd_config *c) {
  printf("driver        = %s\n", c->device);
  for (uint32_t i = 0; i < c->setting_count; i++) printf("%-13s = %s\n", c->settings[i].key, c->settings[i].value);
}

static void plugins(const ethd_config *c) {
  for (uint32_t i = 0; i < c->plugin_count; i++) printf("file          = %s\n", c->plugins[i]);
}

void ethd__report_setup(const ethd_config *config) {
  static const struct {
    const char *section;
    void (*print)(const ethd_config *config);
  } besides[] = {
      {"finger", difference}, {"limits", other_limits}, {"scene", scene}, {"device", device}, {"plugins", plugins}};
  for (const ethd__section *s = ethd__sections; s->name; s++) {
    const char *name = s->name;
    if (!(s->fronts & ethd__front_of(config)->bit)) continue;
    section(config, name);
    for (size_t k = 0; k < sizeof besides / sizeof *besides; k++)
      if (strcmp(besides[k].section, name) == 0) besides[k].print(config);
  }
}
