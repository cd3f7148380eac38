#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/report.h"
#include "settings/config_parts.h"

static void head(const char *section) { printf("[%s]\n", section); }

static void word(const char *key, const char *value, const char *brief) {
  printf("%-13s = %-12s ; %s\n", key, value, brief);
}

/* As many digits as it takes to read the same number again. */
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

static void table(const ethd__section *section) {
  for (uint32_t i = 0; i < section->count; i++) {
    const ethd_param *row = &section->params[i];
    if (ethd_param_words(row))
      choice(row, section->values[i]);
    else
      number(row->name, section->values[i], row->unit, row->brief);
  }
}

static void chosen(ethd_setup *setup, const char *name, const char *brief) {
  ethd__section section = {0};
  (void)ethd__config_section(setup, name, &section);
  printf("\n");
  head(name);
  word(ethd__config_chooser(name), section.id, brief);
  table(&section);
}

static void geometry(const ethd_config *c) {
  const ethd_setup *s = &c->setup;
  head("arm");
  word("mechanism", s->arm.mechanism == ETHD_ARM_SERIAL ? "serial" : "parallel", "what q2 is relative to");
  number("link1", s->arm.link1, "m", "");
  number("link2", s->arm.link2, "m", "");
  if (!isnan(c->mass_x)) number("mass_x", c->mass_x, "kg", "at the ring");
  if (!isnan(c->mass_y)) number("mass_y", c->mass_y, "kg", "at the ring");
  printf("\n[ring]\n");
  number("radius", s->ring_radius, "m", "inner radius (R_r)");
  printf("\n[finger]\n");
  number("radius", s->finger_radius, "m", "R_f");
  number("radius_max", s->finger_radius_max, "m", "R_f,max");
  printf("; d_beta = R_r - R_f,max = %.10g m\n\n[loop]\n", s->ring_radius - s->finger_radius_max);
  number("period", s->period, "s", "T");
}

static void limits(const ethd_config *c) {
  ethd_limits l = c->setup.limits;
  printf("\n[limits]\n");
  for (int i = 0; i < ETHD_LIMITS; i++) {
    const ethd_limit *row = &ethd_limit_rows[i];
    if (!(c->limits_given >> i & 1)) continue;
    printf("%-13s =", row->name);
    for (uint32_t k = 0; k < row->count; k++) {
      char text[32];
      exact(ethd_limit_of(&l, row)[k], text);
      printf(" %s", text);
    }
    printf(" ; %s, %s\n", row->unit, row->brief);
  }
  if (c->limits_given != (1u << ETHD_LIMITS) - 1) printf("; the others are the device's own\n");
}

static void surroundings(const ethd_config *c) {
  const ethd_ini *ini = &ethd__config_whole(c)->ini;
  const ethd_ini_key *scene = ethd_ini_find(ini, "scene", "file");
  ethd_scene_info info;
  printf("\n[scene]\n");
  if (scene) {
    ethd_scene_describe(c->scene, &info);
    printf("file          = %s ; %zu objects, %zu materials, %zu out of the arm's reach\n", scene->value, info.objects,
           info.materials, ethd_scene_out_of_reach(c->scene, &c->setup.arm, c->setup.ring_radius));
  }
  printf("\n[device]\ndriver        = %s\n", c->device);
  for (uint32_t i = 0; i < c->setting_count; i++) printf("%-13s = %s\n", c->settings[i].key, c->settings[i].value);
  if (c->plugin_count) printf("\n[plugins]\n");
  for (uint32_t i = 0; i < c->plugin_count; i++) printf("file          = %s\n", c->plugins[i]);
}

void ethd__report_setup(const ethd_config *config) {
  ethd_setup s = config->setup;
  geometry(config);
  chosen(&s, "velocity", ethd_velocity_methods[s.velocity].brief);
  chosen(&s, "finger_fit", ethd_fit_methods[s.fit].brief);
  chosen(&s, "finger_filter", ethd_filter_methods[s.filter].brief);
  chosen(&s, "tracking", s.tracking->law.brief);
  chosen(&s, "contact", s.contact->law.brief);
  chosen(&s, "transition", s.transition->law.brief);
  number("swap_time", s.swap_time, "s", "a change of laws fades over this time");
  number("v_hysteresis", s.v_hysteresis, "m/s", "entering until v < -v_hysteresis, leaving until v > it");
  limits(config);
  surroundings(config);
}
