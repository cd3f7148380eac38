/* What a plugin or a driver was compiled against may not move: offsets and sizes of ABI 1, and of the drivers' ABI 4, on
   a 64-bit machine, and the tables of every law that the library brings. */
#include <float.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "ethd/control.h"
#include "ethd/driver.h"
#include "ethd/ethd.h"
#include "ethd/plugin.h"
#include "unit/rig.h"

#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "excess precision changes the bits"
#endif

#if defined(__LP64__)
#define AT(type, field, offset, bytes)                       \
  _Static_assert(offsetof(type, field) == (offset), #field); \
  _Static_assert(sizeof(((type *)0)->field) == (bytes), #field)
#define SIZE(type, bytes, align)                  \
  _Static_assert(sizeof(type) == (bytes), #type); \
  _Static_assert(_Alignof(type) == (align), #type)

/* Frozen within an ABI. */
SIZE(ethd_param, 48, 8);
AT(ethd_param, name, 0, 8);
AT(ethd_param, unit, 8, 8);
AT(ethd_param, min, 16, 8);
AT(ethd_param, max, 24, 8);
AT(ethd_param, def, 32, 8);
AT(ethd_param, brief, 40, 8);

/* Given to a law by the controller: they grow at their ends. */
SIZE(ethd_contact, 128, 8);
AT(ethd_contact, point, 0, 24);
AT(ethd_contact, n, 24, 24);
AT(ethd_contact, d_re, 48, 8);
AT(ethd_contact, d_fe, 56, 8);
AT(ethd_contact, d_fr, 64, 8);
AT(ethd_contact, v, 72, 8);
AT(ethd_contact, v_f, 80, 8);
AT(ethd_contact, d_beta, 88, 8);
AT(ethd_contact, period, 96, 8);
AT(ethd_contact, age, 104, 8);
AT(ethd_contact, object, 112, 4);
AT(ethd_contact, body, 116, 4);
AT(ethd_contact, facts, 120, 8);

SIZE(ethd_facts, 112, 8);
AT(ethd_facts, mass, 0, 8);
AT(ethd_facts, force, 8, 8);
AT(ethd_facts, applied, 16, 8);
AT(ethd_facts, friction, 24, 8);
AT(ethd_facts, viscous, 32, 8);
AT(ethd_facts, delay, 40, 8);
AT(ethd_facts, lag, 48, 8);
AT(ethd_facts, ring_radius, 56, 8);
AT(ethd_facts, finger_radius, 64, 8);
AT(ethd_facts, finger_age, 72, 8);
AT(ethd_facts, finger_a, 80, 8);
AT(ethd_facts, memory, 88, 8);
AT(ethd_facts, acceleration, 96, 8);
AT(ethd_facts, room, 104, 8);

SIZE(ethd_past, 48, 8);
AT(ethd_past, offset, 0, 8);
AT(ethd_past, d_re, 8, 8);
AT(ethd_past, v, 16, 8);
AT(ethd_past, age, 24, 8);
AT(ethd_past, since, 32, 8);
AT(ethd_past, state, 40, 4);

SIZE(ethd_vec3, 24, 8);
AT(ethd_vec3, x, 0, 8);
AT(ethd_vec3, y, 8, 8);
AT(ethd_vec3, z, 16, 8);

SIZE(ethd_vec, 16, 8);
AT(ethd_vec, x, 0, 8);
AT(ethd_vec, y, 8, 8);

SIZE(ethd_tracking_in, 88, 8);
AT(ethd_tracking_in, eps_q, 0, 16);
AT(ethd_tracking_in, eps_q_dot, 16, 16);
AT(ethd_tracking_in, eps_x, 32, 16);
AT(ethd_tracking_in, eps_v, 48, 16);
AT(ethd_tracking_in, period, 64, 8);
AT(ethd_tracking_in, finger_v, 72, 16);

SIZE(ethd_ruling, 72, 8);
AT(ethd_ruling, beta, 0, 8);
AT(ethd_ruling, share, 8, 8);
AT(ethd_ruling, offset, 16, 8);
AT(ethd_ruling, damping, 24, 8);
AT(ethd_ruling, feed, 32, 8);
AT(ethd_ruling, argument, 40, 8);
AT(ethd_ruling, state, 48, 4);
AT(ethd_ruling, lead, 56, 8);
AT(ethd_ruling, speed, 64, 8);

/* May grow at their ends: nothing here moves, and a plugin of today stays long enough. */
AT(ethd_law, size, 0, 4);
AT(ethd_law, abi, 4, 4);
AT(ethd_law, kind, 8, 4);
AT(ethd_law, state_size, 12, 4);
AT(ethd_law, id, 16, 8);
AT(ethd_law, brief, 24, 8);
AT(ethd_law, params, 32, 8);
AT(ethd_law, param_count, 40, 4);
AT(ethd_law, check, 48, 8);
AT(ethd_law, reset, 56, 8);
SIZE(ethd_law, 64, 8);
AT(ethd_tracking_law, step, 64, 8);
AT(ethd_tracking_law, gains, 72, 8);
AT(ethd_tracking_law, force, 80, 8);
AT(ethd_tracking_law, velocity, 88, 8);
AT(ethd_contact_law, step, 64, 8);
AT(ethd_contact_law, gains, 72, 8);
AT(ethd_transition_law, step, 64, 8);
AT(ethd_transition_law, range, 72, 8);
AT(ethd_transition_law, adopt, 80, 8);
AT(ethd_transition_law, gains, 88, 8);
_Static_assert(ETHD_TRACKING_LAW_MIN == 72 && ETHD_CONTACT_LAW_MIN == 72 && ETHD_TRANSITION_LAW_MIN == 72, "least");

AT(ethd_plugin_entry, size, 0, 4);
AT(ethd_plugin_entry, abi, 4, 4);
AT(ethd_plugin_entry, id, 8, 8);
AT(ethd_plugin_entry, version, 16, 8);
AT(ethd_plugin_entry, laws, 24, 8);
AT(ethd_plugin_entry, law_count, 32, 4);
_Static_assert(ETHD_PLUGIN_MIN == 36, "least");

/* A driver's table may grow at its end; so may the struct that it is opened with. */
AT(ethd_driver, size, 0, 4);
AT(ethd_driver, abi, 4, 4);
AT(ethd_driver, id, 8, 8);
AT(ethd_driver, brief, 16, 8);
AT(ethd_driver, params, 24, 8);
AT(ethd_driver, param_count, 32, 4);
AT(ethd_driver, keys, 40, 8);
AT(ethd_driver, open, 48, 8);
AT(ethd_driver, start, 56, 8);
AT(ethd_driver, read, 64, 8);
AT(ethd_driver, write, 72, 8);
AT(ethd_driver, units, 80, 8);
AT(ethd_driver, service, 88, 8);
AT(ethd_driver, safe, 96, 8);
AT(ethd_driver, stop, 104, 8);
AT(ethd_driver, close, 112, 8);
AT(ethd_driver, limits, 120, 8);
AT(ethd_driver, figures, 128, 8);
AT(ethd_driver, remark, 136, 8);
AT(ethd_driver, clear, 144, 8);
AT(ethd_driver, home, 152, 8);
AT(ethd_driver, why, 160, 8);
AT(ethd_driver, dynamics, 168, 8);
AT(ethd_driver, prepare, 176, 8);
AT(ethd_driver, joints, 184, 8);
AT(ethd_driver, read_space, 192, 8);
AT(ethd_driver, write_space, 200, 8);
AT(ethd_driver, able, 208, 8);
AT(ethd_driver, safe_is, 216, 4);
_Static_assert(ETHD_DRIVER_MIN == 128, "least");

AT(ethd_device_def, setup, 0, 8);
AT(ethd_device_def, settings, 8, 8);
AT(ethd_device_def, setting_count, 16, 4);
AT(ethd_device_def, folder, 24, 8);
AT(ethd_device_def, file, 32, 8);
AT(ethd_device_def, is_virtual, 40, 4);
AT(ethd_device_def, space, 48, 8);

/* A driver reads arrays of ethd_setting and writes arrays of ethd_figure. */
SIZE(ethd_setting, 24, 8);
AT(ethd_setting, key, 0, 8);
AT(ethd_setting, value, 8, 8);
AT(ethd_setting, line, 16, 4);
SIZE(ethd_figure, 24, 8);
AT(ethd_figure, name, 0, 8);
AT(ethd_figure, unit, 8, 8);
AT(ethd_figure, value, 16, 8);

/* A driver fills these or returns them: their sizes are in ETHD_DRIVER_ABI. */
SIZE(ethd_sense, 512, 8);
AT(ethd_sense, time_ns, 0, 8);
AT(ethd_sense, have, 8, 8);
AT(ethd_sense, missed, 16, 8);
AT(ethd_sense, step_ns, 24, 8);
AT(ethd_sense, faults, 32, 8);
AT(ethd_sense, grave, 40, 8);
AT(ethd_sense, q, 48, 16);
AT(ethd_sense, dq, 64, 16);
AT(ethd_sense, finger, 80, 16);
AT(ethd_sense, finger_v, 96, 16);
AT(ethd_sense, sample_ns, 112, 8);
AT(ethd_sense, centre, 120, 16);
AT(ethd_sense, ring, 136, 16);
AT(ethd_sense, rays, 152, 128);
AT(ethd_sense, bodies, 280, 192);
AT(ethd_sense, finger_noise, 472, 8);
AT(ethd_sense, commanded, 480, 16);
AT(ethd_sense, age, 496, 16);

SIZE(ethd_space_sense, 312, 8);
AT(ethd_space_sense, time_ns, 0, 8);
AT(ethd_space_sense, have, 8, 8);
AT(ethd_space_sense, missed, 16, 8);
AT(ethd_space_sense, step_ns, 24, 8);
AT(ethd_space_sense, faults, 32, 8);
AT(ethd_space_sense, grave, 40, 8);
AT(ethd_space_sense, x, 48, 24);
AT(ethd_space_sense, v, 72, 24);
AT(ethd_space_sense, normal, 96, 24);
AT(ethd_space_sense, finger, 120, 24);
AT(ethd_space_sense, finger_v, 144, 24);
AT(ethd_space_sense, sample_ns, 168, 8);
AT(ethd_space_sense, reading, 176, 24);
AT(ethd_space_sense, reading_v, 200, 24);
AT(ethd_space_sense, reading_noise, 224, 8);
AT(ethd_space_sense, reading_v_noise, 232, 8);
AT(ethd_space_sense, ability, 240, 48);
AT(ethd_space_sense, commanded, 288, 24);

SIZE(ethd_limits, 192, 8);
AT(ethd_limits, size, 0, 4);
AT(ethd_limits, latch, 4, 4);
AT(ethd_limits, torque, 8, 8);
AT(ethd_limits, torque_rate, 16, 8);
AT(ethd_limits, speed, 24, 8);
AT(ethd_limits, workspace, 32, 32);
AT(ethd_limits, reach, 64, 16);
AT(ethd_limits, joints, 80, 32);
AT(ethd_limits, margin, 112, 8);
AT(ethd_limits, energy, 120, 8);
AT(ethd_limits, nominal_torque, 128, 8);
AT(ethd_limits, heat_time, 136, 8);
AT(ethd_limits, step_time, 144, 8);
AT(ethd_limits, gap, 152, 8);
AT(ethd_limits, finger_age, 160, 8);
AT(ethd_limits, finger_lost, 168, 8);
AT(ethd_limits, clean_time, 176, 8);
AT(ethd_limits, stop_time, 184, 8);

SIZE(ethd_dynamics, 40, 8);
AT(ethd_dynamics, mass, 0, 16);
AT(ethd_dynamics, friction, 16, 8);
AT(ethd_dynamics, viscous, 24, 8);
AT(ethd_dynamics, delay, 32, 8);

SIZE(ethd_command, 24, 8);
AT(ethd_command, torque, 0, 16);
AT(ethd_command, safe, 16, 4);

SIZE(ethd_space_command, 56, 8);
AT(ethd_space_command, value, 0, 24);
AT(ethd_space_command, normal, 24, 24);
AT(ethd_space_command, kind, 48, 4);
AT(ethd_space_command, safe, 52, 4);

SIZE(ethd_ability, 48, 8);
AT(ethd_ability, speed, 0, 8);
AT(ethd_ability, acceleration, 8, 8);
AT(ethd_ability, delay, 16, 8);
AT(ethd_ability, mass, 24, 8);
AT(ethd_ability, force, 32, 8);
AT(ethd_ability, friction, 40, 8);

/* Written by the library for the refusal of what else differs, so its size never changes. */
SIZE(ethd_error, 96, 8);
#endif

_Static_assert(ETHD_ABI == 1 && ETHD_STATE_MAX == 512 && ETHD_PARAMS_MAX == 16, "ABI 1");
_Static_assert(ETHD_DRIVER_ABI >> 28 == 4 && ETHD_MESSAGE_MAX == 512, "the drivers' ABI 4");
_Static_assert(ETHD_HAVE_DQ == 1 && ETHD_HAVE_FINGER == 2 && ETHD_HAVE_START == 4 && ETHD_HAVE_CENTRE == 8 &&
                   ETHD_HAVE_RAYS == 16 && ETHD_HAVE_RING == 32 && ETHD_HAVE_BODY == 64 && ETHD_HAVE_WORLD == 1024 &&
                   ETHD_HAVE_COMMANDED == 2048 && ETHD_HAVE_AGE == 4096,
               "what a sense has");
_Static_assert(ETHD_TRACKING == 0 && ETHD_CONTACT == 1 && ETHD_TRANSITION == 2, "kinds");
_Static_assert(ETHD_TRANSPARENT == 0 && ETHD_BRAKING == 1 && ETHD_VO == 2, "states");

/* The rows of a recording: 8-byte fields without a hole. */
#define COUNT_1(type, name) +1
#define COUNT_2(type, name) +2
#define COUNT_4(type, name) +4
#define COUNT_16(type, name) +16
#define COUNT_24(type, name) +24
#define COUNT(type, name, count, unit, brief) COUNT_##count(type, name)
_Static_assert(sizeof(ethd_sense) == 8 * (0 ETHD_SENSE_FIELDS(COUNT)), "sense");
_Static_assert(sizeof(ethd_trace) == sizeof(ethd_sense) + 8 * (0 ETHD_TRACE_FIELDS(COUNT)), "trace");

TEST(test_every_law) {
  static const struct {
    const char *id;
    int kind;
  } rows[] = {{"pd", ETHD_TRACKING},
              {"follow", ETHD_TRACKING},
              {"kelvin-voigt", ETHD_CONTACT},
              {"spring", ETHD_CONTACT},
              {"hunt-crossley", ETHD_CONTACT},
              {"abrupt", ETHD_TRANSITION},
              {"smooth", ETHD_TRANSITION},
              {"offset", ETHD_TRANSITION},
              {"predictive", ETHD_TRANSITION},
              {"approach", ETHD_TRANSITION},
              {NULL, 0}};
  ethd_error error;
  for (int i = 0; rows[i].id || ethd_laws[i]; i++) {
    ck_assert_msg(rows[i].id && ethd_laws[i], "law %d: %s stands on one side only", i,
                  rows[i].id ? rows[i].id : ethd_laws[i]->id);
    ck_assert_str_eq(ethd_laws[i]->id, rows[i].id);
    ck_assert_int_eq(ethd_law_check(ethd_laws[i], &error), ETHD_OK);
    ck_assert_int_eq(ethd_laws[i]->kind, rows[i].kind);
    double p[ETHD_PARAMS_MAX];
    ethd_params_default(ethd_laws[i]->params, ethd_laws[i]->param_count, p);
    ck_assert_int_eq(ethd_params_check(ethd_laws[i]->params, ethd_laws[i]->param_count, p, &error), ETHD_OK);
  }
}

/* A law of an older header is shorter and runs; one that stops short of step is refused, and one of a newer header,
   which may count on what this library doesn't give. */
TEST(test_sizes_of_laws) {
  ethd_transition_law law = ethd_transition_smooth;
  ck_assert_ptr_eq(ethd_law_gains(&law.law), law.gains);
  law.law.size = ETHD_TRANSITION_LAW_MIN;
  ck_assert_int_eq(ethd_law_check(&law.law, NULL), ETHD_OK);
  ck_assert_ptr_null(ethd_law_gains(&law.law));
  law.law.size = sizeof law + 1;
  ck_assert_int_eq(ethd_law_check(&law.law, NULL), ETHD_E_SIZE);
  law.law.size = ETHD_TRANSITION_LAW_MIN - 1;
  ck_assert_int_eq(ethd_law_check(&law.law, NULL), ETHD_E_SIZE);
  law.law.size = 0;
  ck_assert_int_eq(ethd_law_check(&law.law, NULL), ETHD_E_SIZE);
}

TEST(test_law_check) {
  static const char *const bad_ids[] = {NULL, "", "Smooth", "a b", "a_b", "x1234567890123456789012345678901"};
  ethd_error error;
  ck_assert_int_eq(ethd_law_check(NULL, &error), ETHD_E_ARGUMENT);
  for (int i = 0; i < 6; i++) {
    ethd_transition_law law = ethd_transition_smooth;
    law.law.id = bad_ids[i];
    ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_ARGUMENT);
  }
  ethd_transition_law law = ethd_transition_smooth;
  law.law.id = "x123456789012345678901234567890";
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_OK);
  law.law.brief = "";
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_ARGUMENT);
  law.law.brief = NULL;
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_ARGUMENT);
  law = ethd_transition_offset;
  const ethd_gains strange = {NULL, "k_e"};
  law.gains = &strange;
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_TABLE);
  ck_assert_str_eq(error.name, "offset.gains");
  law = ethd_transition_smooth;
  law.law.kind = 3;
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_ARGUMENT);
  law = ethd_transition_smooth;
  law.law.state_size = 512;
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_OK);
  law.law.state_size = 513;
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_STATE);
  ck_assert(error.found == 513 && error.max == 512);
  law = ethd_transition_smooth;
  law.law.params = NULL;
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_TABLE);
  law.law.abi = ETHD_ABI + 1; /* said before all else: nothing behind it can be trusted */
  ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_ABI);
}

/* The whole block of 512 bytes is a law's own, zeroed before reset, and nobody else's. */
static ethd_status greedy_step(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  double *block = state;
  (void)p;
  ck_assert_double_eq(block[63], c->object + 100 * block[0]);
  for (int i = 1; i < 63; i++) ck_assert_double_eq(block[i], block[0] * i);
  block[0]++;
  for (int i = 1; i < 63; i++) block[i] = block[0] * i;
  block[63] = c->object + 100 * block[0];
  out->state = ETHD_VO;
  return ETHD_OK;
}

static void greedy_reset(const double *p, void *state) ETHD_RT {
  double *block = state;
  (void)p;
  for (int i = 0; i < 64; i++) ck_assert_double_eq(block[i], 0);
}

#define GREEDY                                                                                                       \
  {.law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, 512, "greedy", "all of its state", NULL, 0, NULL, \
           greedy_reset},                                                                                            \
   .step = greedy_step}
static const ethd_transition_law greedy = GREEDY, greedy_too = GREEDY;

TEST(test_state_blocks) {
  rig r;
  /* one object only: its number is 0 in a block's first tick, when block[63] is 0 too */
  rig_begin(&r, "polygon 0 0 0.6 0 0.6 0.238 0.238 0.238 0.238 0.6 0 0.6\n", NULL);
  for (int tick = 0; tick < 100; tick++) {
    motion m = {{0.249 + 0.00005 * tick, 0.249}, {0, 0}, {0.249, 0.249}, {0, 0}};
    if (tick % 10 == 0) {
      ethd_setup_transition(&r.setup, tick % 20 ? &greedy_too : &greedy);
      rig_post(&r);
    }
    rig_step(&r, &m);
    ck_assert_int_eq(r.trace.contacts, 2);
    if (tick % 35 == 34) ethd_control_reset(r.control);
  }
  rig_close(&r);
}

/* The version's text and its numbers say the same. */
TEST(test_version) {
  int major, minor, patch, end = 0;
  ck_assert_int_eq(sscanf(ETHD_VERSION, "%d.%d.%d%n", &major, &minor, &patch, &end), 3);
  ck_assert_uint_eq(end, strlen(ETHD_VERSION));
  ck_assert_int_eq(major, ETHD_VERSION_MAJOR);
  ck_assert_int_eq(minor, ETHD_VERSION_MINOR);
  ck_assert_int_eq(patch, ETHD_VERSION_PATCH);
  ck_assert_int_eq(10000 * major + 100 * minor + patch, ETHD_VERSION_NUMBER);
  ck_assert(minor < 100 && patch < 100); /* else the number doesn't grow with the version */
}

#if ETHD_VERSION_NUMBER < 100
#error "the preprocessor compares versions"
#endif
