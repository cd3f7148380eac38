/* Setups that are refused for what no other test brings: laws that are missing or not what they say, methods and rows
   that don't exist, names that end in something else; and what a law that looks ahead may ask for. */
#include <math.h>
#include <string.h>

#include "ethd/fault.h"
#include "unit/rig.h"

static ethd_error error;

static ethd_status checked(const ethd_setup *s) {
  memset(&error, 0, sizeof error);
  return ethd_setup_check(s, &error);
}

static void expect(ethd_setup s, ethd_status status, const char *name) {
  ck_assert_int_eq(checked(&s), status);
  ck_assert_str_eq(error.name, name);
  ck_assert_int_eq(ethd_setup_check(&s, NULL), status);
}

/* ---- laws ---- */

TEST(test_no_law) {
  ethd_setup s = ethd_setup_default();
  s.tracking = NULL;
  expect(s, ETHD_E_ARGUMENT, "tracking");
  s = ethd_setup_default();
  s.contact = NULL;
  expect(s, ETHD_E_ARGUMENT, "contact");
  s = ethd_setup_default();
  s.transition = NULL;
  expect(s, ETHD_E_ARGUMENT, "transition");
  ck_assert_int_eq(ethd_setup_check(NULL, NULL), ETHD_E_ARGUMENT);
  ck_assert(ethd_setup_range(&s) == 2 * s.ring_radius + s.ring_radius - s.finger_radius_max);
}

static ethd_error refused(const ethd_law *law) {
  memset(&error, 0, sizeof error);
  ck_assert_int_lt(ethd_law_check(law, &error), 0);
  return error;
}

/* What was found and what is allowed are told. */
TEST(test_law_in_numbers) {
  ethd_transition_law law = ethd_transition_smooth;
  law.law.kind = (ethd_kind)3;
  ethd_error e = refused(&law.law);
  ck_assert(!strcmp(e.name, "kind") && e.found == 3 && e.min == 0 && e.max == 2);
  law.law.kind = ETHD_TRANSITION;
  law.law.size = ETHD_TRANSITION_LAW_MIN - 1;
  e = refused(&law.law);
  ck_assert(!strcmp(e.name, "size") && e.found == ETHD_TRANSITION_LAW_MIN - 1 && e.min == ETHD_TRANSITION_LAW_MIN &&
            e.max == sizeof law);
  law.law.size = sizeof law;
  law.law.abi = ETHD_ABI + 5;
  e = refused(&law.law);
  ck_assert(!strcmp(e.name, "abi") && e.found == ETHD_ABI + 5 && e.min == ETHD_ABI && e.max == ETHD_ABI);
  law.law.abi = ETHD_ABI;
  law.law.state_size = ETHD_STATE_MAX + 1;
  e = refused(&law.law);
  ck_assert(!strcmp(e.name, "smooth") && e.found == ETHD_STATE_MAX + 1 && e.min == 0 && e.max == ETHD_STATE_MAX);
}

/* A law of another kind, larger and smaller: neither is taken for what the setup calls it. */
TEST(test_law_of_another_kind) {
  ethd_setup s = ethd_setup_default();
  s.contact = (const ethd_contact_law *)(const void *)&ethd_transition_smooth;
  expect(s, ETHD_E_ARGUMENT, "contact");
  s.contact = (const ethd_contact_law *)(const void *)&ethd_tracking_pd;
  expect(s, ETHD_E_ARGUMENT, "contact");
}

static ethd_status too_stiff(const double *p, ethd_error *e) {
  if (p[0] <= 1000) return ETHD_OK;
  if (e) *e = (ethd_error){.status = ETHD_E_RANGE, .name = "k_e"};
  return ETHD_E_RANGE;
}

TEST(test_foreign_law) {
  ethd_contact_law law = ethd_contact_kelvin_voigt;
  ethd_setup s = ethd_setup_default();
  law.law.check = too_stiff;
  ethd_setup_contact(&s, &law);
  s.contact_p[0] = 999;
  ck_assert_int_eq(checked(&s), ETHD_OK);
  s.contact_p[0] = 1001;
  expect(s, ETHD_E_RANGE, "contact.k_e");
  law.law.abi = ETHD_ABI + 1;
  expect(s, ETHD_E_ABI, "contact.abi");
}

/* A check that only says no, as it may: it is asked with an error of its own, and its law's id says what is wrong. */
static ethd_status silent(const double *p, ethd_error *e) {
  ck_assert_ptr_nonnull(e);
  return p[0] > 1000 ? ETHD_E_GEOMETRY : ETHD_STATUS_BUSY;
}

TEST(test_silent_law) {
  ethd_contact_law law = ethd_contact_kelvin_voigt;
  ethd_setup s = ethd_setup_default();
  law.law.check = silent;
  ethd_setup_contact(&s, &law);
  s.contact_p[0] = 999;
  ck_assert_int_eq(checked(&s), ETHD_OK);
  s.contact_p[0] = 1001;
  expect(s, ETHD_E_GEOMETRY, "contact.kelvin-voigt");
  memset(&error, 0x7f, sizeof error); /* as it stands in a caller that never looked at it */
  ck_assert_int_eq(ethd_setup_check(&s, &error), ETHD_E_GEOMETRY);
  ck_assert(error.status == ETHD_E_GEOMETRY && error.line == 0 && isnan(error.found) && isnan(error.min));
  ck_assert_str_eq(error.name, "contact.kelvin-voigt");
}

/* Laws that nobody has checked yet are chosen without reading or writing beyond anything, and then refused. */
TEST(test_unchecked_laws) {
  static ethd_param rows[ETHD_PARAMS_MAX + 1];
  ethd_contact_law law = ethd_contact_kelvin_voigt;
  const ethd_law *const laws[] = {&law.law, NULL};
  ethd_setup s = ethd_setup_default();
  for (int i = 0; i <= ETHD_PARAMS_MAX; i++) rows[i] = (ethd_param){"p", "1", 0, 9, 7, "a number"};
  law.law.params = rows;
  law.law.param_count = ETHD_PARAMS_MAX + 1;
  for (int way = 0; way < 2; way++) {
    s = ethd_setup_default();
    if (way) ck_assert_int_eq(ethd_setup_choose(&s, "contact", law.law.id, laws, NULL), ETHD_OK);
    if (!way) ethd_setup_contact(&s, &law);
    ck_assert(s.contact_p[ETHD_PARAMS_MAX - 1] == 7 && s.transition == &ethd_transition_offset);
    ck_assert_uint_eq(ethd_setup_chosen(&s, ethd_setup_part_of("contact")).param_count, ETHD_PARAMS_MAX);
    expect(s, ETHD_E_TABLE, "contact.kelvin-voigt.param_count");
  }
  law.law.params = NULL;
  ethd_setup_contact(&s, &law);
  ck_assert(s.contact_p[0] == 0 && isnan(ethd_setup_get(&s, "contact.p")));
  expect(s, ETHD_E_TABLE, "contact.kelvin-voigt.param_count");
  law.law.param_count = 1;
  expect(s, ETHD_E_TABLE, "contact.kelvin-voigt.params");
  s = ethd_setup_default();
  ethd_setup_tracking(&s, NULL);
  expect(s, ETHD_E_ARGUMENT, "tracking");
  ethd_setup_contact(&s, NULL);
  ethd_setup_transition(&s, NULL);
  ck_assert(!s.tracking && !s.contact && !s.transition && s.tracking_p[0] == 0 && s.transition_p[0] == 0);
}

/* ---- how far a law looks ahead ---- */

static double range;

static double range_of(const double *p, double speed) {
  (void)p, (void)speed;
  return range;
}

TEST(test_range) {
  const double none = 2 * 0.012 + 0.012 - 0.0095;
  ethd_transition_law law = ethd_transition_smooth;
  ethd_setup s = ethd_setup_default();
  s.ring_radius = 0.012, s.finger_radius_max = 0.0095;
  ethd_setup_transition(&s, &law);
  ck_assert_double_eq_tol(ethd_setup_range(&s), none, 1e-15);
  law.range = range_of;
  range = 0.5;
  ck_assert_double_eq_tol(ethd_setup_range(&s), 0.512, 1e-15);
  const double ranges[] = {0, -1, INFINITY, NAN};
  for (int i = 0; i < 4; i++) {
    range = ranges[i];
    ck_assert_double_eq_tol(ethd_setup_range(&s), none, 1e-15);
  }
  range = 0.5;
  law.law.size = ETHD_TRANSITION_LAW_MIN; /* built before there was a range */
  ck_assert_double_eq_tol(ethd_setup_range(&s), none, 1e-15);
  ck_assert_int_eq(checked(&s), ETHD_OK);
}

/* At a distance of 30 mm a law that looks 40 mm ahead has a contact, one of 20 mm has none, and one that says nothing
   sensible looks as far as the library does. */
TEST(test_range_of_contacts) {
  static const struct {
    double range, d;
    int contacts;
  } cases[] = {{0.040, 0.030, 1}, {0.020, 0.030, 0},    {INFINITY, 0.030, 0}, {NAN, 0.030, 0},
               {-1, 0.030, 0},    {INFINITY, 0.002, 1}, {0.001, 0.002, 1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    ethd_transition_law law = ethd_transition_smooth;
    rig r;
    law.range = range_of;
    range = cases[i].range;
    rig_begin(&r, RIG_WALL, &law);
    motion m = rig_at(cases[i].d, 0.01, 0.001);
    ck_assert_int_eq(rig_step(&r, &m)->contacts, cases[i].contacts);
    rig_close(&r);
  }
}

/* ---- scenes ---- */

TEST(test_scene_of_another_reach) {
  rig r;
  ethd_scene *pruned;
  rig_open(&r, "circle 0.1 0 0.01\ncircle 0.3 0 0.01\ncircle 3 0 0.01\n");
  ethd_arm wide = {ETHD_ARM_PARALLEL, 0.4, 0.1};
  ck_assert_int_eq(ethd_scene_prune(r.scene, &wide, ethd_setup_range(&r.setup), &pruned, NULL), ETHD_OK);
  r.setup.scene = pruned;
  r.setup.arm = (ethd_arm){ETHD_ARM_PARALLEL, 0.3, 0.2}; /* as far out, and farther in */
  ck_assert_int_eq(checked(&r.setup), ETHD_E_RANGE);
  r.setup.arm = wide;
  ck_assert_int_eq(checked(&r.setup), ETHD_OK);
  ethd_scene_destroy(pruned);
  r.setup.scene = r.scene;
  rig_close(&r);
}

TEST(test_material_without_error) {
  rig r;
  rig_open(&r, "material odd k_e=-1\n");
  ck_assert_int_eq(ethd_setup_check(&r.setup, NULL), ETHD_E_RANGE);
  rig_close(&r);
}

/* ---- methods and names ---- */

TEST(test_methods_that_are_none) {
  ethd_setup s = ethd_setup_default();
  s.fit = ETHD_FIT_COUNT;
  expect(s, ETHD_E_UNKNOWN, "finger_fit.method");
  ck_assert_ptr_null(ethd_setup_chosen(&s, ethd_setup_part_of("finger_fit")).id);
  s = ethd_setup_default();
  s.velocity = ETHD_VELOCITY_COUNT;
  expect(s, ETHD_E_UNKNOWN, "velocity.method");
  s = ethd_setup_default();
  s.filter = ETHD_FILTER_COUNT;
  expect(s, ETHD_E_UNKNOWN, "finger_filter.method");
  s = ethd_setup_default();
  ethd_setup_filter(&s, (ethd_filter_method)-1);
  expect(s, ETHD_E_UNKNOWN, "finger_filter.method");
  ethd_setup_fit(&s, ETHD_FIT_COUNT);
  expect(s, ETHD_E_UNKNOWN, "finger_fit.method");
  ethd_setup_velocity(&s, (ethd_velocity_method)1000);
  expect(s, ETHD_E_UNKNOWN, "velocity.method");
  ck_assert(s.filter_p[3] == 0 && s.fit_p[0] == 0 && s.velocity_p[0] == 0);
}

TEST(test_names_with_a_tail) {
  ethd_setup s = ethd_setup_default();
  const char *const names[] = {"limits.reach[1]x", "limits.reach[1", "limits.reach[]", "limits.reach[x]",
                               "limits.reach[99]"};
  ck_assert_int_eq(ethd_setup_set(&s, "limits.reach[1]", 0.4, NULL), ETHD_OK);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    ck_assert_int_eq(ethd_setup_set(&s, names[i], 0.1, &error), ETHD_E_RANGE);
  ck_assert(s.limits.reach[1] == 0.4);
}

TEST(test_rows_that_are_none) {
  const ethd_fault none[] = {(ethd_fault)-1, ETHD_FAULT_COUNT};
  for (int i = 0; i < 2; i++) {
    ck_assert_str_eq(ethd_fault_bound(none[i]), "");
    ck_assert_str_eq(ethd_fault_sentence(none[i]), "an unknown fault");
    ck_assert(ethd_fault_reaction(none[i], 0) == ETHD_REACTION_NONE);
  }
}

/* A bad parameter's name is told without what steers a terminal, and cut where there is no room for it. */
TEST(test_names_in_errors) {
  const char *const names[] = {"del\x7f", "a{b", "abcdefghijklmnopqrstuvwxyz_012345",
                               "0123456789abcdefghijklmnopqrstu"};
  const char *const told[] = {"del?", "a{b", "abcdefghijklmnopqrstuvwxyz_012345", ""};
  for (int i = 0; i < 4; i++) {
    ethd_param row = {names[i], "1", 0, 1, 0, "a number"};
    ck_assert_int_eq(ethd_params_check_table(&row, 1, &error), i < 3 ? ETHD_E_TABLE : ETHD_OK);
    if (i < 3) ck_assert_str_eq(error.name, told[i]);
  }
}
