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

/* Each type with its size, 0 where it may grow at its end, and its fields with theirs, in order: offsets follow. */
typedef struct field {
  const char *name;
  size_t at, bytes, expected;
} field;

typedef struct layout {
  const char *type;
  size_t bytes, align, expected;
  field fields[32];
} layout;

#define TEXT_OF(word) #word
#define TEXT(word) TEXT_OF(word)
#define TYPE(expected) TEXT(T), sizeof(T), _Alignof(T), expected
#define AT(name, expected) {#name, offsetof(T, name), sizeof(((T *)0)->name), expected}

static const layout layouts[] = {
/* Frozen within an ABI. */
#define T ethd_param
    {TYPE(48), {AT(name, 8), AT(unit, 8), AT(min, 8), AT(max, 8), AT(def, 8), AT(brief, 8)}},
#undef T
/* Given to a law by the controller: they grow at their ends. */
#define T ethd_contact
    {TYPE(128),
     {AT(point, 24), AT(n, 24), AT(d_re, 8), AT(d_fe, 8), AT(d_fr, 8), AT(v, 8), AT(v_f, 8), AT(d_beta, 8),
      AT(period, 8), AT(age, 8), AT(object, 4), AT(body, 4), AT(facts, 8)}},
#undef T
#define T ethd_facts
    {TYPE(112),
     {AT(mass, 8), AT(force, 8), AT(applied, 8), AT(friction, 8), AT(viscous, 8), AT(delay, 8), AT(lag, 8),
      AT(ring_radius, 8), AT(finger_radius, 8), AT(finger_age, 8), AT(finger_a, 8), AT(memory, 8), AT(acceleration, 8),
      AT(room, 8)}},
#undef T
#define T ethd_past
    {TYPE(48), {AT(offset, 8), AT(d_re, 8), AT(v, 8), AT(age, 8), AT(since, 8), AT(state, 4)}},
#undef T
#define T ethd_vec3
    {TYPE(24), {AT(x, 8), AT(y, 8), AT(z, 8)}},
#undef T
#define T ethd_vec
    {TYPE(16), {AT(x, 8), AT(y, 8)}},
#undef T
#define T ethd_tracking_in
    {TYPE(88), {AT(eps_q, 16), AT(eps_q_dot, 16), AT(eps_x, 16), AT(eps_v, 16), AT(period, 8), AT(finger_v, 16)}},
#undef T
#define T ethd_ruling
    {TYPE(72),
     {AT(beta, 8), AT(share, 8), AT(offset, 8), AT(damping, 8), AT(feed, 8), AT(argument, 8), AT(state, 4), AT(lead, 8),
      AT(speed, 8)}},
#undef T
/* May grow at their ends: nothing here moves, and a plugin of today stays long enough. */
#define T ethd_law
    {TYPE(64),
     {AT(size, 4), AT(abi, 4), AT(kind, 4), AT(state_size, 4), AT(id, 8), AT(brief, 8), AT(params, 8),
      AT(param_count, 4), AT(check, 8), AT(reset, 8)}},
#undef T
#define T ethd_tracking_law
    {TYPE(0), {AT(law, 64), AT(step, 8), AT(gains, 8), AT(force, 8), AT(velocity, 8)}},
#undef T
#define T ethd_contact_law
    {TYPE(0), {AT(law, 64), AT(step, 8), AT(gains, 8)}},
#undef T
#define T ethd_transition_law
    {TYPE(0), {AT(law, 64), AT(step, 8), AT(range, 8), AT(adopt, 8), AT(gains, 8)}},
#undef T
#define T ethd_plugin_entry
    {TYPE(0), {AT(size, 4), AT(abi, 4), AT(id, 8), AT(version, 8), AT(laws, 8), AT(law_count, 4)}},
#undef T
/* A driver's table may grow at its end; so may the struct that it is opened with. */
#define T ethd_driver
    {TYPE(0), {AT(size, 4),    AT(abi, 4),        AT(id, 8),          AT(brief, 8), AT(params, 8),   AT(param_count, 4),
               AT(keys, 8),    AT(open, 8),       AT(start, 8),       AT(read, 8),  AT(write, 8),    AT(units, 8),
               AT(service, 8), AT(safe, 8),       AT(stop, 8),        AT(close, 8), AT(limits, 8),   AT(figures, 8),
               AT(remark, 8),  AT(clear, 8),      AT(home, 8),        AT(why, 8),   AT(dynamics, 8), AT(prepare, 8),
               AT(joints, 8),  AT(read_space, 8), AT(write_space, 8), AT(able, 8),  AT(safe_is, 4)}},
#undef T
#define T ethd_device_def
    {TYPE(0),
     {AT(setup, 8), AT(settings, 8), AT(setting_count, 4), AT(folder, 8), AT(file, 8), AT(is_virtual, 4),
      AT(space, 8)}},
#undef T
/* A driver reads arrays of ethd_setting and writes arrays of ethd_figure. */
#define T ethd_setting
    {TYPE(24), {AT(key, 8), AT(value, 8), AT(line, 4)}},
#undef T
#define T ethd_figure
    {TYPE(24), {AT(name, 8), AT(unit, 8), AT(value, 8)}},
#undef T
/* A driver fills these or returns them: their sizes are in ETHD_DRIVER_ABI. */
#define T ethd_sense
    {TYPE(512),
     {AT(time_ns, 8), AT(have, 8), AT(missed, 8), AT(step_ns, 8), AT(faults, 8), AT(grave, 8), AT(q, 16), AT(dq, 16),
      AT(finger, 16), AT(finger_v, 16), AT(sample_ns, 8), AT(centre, 16), AT(ring, 16), AT(rays, 128), AT(bodies, 192),
      AT(finger_noise, 8), AT(commanded, 16), AT(age, 16)}},
#undef T
#define T ethd_space_sense
    {TYPE(312),
     {AT(time_ns, 8), AT(have, 8), AT(missed, 8), AT(step_ns, 8), AT(faults, 8), AT(grave, 8), AT(x, 24), AT(v, 24),
      AT(normal, 24), AT(finger, 24), AT(finger_v, 24), AT(sample_ns, 8), AT(reading, 24), AT(reading_v, 24),
      AT(reading_noise, 8), AT(reading_v_noise, 8), AT(ability, 48), AT(commanded, 24)}},
#undef T
#define T ethd_limits
    {TYPE(192),
     {AT(size, 4), AT(latch, 4), AT(torque, 8), AT(torque_rate, 8), AT(speed, 8), AT(workspace, 32), AT(reach, 16),
      AT(joints, 32), AT(margin, 8), AT(energy, 8), AT(nominal_torque, 8), AT(heat_time, 8), AT(step_time, 8),
      AT(gap, 8), AT(finger_age, 8), AT(finger_lost, 8), AT(clean_time, 8), AT(stop_time, 8)}},
#undef T
#define T ethd_dynamics
    {TYPE(40), {AT(mass, 16), AT(friction, 8), AT(viscous, 8), AT(delay, 8)}},
#undef T
#define T ethd_command
    {TYPE(24), {AT(torque, 16), AT(safe, 4)}},
#undef T
#define T ethd_space_command
    {TYPE(56), {AT(value, 24), AT(normal, 24), AT(kind, 4), AT(safe, 4)}},
#undef T
#define T ethd_ability
    {TYPE(48), {AT(speed, 8), AT(acceleration, 8), AT(delay, 8), AT(mass, 8), AT(force, 8), AT(friction, 8)}},
#undef T
/* Written by the library for the refusal of what else differs, so its size never changes. */
#define T ethd_error
    {TYPE(96), {AT(status, 4)}},
#undef T
};

TEST_LOOP(test_layout, 0, sizeof(void *) == 8 ? sizeof layouts / sizeof *layouts : 0) {
  const layout *l = &layouts[_i];
  size_t at = 0;
  for (const field *f = l->fields; f->name; f++) {
    const size_t align = f->expected % 8 ? 4 : 8;
    at = (at + align - 1) / align * align;
    ck_assert_msg(f->at == at && f->bytes == f->expected, "%s.%s: %zu bytes at %zu, not %zu at %zu", l->type, f->name,
                  f->bytes, f->at, f->expected, at);
    at += f->bytes;
  }
  ck_assert_msg(l->align == 8 && (l->expected == 0 || l->bytes == l->expected), "%s: %zu bytes", l->type, l->bytes);
}

#if defined(__LP64__)
_Static_assert(ETHD_TRACKING_LAW_MIN == 72 && ETHD_CONTACT_LAW_MIN == 72 && ETHD_TRANSITION_LAW_MIN == 72, "least");
_Static_assert(ETHD_PLUGIN_MIN == 36, "least");
_Static_assert(ETHD_DRIVER_MIN == 128, "least");
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
