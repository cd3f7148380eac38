/* Numbers of a setup by the names that a configuration gives them. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/config.h"
#include "unit/suite.h"

/* ---- each name is the number it says ---- */

static ethd_setup made(const char *const choices[]) {
  ethd_setup s = ethd_setup_default();
  for (; *choices; choices += 2) ck_assert_int_eq(ethd_setup_choose(&s, choices[0], choices[1], ethd_laws, NULL), 0);
  return s;
}

#define AT(member) offsetof(ethd_setup, member)

/* Where each number stands, as control.h, guard.h and the laws' and methods' tables say. */
static const struct {
  const char *name;
  size_t at;
  double value;
} numbers[] = {
    {"arm.link1", AT(arm.link1), 0.3},
    {"arm.link2", AT(arm.link2), 0.2},
    {"loop.period", AT(period), 0.002},
    {"ring.radius", AT(ring_radius), 0.02},
    {"finger.radius", AT(finger_radius), 0.009},
    {"finger.radius_max", AT(finger_radius_max), 0.011},
    {"finger_fit.lag[0]", AT(ray_lag[0]), -0.01},
    {"finger_fit.lag[15]", AT(ray_lag[15]), 0.003},
    {"transition.swap_time", AT(swap_time), 0.5},
    {"transition.v_hysteresis", AT(v_hysteresis), 0.01},
    {"limits.torque", AT(limits.torque), 1.5},
    {"limits.torque_rate", AT(limits.torque_rate), 100},
    {"limits.speed", AT(limits.speed), 2},
    {"limits.workspace[0]", AT(limits.workspace[0]), -0.4},
    {"limits.workspace[3]", AT(limits.workspace[3]), 0.4},
    {"limits.step_time", AT(limits.step_time), 5e-4},
    {"limits.reach[1]", AT(limits.reach[1]), 0.4},
    {"limits.joints[2]", AT(limits.joints[2]), -1},
    {"limits.margin", AT(limits.margin), 0.01},
    {"limits.energy", AT(limits.energy), 0.002},
    {"limits.nominal_torque", AT(limits.nominal_torque), 0.7},
    {"limits.heat_time", AT(limits.heat_time), 30},
    {"limits.gap", AT(limits.gap), 0.004},
    {"limits.finger_age", AT(limits.finger_age), 0.02},
    {"limits.finger_lost", AT(limits.finger_lost), 0.05},
    {"limits.clean_time", AT(limits.clean_time), 1},
    {"velocity.cutoff", AT(velocity_p[0]), 80},
    {"finger_filter.noise", AT(filter_p[3]), 2e-4},
    {"tracking.k_t", AT(tracking_p[0]), 20},
    {"tracking.b_t", AT(tracking_p[1]), 0.5},
    {"tracking.derivative", AT(tracking_p[2]), 1},
    {"contact.k_e", AT(contact_p[0]), 500},
    {"contact.b_e", AT(contact_p[1]), 7},
    {"transition.b_d", AT(transition_p[0]), 60},
    {"transition.v_th", AT(transition_p[1]), 0.03},
    {"transition.beta_min", AT(transition_p[2]), 0.2},
    {"transition.eps_max", AT(transition_p[3]), INFINITY},
    {"transition.t_max", AT(transition_p[4]), 0.1},
};

TEST_LOOP(test_numbers, 0, sizeof numbers / sizeof *numbers) {
  ethd_setup s = ethd_setup_default(), expected = s;
  memcpy((char *)&expected + numbers[_i].at, &numbers[_i].value, sizeof(double));
  ck_assert(memcmp(&s, &expected, sizeof s) != 0);
  ck_assert_int_eq(ethd_setup_set(&s, numbers[_i].name, numbers[_i].value, NULL), ETHD_OK);
  ck_assert_msg(memcmp(&s, &expected, sizeof s) == 0, "%s", numbers[_i].name);
  ck_assert(ethd_setup_get(&s, numbers[_i].name) == numbers[_i].value);
}

TEST(test_mechanism) {
  ethd_setup s = ethd_setup_default();
  ck_assert(ethd_setup_get(&s, "arm.mechanism") == 0);
  ck_assert_int_eq(ethd_setup_set(&s, "arm.mechanism", 1, NULL), ETHD_OK);
  ck_assert(s.arm.mechanism == ETHD_ARM_SERIAL && ethd_setup_get(&s, "arm.mechanism") == 1);
  ck_assert_int_eq(ethd_setup_set(&s, "arm.mechanism", 0.5, NULL), ETHD_E_RANGE);
}

/* ---- each key that there is, under each law and method, as ethd-check --laws lists them ---- */

static double inside(const ethd_param *p) {
  double high = isfinite(p->max) ? p->max : fmax(p->min, 0) + 3;
  double low = isfinite(p->min) ? p->min : high - 7;
  double value = low + (high - low) / 4;
  return ethd_param_words(p) ? p->max : strcmp(p->unit, ETHD_WHOLE) ? value : floor(value);
}

/* The same value by the name and by a configuration of that one key. */
static void agrees_with_a_file(const ethd_setup *chosen, const char *choice, const ethd_setup_key *key) {
  char text[2048], name[96], message[ETHD_MESSAGE_MAX];
  double value = inside(&key->param);
  ethd_setup s = *chosen;
  ethd_config *config;
  ethd_error error;
  size_t n = (size_t)snprintf(text, sizeof text, "%s\n[%s]\n%s =", choice, key->section, key->param.name);
  for (uint32_t i = 0; i < key->count; i++) {
    snprintf(name, sizeof name, key->count > 1 ? "%s.%s[%u]" : "%s.%s", key->section, key->param.name, i);
    size_t at = n;
    n += (size_t)snprintf(text + n, sizeof text - n, " %.9g", value + i * 1e-3);
    double own = strtod(text + at, NULL);
    ck_assert_msg(ethd_setup_set(&s, name, own, &error) == ETHD_OK, "%s", name);
  }
  if (ethd_setup_check(&s, NULL) < 0) return; /* a relation to another number, or the radii's */
  const char *word = key->param.unit;
  for (int i = 0; i < (int)value && ethd_param_words(&key->param); i++) word += strcspn(word, "|") + 1;
  if (ethd_param_words(&key->param))
    snprintf(text, sizeof text, "%s\n[%s]\n%s = %.*s\n", choice, key->section, key->param.name, (int)strcspn(word, "|"),
             word);
  ck_assert_msg(ethd_config_parse(text, strlen(text), "x.ini", NULL, &config, message) == ETHD_OK, "%s", message);
  ck_assert_msg(memcmp(&s, &config->setup, sizeof s) == 0, "%s", text);
  ethd_config_free(config);
}

static int check_keys(const char *section, const char *chooser, const char *id) {
  const char *const choices[] = {section, id, NULL};
  ethd_setup s = made(choices);
  ethd_setup_key key;
  char choice[96];
  int count = 0;
  snprintf(choice, sizeof choice, "[%s]\n%s = %s", section, chooser, id);
  for (uint32_t i = 0; ethd_setup_key_at(&s, i, &key) == ETHD_OK; i++, count++) {
    char name[96];
    snprintf(name, sizeof name, key.count > 1 ? "%s.%s[0]" : "%s.%s", key.section, key.param.name);
    if (!isnan(key.param.def)) ck_assert_msg(ethd_setup_get(&s, name) == key.param.def, "%s", name);
    agrees_with_a_file(&s, choice, &key);
  }
  return count;
}

TEST_LOOP(test_every_key, 0, ETHD_SETUP_PARTS) {
  const ethd_setup_part *part = &ethd_setup_parts[_i];
  int keys = 0;
  for (uint32_t i = 0; i < part->count; i++) keys += check_keys(part->section, part->chooser, part->methods[i].id);
  for (const ethd_law *const *law = ethd_laws; !part->methods && *law; law++)
    if ((*law)->kind == part->kind) keys += check_keys(part->section, part->chooser, (*law)->id);
  ck_assert_int_gt(keys, 30);
}

TEST(test_chosen) {
  const ethd_setup_part *contact = ethd_setup_part_of("contact"), *velocity = ethd_setup_part_of("velocity");
  const char *const choices[] = {"contact", "spring", "velocity", "lsq", NULL};
  ethd_setup s = made(choices);
  ethd_error error;
  ck_assert(s.contact == &ethd_contact_spring && s.velocity == ETHD_VELOCITY_LSQ);
  ck_assert_str_eq(ethd_setup_chosen(&s, contact).id, "spring");
  ck_assert_str_eq(ethd_setup_chosen(&s, velocity).params[0].name, "window");
  ck_assert(isnan(ethd_setup_get(&s, "contact.b_e")));
  ck_assert_int_eq(ethd_setup_choose(&s, "contact", "offset", ethd_laws, &error), ETHD_E_UNKNOWN);
  ck_assert_str_eq(error.name, "offset");
  ck_assert_int_eq(ethd_setup_choose(&s, "velocity", "spring", ethd_laws, &error), ETHD_E_UNKNOWN);
  ck_assert_str_eq(error.name, "spring");
  ck_assert_int_eq(ethd_setup_choose(&s, "wall", "spring", ethd_laws, &error), ETHD_E_UNKNOWN);
  ck_assert_str_eq(error.name, "wall");
  ck_assert(s.contact == &ethd_contact_spring && !ethd_setup_part_of("limits"));
  const char *const back[] = {"contact",  "spring",  "contact", "kelvin-voigt", "velocity", "lsq",
                              "velocity", "lowpass", NULL};
  ethd_setup once = ethd_setup_default(), again = made(back); /* chosen again: the default to the bit */
  ck_assert_mem_eq(again.contact_p, once.contact_p, sizeof once.contact_p);
  ck_assert_mem_eq(again.velocity_p, once.velocity_p, sizeof once.velocity_p);
  s.contact = NULL;
  ck_assert_ptr_null(ethd_setup_chosen(&s, contact).id);
}

/* ---- refusals change nothing ---- */

static const struct {
  const char *name;
  double value;
  ethd_status status;
  const char *says;
  double min, max;
} refusals[] = {
    {"contact.k_e", -1, ETHD_E_RANGE, "contact.k_e", 0, 1e6},
    {"contact.k_e", NAN, ETHD_E_NOT_FINITE, "contact.k_e", 0, 1e6},
    {"contact.k_e", INFINITY, ETHD_E_NOT_FINITE, "contact.k_e", 0, 1e6},
    {"ring.radius", 1.5, ETHD_E_RANGE, "ring.radius", 1e-4, 1},
    {"transition.swap_time", 2, ETHD_E_RANGE, "transition.swap_time", 0, 1},
    {"limits.torque", -1, ETHD_E_RANGE, "limits.torque", 0, INFINITY},
    {"tracking.derivative", 0.5, ETHD_E_RANGE, "tracking.derivative", 0, 1},
    {"limits.workspace", 1, ETHD_E_ARGUMENT, "limits.workspace", 0, 3},
    {"limits.workspace[4]", 1, ETHD_E_RANGE, "limits.workspace[4]", 0, 3},
    {"limits.workspace[", 1, ETHD_E_RANGE, "limits.workspace[", 0, 3},
    {"limits.workspace[1", 1, ETHD_E_RANGE, "limits.workspace[1", 0, 3},
    {"limits.workspace[99999999999]", 1, ETHD_E_RANGE, "limits.workspace[99999999999]", 0, 3},
    {"contact.k_e[0]", 1, ETHD_E_RANGE, "contact.k_e[0]", 0, 0},
    {"contact.k", 1, ETHD_E_UNKNOWN, "contact.k", NAN, NAN},
    {"contact.k_e2", 1, ETHD_E_UNKNOWN, "contact.k_e2", NAN, NAN},
    {"k_e", 1, ETHD_E_UNKNOWN, "k_e", NAN, NAN},
    {"", 1, ETHD_E_UNKNOWN, "", NAN, NAN},
    {"velocity.window", 9, ETHD_E_UNKNOWN, "velocity.window", NAN, NAN}, /* lowpass has none */
};

static bool same(double a, double b) { return a == b || (isnan(a) && isnan(b)); }

TEST_LOOP(test_refusals, 0, sizeof refusals / sizeof *refusals) {
  ethd_setup s = ethd_setup_default(), before = s;
  ethd_error error;
  ck_assert_int_eq(ethd_setup_set(&s, refusals[_i].name, refusals[_i].value, &error), refusals[_i].status);
  ck_assert_str_eq(error.name, refusals[_i].says);
  ck_assert(error.status == refusals[_i].status);
  ck_assert(same(error.min, refusals[_i].min) && same(error.max, refusals[_i].max));
  ck_assert(memcmp(&s, &before, sizeof s) == 0);
}

TEST(test_not_made) {
  ethd_setup s;
  ethd_error error;
  memset(&s, 0, sizeof s);
  ck_assert_int_eq(ethd_setup_set(&s, "ring.radius", 0.01, &error), ETHD_E_ARGUMENT);
  ck_assert_msg(strstr(error.name, "ethd_setup_default") != NULL, "%s", error.name);
  ck_assert(s.ring_radius == 0 && isnan(ethd_setup_get(&s, "ring.radius")));
  ck_assert_int_eq(ethd_setup_set(NULL, "ring.radius", 0.01, NULL), ETHD_E_ARGUMENT);
}
