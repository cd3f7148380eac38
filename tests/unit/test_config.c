/* Configurations: every key lands where it belongs, whatever the order. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "config_text.h"
#include "ethd/config.h"
#include "unit/suite.h"

static char message[ETHD_MESSAGE_MAX];

static ethd_config *parse(const char *text) {
  ethd_config *config;
  ethd_status status = ethd_config_parse(text, strlen(text), "x.ini", "/nowhere", &config, message);
  ck_assert_msg(status == ETHD_OK, "%s\nrefused: %s", text, message);
  return config;
}

static double law_value(const ethd_law *law, const double *p, const char *name) {
  int i = ethd_params_find(law->params, law->param_count, name);
  ck_assert_msg(i >= 0, "%s has no %s", law->id, name);
  return p[i];
}

static double transition_value(const ethd_setup *s, const char *name) {
  return law_value(&s->transition->law, s->transition_p, name);
}

/* ---- what is accepted ---- */

TEST(test_defaults) {
  static const char *const empties[] = {
      "", "\n", "# nothing\n; either\n", "[arm]\n[contact]\n[arm]\n", "\xef\xbb\xbf", "\r\n[arm]\r\n"};
  const ethd_setup expected = ethd_setup_default();
  for (size_t i = 0; i < sizeof empties / sizeof *empties; i++) {
    ethd_config *c = parse(empties[i]);
    ck_assert_mem_eq(&c->setup, &expected, sizeof expected);
    ck_assert(c->limits_given == 0 && !c->scene);
    ck_assert_str_eq(c->device, "sim");
    ethd_config_free(c);
  }
  ethd_config *c;
  ck_assert_int_eq(ethd_config_load(NULL, &c, message), ETHD_OK);
  ck_assert_ptr_null(c->path);
  ethd_config_free(c);
  ethd_config_free(NULL);
}

/* Each key alone: test_setup_set. */
TEST(test_all_keys) {
  ethd_config *c = parse(everything);
  ck_assert_uint_eq(c->limits_given, 31 | 1 << 15);
  ck_assert_str_eq(c->device, "other");
  ck_assert_uint_eq(c->setting_count, 1);
  ck_assert_str_eq(c->settings[0].key, "wire");
  ck_assert_str_eq(c->settings[0].value, "3 x");
  ck_assert_int_eq(c->settings[0].line, 49);
  ck_assert_str_eq(c->text, everything);
  ethd_config_free(c);
}

/* Keys of one section in every rotation, sections in reverse: the setup stays the same. */
TEST(test_order_never_matters) {
  static const char *const keys[] = {"law = offset", "preset = paper", "eps_max = 0.004", "v_hysteresis = 0.002",
                                     "b_d = 90"};
  enum { COUNT = sizeof keys / sizeof *keys };
  for (int first = 0; first < COUNT; first++)
    for (int step = 1; step < COUNT; step++) {
      char text[512] = "[contact]\nk_e = 7\n[transition]\n";
      for (int i = 0; i < COUNT; i++) {
        strcat(text, keys[(first + i * step) % COUNT]);
        strcat(text, i == 2 ? "\n[ring]\n[transition]\n" : "\n");
      }
      strcat(text, "[contact]\nlaw = spring\n");
      ethd_config *c = parse(text);
      ck_assert(transition_value(&c->setup, "eps_max") == 0.004);
      ck_assert(isinf(transition_value(&c->setup, "t_max")));
      ck_assert(c->setup.v_hysteresis == 0.002 && transition_value(&c->setup, "b_d") == 90);
      ck_assert(c->setup.contact == &ethd_contact_spring && c->setup.contact_p[0] == 7);
      ethd_config_free(c);
    }
}

TEST(test_preset) {
  ethd_config *c = parse("[transition]\npreset = paper\n");
  ck_assert(isinf(transition_value(&c->setup, "eps_max")) && isinf(transition_value(&c->setup, "t_max")));
  ethd_config_free(c);
  c = parse("[transition]\npreset = product\n");
  ck_assert(transition_value(&c->setup, "eps_max") == 0.006);
  ethd_config_free(c);
  c = parse("[transition]\npreset = paper\nlaw = abrupt\n"); /* has neither cap */
  ck_assert_int_eq(ethd_config_transition(c, "offset", &c->setup, message), ETHD_OK);
  ck_assert(isinf(transition_value(&c->setup, "eps_max")));
  ethd_config_free(c);
}

TEST(test_comments_and_spaces) {
  ethd_config *c = parse("  [contact]  ; walls\n\tk_e=100\t;soft ; really\n  b_e =  7  \n;b_e = 8\n   # b_e = 9\n"
                         "[device]\na = b;c\n# " X50 X50 X50 X50 X50 "\nd = e=f # g\n");
  ck_assert(c->setup.contact_p[0] == 100 && c->setup.contact_p[1] == 7);
  ck_assert_str_eq(c->settings[0].value, "b;c");
  ck_assert_str_eq(c->settings[1].value, "e=f # g");
  ethd_config_free(c);
}

/* ---- changes of law, single values ---- */

/* The message that refuses it as a transition law and names those that there are. */
static const char *refused_law(const char *id) {
  static char out[ETHD_MESSAGE_MAX];
  int n = snprintf(out, sizeof out, "transition.law: found \"%s\"", id);
  for (const ethd_law *const *law = ethd_laws; *law; law++)
    if ((*law)->kind == ETHD_TRANSITION) n += snprintf(out + n, sizeof out - (size_t)n, ", %s", (*law)->id);
  snprintf(out + n, sizeof out - (size_t)n, " is allowed");
  return out;
}

TEST(test_transition) {
  ethd_config *c = parse("[transition]\nbeta_min = 0.3\nb_d = 70\nswap_time = 0.5\nv_hysteresis = 0.01\n");
  ethd_setup s = c->setup;
  ck_assert_int_eq(ethd_config_transition(c, "smooth", &s, message), ETHD_OK);
  ck_assert(s.transition == &ethd_transition_smooth && transition_value(&s, "beta_min") == 0.3);
  ck_assert(s.swap_time == 0.5 && s.v_hysteresis == 0.01);
  ck_assert_int_eq(ethd_config_transition(c, "offset", &s, message), ETHD_OK);
  ck_assert(transition_value(&s, "beta_min") == 0.3);
  ck_assert(transition_value(&s, "b_d") == 100); /* dropped on the way */
  ck_assert(c->setup.transition == &ethd_transition_offset && transition_value(&c->setup, "b_d") == 70);
  ethd_config *empty = parse(""); /* nothing chosen but by a command */
  s = empty->setup;
  ck_assert_int_eq(ethd_config_set(empty, "transition.beta_min", "0.4", &s, message), ETHD_OK);
  ck_assert_int_eq(ethd_config_transition(empty, "smooth", &s, message), ETHD_OK);
  ck_assert(transition_value(&s, "beta_min") == 0.4);
  ethd_config_free(empty);
  s = c->setup;
  ethd_setup before = s;
  ck_assert_int_eq(ethd_config_transition(c, "kelvin-voigt", &s, message), ETHD_E_UNKNOWN);
  ck_assert_str_eq(message, refused_law("kelvin-voigt"));
  ck_assert(memcmp(&before, &s, sizeof s) == 0);
  /* the same for the other kinds */
  ck_assert_int_eq(ethd_config_law(c, "velocity", "offset", &s, message), ETHD_E_ARGUMENT);
  ck_assert_int_eq(ethd_config_law(c, "contact", "offset", &s, message), ETHD_E_UNKNOWN);
  ck_assert(memcmp(&before, &s, sizeof s) == 0);
  ck_assert_int_eq(ethd_config_set(c, "contact.k_e", "777", &s, message), ETHD_OK);
  ck_assert_int_eq(ethd_config_law(c, "contact", "spring", &s, message), ETHD_OK);
  ck_assert(s.contact == &ethd_contact_spring && ethd_setup_get(&s, "contact.k_e") == 777);
  ck_assert(isnan(ethd_setup_get(&s, "contact.b_e")) && s.transition == before.transition);
  ck_assert_int_eq(ethd_config_law(c, "tracking", "pd", &s, message), ETHD_OK);
  ethd_config_free(c);
}

TEST(test_set) {
  static const char *const refused[][2] = {{"contact.k_e", "-1"},
                                           {"contact.k_e", "x"},
                                           {"contact.k_e", "nan"},
                                           {"contact.k_e", ""},
                                           {"contact.k_x", "1"},
                                           {"contact.law", "spring"},
                                           {"velocity.method", "lsq"},
                                           {"scene.file", "a"},
                                           {"plugins.file", "a"},
                                           {"device.driver", "a"},
                                           {"device.x", "a"},
                                           {"transition.preset", "paper"},
                                           {"k_e", "1"},
                                           {".", "1"},
                                           {"", "1"},
                                           {"nothing.k", "1"},
                                           {"finger.radius_max", "0.012"},
                                           {"ring.radius", "0.001"},
                                           {"limits.workspace", "1 2 3"},
                                           {"limits.workspace", "1 0 0 1"},
                                           {"limits.torque", "-1"}};
  ethd_config *c = parse("");
  ethd_setup s = c->setup;
  ck_assert_int_eq(ethd_config_set(c, "contact.k_e", "2000", &s, message), ETHD_OK);
  ck_assert(s.contact_p[0] == 2000 && c->setup.contact_p[0] == 2500);
  ck_assert_int_eq(ethd_config_set(c, "transition.eps_max", "inf", &s, message), ETHD_OK);
  ck_assert_int_eq(ethd_config_set(c, "tracking.derivative", "difference", &s, message), ETHD_OK);
  ck_assert_int_eq(ethd_config_set(c, "limits.torque", "1.25", &s, message), ETHD_OK);
  ck_assert(s.limits.torque == 1.25);
  ethd_setup before = s;
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    message[0] = 0;
    ck_assert_msg(ethd_config_set(c, refused[i][0], refused[i][1], &s, message) < 0, "%s %s passed", refused[i][0],
                  refused[i][1]);
    ck_assert(message[0] && memcmp(&before, &s, sizeof s) == 0);
  }
  ck_assert_int_lt(ethd_config_set(c, "contact.k_e", "-1", &s, message), 0);
  ck_assert_str_eq(message, "contact.k_e: found \"-1\", 0 to 1000000 N/m is allowed");
  ethd_config_free(c);
}

/* ---- files beside it ---- */

static void write_text(const char *folder, const char *name, const char *text) {
  char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "w");
  ck_assert_ptr_nonnull(file);
  fputs(text, file);
  ck_assert_int_eq(fclose(file), 0);
}

static ethd_status load(const char *folder, ethd_config **out) {
  char path[256];
  snprintf(path, sizeof path, "%s/c.ini", folder);
  return ethd_config_load(path, out, message);
}

TEST(test_scene_file) {
  char folder[] = "/tmp/ethd-config-XXXXXX", says[512], command[64];
  ethd_config *c;
  ck_assert_ptr_nonnull(mkdtemp(folder));
  write_text(folder, "c.ini", "[scene]\nfile = s.scene\n");
  write_text(folder, "s.scene", "halfplane -1 0 -0.238\ncircle 0 0 0.1\n");
  ck_assert_msg(load(folder, &c) == ETHD_OK, "%s", message);
  ethd_scene_info info;
  ethd_scene_describe(c->scene, &info);
  ck_assert_uint_eq(info.objects, 2);
  ck_assert_ptr_eq(c->setup.scene, c->scene);
  ck_assert_str_eq(c->scene_text, "halfplane -1 0 -0.238\ncircle 0 0 0.1\n");
  ethd_config_free(c);

  write_text(folder, "s.scene", "halfplane -1 0 -0.238\ncircle 0 0\n");
  ck_assert_int_lt(load(folder, &c), 0);
  snprintf(says, sizeof says, "%s/s.scene:2: ", folder);
  ck_assert_msg(strncmp(message, says, strlen(says)) == 0, "%s", message);

  write_text(folder, "s.scene", "# soft\nmaterial soft c_e=2\nhalfplane -1 0 -0.238 material=soft\n");
  ck_assert_int_lt(load(folder, &c), 0);
  snprintf(says, sizeof says, "%s/s.scene:2: material.soft.c_e: an unknown name", folder);
  ck_assert_str_eq(message, says);
  write_text(folder, "c.ini", "[scene]\nfile = s.scene\n[contact]\nlaw = hunt-crossley\n");
  ck_assert_msg(load(folder, &c) == ETHD_OK, "%s", message);
  ethd_config_free(c);
  snprintf(command, sizeof command, "rm -r %s", folder);
  ck_assert_int_eq(system(command), 0);
}
