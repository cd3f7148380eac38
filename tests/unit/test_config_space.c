/* Configurations of the front in space: every key lands where it belongs, the plane's are refused. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/config.h"
#include "unit/config_text.h"
#include "unit/suite.h"

static char message[ETHD_MESSAGE_MAX];

static ethd_config *parse(const char *text) {
  ethd_config *config;
  ethd_status status = ethd_config_parse(text, strlen(text), "x.ini", "apps/config", &config, message);
  ck_assert_msg(status == ETHD_OK, "%s\nrefused: %s", text, message);
  return config;
}

/* ---- what is accepted ---- */

TEST(test_defaults) {
  static const char *const texts[] = {"[space]\n", "[contact]\n[space]\n[device]\n", "[space]\ncommand = velocity\n"};
  const ethd_space_setup expected = ethd_space_setup_default();
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    ethd_config *c = parse(texts[i]);
    ck_assert(c->is_space && memcmp(&c->space, &expected, sizeof expected) == 0 && !c->solids && !c->scene);
    ethd_config_free(c);
  }
  ethd_config *c = parse("");
  ck_assert(!c->is_space);
  ethd_config_free(c);
}

TEST(test_every_part) {
  ethd_config *c = parse(everything_in_space);
  const ethd_space_setup *s = &c->space;
  ck_assert(s->kind == ETHD_SPACE_FORCE && s->effector == ETHD_EFFECTOR_CAP && s->period == 0.002 && s->radius == 0.03);
  ck_assert(s->finger_radius == 0.007 && s->finger_radius_max == 0.011 && s->swap_time == 0.04);
  ck_assert(s->v_hysteresis == 0.002 && isinf(s->speed) && s->force == 12 && s->force_rate == 900);
  ck_assert(s->x_min == -0.5 && s->x_max == 0.6 && isinf(s->y_max) && s->reach == 0.8 && s->reach_z == 0.33);
  ck_assert(s->finger_age == 0.06 && s->stop_time == 0.25 && s->latch == 1);
  const ethd_ability *a = &s->ability;
  ck_assert(a->speed == 2 && a->acceleration == 20 && a->delay == 0.008 && a->mass == 4 && a->force == 100);
  ck_assert(a->friction == 1.5 && s->filter == ETHD_FILTER_CV && s->tracking == &ethd_tracking_follow);
  ck_assert(s->contact == &ethd_contact_spring && s->contact_p[0] == 2600);
  ck_assert(s->transition == &ethd_transition_smooth && ethd_space_get(s, "transition.beta_min") == 0.2);
  ck_assert_str_eq(c->device, "other");
  ck_assert_str_eq(c->settings[0].value, "3 x");
  ethd_config_free(c);
}

static double inside(const ethd_param *p) {
  const double high = isfinite(p->max) ? p->max : fmax(p->min, 0) + 3, low = isfinite(p->min) ? p->min : high - 7;
  const double value = low + (high - low) / 4;
  return ethd_param_words(p) ? p->max : strcmp(p->unit, ETHD_WHOLE) ? value : floor(value);
}

/* Each key under each law and method has the same value by its name and by a file of it alone. */
static int agree(const char *section, const char *chooser, const char *id) {
  ethd_space_setup chosen = ethd_space_setup_default();
  ethd_setup_key key;
  ethd_error error;
  int compared = 0;
  ck_assert_int_eq(ethd_space_choose(&chosen, section, id, ethd_laws, NULL), ETHD_OK);
  for (uint32_t i = 0; ethd_space_key_at(&chosen, i, &key) == ETHD_OK; i++) {
    ethd_space_setup s = chosen;
    ethd_config *config;
    char name[96], text[256], value[32];
    double number = inside(&key.param);
    const char *word = key.param.unit;
    snprintf(value, sizeof value, "%.9g", number);
    number = strtod(value, NULL);
    for (int k = 0; k < (int)number && ethd_param_words(&key.param); k++) word += strcspn(word, "|") + 1;
    if (ethd_param_words(&key.param)) snprintf(value, sizeof value, "%.*s", (int)strcspn(word, "|"), word);
    snprintf(name, sizeof name, "%s.%s", key.section, key.param.name);
    ck_assert_uint_eq(key.count, 1);
    ck_assert_msg(ethd_space_set(&s, name, number, &error) == ETHD_OK, "%s", name);
    ck_assert_msg(ethd_space_get(&s, name) == number, "%s", name);
    ck_assert_msg(number == ethd_space_get(&chosen, name) || memcmp(&s, &chosen, sizeof s) != 0, "%s", name);
    if (ethd_space_check(&s, NULL) < 0) continue; /* a relation to another number */
    snprintf(text, sizeof text, "[space]\n[%s]\n%s = %s\n[%s]\n%s = %s\n", section, chooser, id, key.section,
             key.param.name, value);
    config = parse(text);
    ck_assert_msg(memcmp(&s, &config->space, sizeof s) == 0, "%s", text);
    compared++;
    s = chosen; /* and by a command */
    ck_assert_msg(ethd_config_space_set(config, name, value, &s, message) == ETHD_OK, "%s: %s", name, message);
    ck_assert_msg(ethd_space_get(&s, name) == number, "%s", name);
    ethd_config_free(config);
  }
  return compared;
}

TEST(test_every_key) {
  int compared = 0;
  for (const ethd_setup_part *part = ethd_space_parts; part < ethd_space_parts + ETHD_SPACE_PARTS; part++) {
    for (uint32_t i = 0; i < part->count; i++) compared += agree(part->section, part->chooser, part->methods[i].id);
    for (const ethd_law *const *law = ethd_laws; !part->methods && *law; law++)
      if ((*law)->kind == part->kind && strcmp((*law)->id, "pd") != 0) /* pd has no velocity */
        compared += agree(part->section, part->chooser, (*law)->id);
  }
  ck_assert_int_gt(compared, 400);
}

/* ---- changes of law, single values ---- */

TEST(test_commands) {
  ethd_config *c = parse("[space]\n[contact]\nk_e = 700\nb_e = 12\n[scene]\nfile = room.solids\n");
  ethd_space_setup s = c->space, before;
  ck_assert_uint_eq(s.materials, 1);
  ck_assert(s.material_p[0][0] == 800 && s.material_p[0][1] == 20);
  ck_assert_int_eq(ethd_config_space_set(c, "contact.b_e", "13", &s, message), ETHD_OK);
  ck_assert_int_eq(ethd_config_space_set(c, "space.radius", "0.02", &s, message), ETHD_OK);
  ck_assert_int_eq(ethd_config_space_set(c, "ability.delay", "0.03", &s, message), ETHD_OK);
  ck_assert(s.contact_p[0] == 700 && s.contact_p[1] == 13 && s.material_p[0][0] == 800 && s.material_p[0][1] == 20);
  ck_assert(s.radius == 0.02 && s.ability.delay == 0.03 && c->space.radius == 0.0175);
  ck_assert_int_eq(ethd_config_space_law(c, "transition", "smooth", &s, message), ETHD_OK);
  ck_assert(s.transition == &ethd_transition_smooth && s.contact_p[1] == 13);
  before = s;
  ck_assert_int_eq(ethd_config_space_law(c, "contact", "spring", &s, message), ETHD_E_UNKNOWN);
  ck_assert_str_eq(message, "2: material.foam.b_e: an unknown name");
  ck_assert_int_eq(ethd_config_space_law(c, "tracking", "pd", &s, message), ETHD_E_ARGUMENT);
  ck_assert_int_eq(ethd_config_space_law(c, "finger_filter", "cv", &s, message), ETHD_E_ARGUMENT);
  ck_assert_int_eq(ethd_config_space_set(c, "ring.radius", "0.01", &s, message), ETHD_E_UNKNOWN);
  ck_assert_int_eq(ethd_config_space_set(c, "space.radius", "0.01", &s, message), ETHD_E_RANGE);
  ck_assert_int_eq(ethd_config_space_set(c, "scene.file", "a", &s, message), ETHD_E_ARGUMENT);
  ck_assert_int_eq(ethd_config_space_set(c, "contact.law", "spring", &s, message), ETHD_E_ARGUMENT);
  ck_assert(memcmp(&before, &s, sizeof s) == 0);
  ethd_config_free(c);
}

/* ---- what is refused ---- */

static const struct {
  const char *text, *says;
} bads[] = {
    {"[space]\n[arm]\n", "x.ini:2: [arm]: is a section of the plane, but [space] in line 1 is there"},
    {"[ring]\nradius = 0.01\n[space]\n", "x.ini:1: [ring]: is a section of the plane, but [space] in line 3 is there"},
    {"[space]\n[velocity]\n", "x.ini:2: [velocity]: is a section of the plane, "},
    {"[space]\n[limits]\n", "x.ini:2: [limits]: is a section of the plane, "},
    {"[space]\n[loop]\nperiod = 0.001\n", "x.ini:2: [loop]: is a section of the plane, "},
    {"[ability]\n", "x.ini:1: [ability]: is a section of space, but there is no [space]"},
    {"[space]\n[nothing]\n", "x.ini:2: [nothing]: unknown section; space, ability, finger_filter, "},
    {"[space]\nlink1 = 1\n", "x.ini:2: space.link1: unknown key; period, radius, finger_radius, "},
    {"[space]\nradius = -1\n", "x.ini:2: space.radius: found \"-1\", 0.0001 to 1 m is allowed"},
    {"[space]\nradius = 0.01\n", "x.ini:2: space.finger_radius_max: a value is out of its range; found 0.015, allowed "
                                 "0.0001 to 0.00999, by space.radius = 0.01"},
    {"[space]\nx_min = 1\nx_max = 0\n", "x.ini:3: space.x_max: a value is out of its range; found 0, allowed 1 to inf"},
    {"[space]\ncommand = torque\n", "x.ini:2: space.command: found \"torque\", force|velocity is allowed"},
    {"[space]\neffector = 1\n", "x.ini:2: space.effector: found \"1\", ring|cap|plate is allowed"},
    {"[space]\n[ability]\ndelay = -1\n", "x.ini:3: ability.delay: found \"-1\", 0 to inf s is allowed"},
    {"[space]\n[transition]\npreset = paper\n", "x.ini:3: transition.preset: not a key of approach, which has law"},
    {"[space]\n[transition]\nswap_time = 1\n", "x.ini:3: transition.swap_time: not a key of approach"},
    {"[space]\n[tracking]\nlaw = pd\n", "x.ini: tracking.law (it has no velocity): "},
    {"[space]\n[scene]\nfile = room.scene\n", "apps/config/room.scene:"},
    {"[space]\n[scene]\nfile = room.solids\n[contact]\nlaw = spring\n",
     "apps/config/room.solids:2: material.foam.b_e: an unknown name"},
    {"[scene]\nfile = room.solids\n", "apps/config/room.solids:3: halfspace, a shape of space: an unknown name"},
};

TEST(test_refusals) {
  for (size_t i = 0; i < sizeof bads / sizeof *bads; i++) {
    ethd_config *c;
    ck_assert_msg(ethd_config_parse(bads[i].text, strlen(bads[i].text), "x.ini", "apps/config", &c, message) < 0,
                  "%s passed", bads[i].text);
    ck_assert_ptr_null(c);
    ck_assert_msg(strncmp(message, bads[i].says, strlen(bads[i].says)) == 0, "%s\nsays %s", bads[i].text, message);
  }
}

/* A scene's refusal names the line, the word and what is allowed instead. */
TEST(test_solids_file) {
  static const char *const texts[][2] = {
      {"sphere 0 0 0 1\ncircle 0 0 1\n",
       ":2: circle, a shape of the plane: an unknown name; halfspace, sphere, capsule, box, material are allowed"},
      {"box 0 0 0 1\n", "numbers after box"},
      {"sphere 0 0 0 1 material=wood\n", "; a line \"material wood k_e=2500\" defines it"},
      {"material wood k_e=-1\n", ":1: material.wood.k_e: a value is out of its range; found -1, allowed 0 to 1000000"}};
  char folder[] = "/tmp/ethd-solids-XXXXXX", path[64], text[] = "[space]\n[scene]\nfile = a.solids\n";
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/a.solids", folder);
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    ethd_config *c;
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    fputs(texts[i][0], file);
    ck_assert_int_eq(fclose(file), 0);
    ck_assert_int_lt(ethd_config_parse(text, strlen(text), "x.ini", folder, &c, message), 0);
    ck_assert_msg(strncmp(message, path, strlen(path)) == 0 && strstr(message, texts[i][1]), "%s", message);
  }
  ck_assert_int_eq(unlink(path), 0);
  ck_assert_int_eq(rmdir(folder), 0);
}

/* A device's limits, where they are stricter than the setup's. */
TEST(test_narrow) {
  ethd_space_setup s = ethd_space_setup_default(), unchanged;
  ethd_limits l = ethd_limits_none();
  s.speed = 1, s.x_min = -0.5, s.y_max = 0.3, s.clean_time = 0.2, s.stop_time = 0.05;
  unchanged = s;
  ethd_space_narrow(&s, &l);
  ck_assert_mem_eq(&s, &unchanged, sizeof s);
  l.speed = 0.4, l.clean_time = 0.1, l.stop_time = 0.2, l.energy = 0.01, l.step_time = 1e-4;
  l.gap = 0.003, l.finger_age = 0.02, l.finger_lost = 0.1;
  memcpy(l.workspace, (double[]){-0.4, 0.6, -0.2, 0.5}, sizeof l.workspace);
  ethd_space_narrow(&s, &l);
  ck_assert(s.speed == 0.4 && s.energy == 0.01 && s.step_time == 1e-4 && s.gap == 0.003);
  ck_assert(s.finger_age == 0.02 && s.finger_lost == 0.1 && s.clean_time == 0.2 && s.stop_time == 0.05);
  ck_assert(s.x_min == -0.4 && s.x_max == 0.6 && s.y_min == -0.2 && s.y_max == 0.3 && isinf(s.z_min));
}

/* ---- the example ---- */

TEST(test_example) {
  ethd_config *c;
  ck_assert_msg(ethd_config_load("apps/config/space.ini", &c, message) == ETHD_OK, "%s", message);
  ethd_surface near[4];
  /* the ball's top is 0.16 over the table, and the point 0.04 over it */
  ck_assert_uint_eq(ethd_solids_surfaces(c->solids, NULL, (ethd_vec3){0.45, 0.2, 0.2}, 0.1, near, 4), 1);
  ck_assert(near[0].id == 1 && near[0].material == 0 && fabs(near[0].point.z - 0.16) < 1e-12 &&
            near[0].n.z + 1 < 1e-12);
  ck_assert(c->space.effector == ETHD_EFFECTOR_PLATE && c->space.radius == 0.068 && c->space.ability.delay == 0.008);
  ck_assert_ptr_nonnull(strstr(c->scene_text, "halfspace 0 0 -1 0"));
  ethd_config_free(c);
}
