/* Laws from shared objects: the one to copy, the broken ones, the one that counts. */
#include "clock.h"
#include "ethd/plugin.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit/rig.h"

static const char *path_of(const char *name) {
  static char path[4096];
  const char *build = getenv("BUILD");
  snprintf(path, sizeof path, "%s/tests/plugins/%s.so", build ? build : "build", name);
  return path;
}

static const ethd_law *open_law(const char *name) {
  const ethd_plugin_entry *entry;
  ethd_error error;
  ethd_status status = ethd_plugin_open(path_of(name), &entry, &error);
  if (status != ETHD_OK) ck_abort_msg("%s: %s: %s", name, error.name, ethd_status_sentence(status));
  return entry->laws[0];
}

/* ---- refused ---- */

typedef struct refusal {
  const char *plugin;
  ethd_status status;
  const char *name, *sentence;
} refusal;

static const refusal refusals[] = {
    {"wrong_abi", ETHD_E_ABI, "ethd_plugin.abi", "a plugin of another ABI; rebuild it against these headers"},
    {"short_entry", ETHD_E_SIZE, "ethd_plugin.size", "a struct of other headers; compile again with this version's"},
    {"big_state", ETHD_E_STATE, "broken", "a law's state is over 512 bytes"},
    {"bad_table", ETHD_E_TABLE, "broken.gain", "a bad parameter table"},
    {"no_symbol", ETHD_E_SYMBOL, "ethd_plugin", "a plugin without the symbol ethd_plugin"},
    {"no_step", ETHD_E_ARGUMENT, "broken", "an argument is missing or contradicts another"},
    {"twice", ETHD_E_DUPLICATE, "broken", "a name or key occurs twice"},
    {"brief_escapes", ETHD_E_ARGUMENT, "broken", "an argument is missing or contradicts another"},
    {"brief_long", ETHD_E_ARGUMENT, "broken", "an argument is missing or contradicts another"},
    {"no_law", ETHD_E_RANGE, "ethd_plugin.law_count", "a value is out of its range"},
    {"many_laws", ETHD_E_RANGE, "ethd_plugin.law_count", "a value is out of its range"},
    {"entry_id", ETHD_E_ARGUMENT, "ethd_plugin", "an argument is missing or contradicts another"},
    {"entry_version", ETHD_E_ARGUMENT, "ethd_plugin", "an argument is missing or contradicts another"},
    {"entry_laws", ETHD_E_ARGUMENT, "ethd_plugin", "an argument is missing or contradicts another"},
    {"not_there", ETHD_E_LOAD, NULL, "a file that cannot be loaded as a plugin"},
};

TEST_LOOP(test_refused, 0, sizeof refusals / sizeof *refusals) {
  const refusal *c = &refusals[_i];
  const ethd_plugin_entry *entry = (const ethd_plugin_entry *)c;
  ethd_error error;
  for (int again = 0; again < 2; again++) {
    ck_assert_int_eq(ethd_plugin_open(path_of(c->plugin), &entry, &error), c->status);
    ck_assert_ptr_null(entry);
    ck_assert_str_eq(ethd_status_sentence(error.status), c->sentence);
    if (c->name) ck_assert_str_eq(error.name, c->name);
    entry = (const ethd_plugin_entry *)c;
    ck_assert_int_eq(ethd_plugin_open(path_of(c->plugin), &entry, NULL), c->status);
  }
}

TEST(test_files_that_are_none) {
  const char *const paths[] = {"", "/", "/dev/null", "./Makefile", NULL};
  const ethd_plugin_entry *entry;
  ethd_error error;
  for (int i = 0; i < 5; i++) {
    ck_assert_int_eq(ethd_plugin_open(paths[i], &entry, &error), ETHD_E_LOAD);
    ck_assert_ptr_null(entry);
  }
}

/* An id stands for one law of a kind; laws of different kinds may share it. */
TEST(test_several_laws) {
  const ethd_plugin_entry *entry;
  ck_assert_int_eq(ethd_plugin_open(path_of("pair"), &entry, NULL), ETHD_OK);
  ck_assert_uint_eq(entry->law_count, 4);
  ck_assert_str_eq(entry->laws[0]->id, "one");
  ck_assert_str_eq(entry->laws[1]->id, "one");
  ck_assert_str_eq(entry->laws[3]->id, "one");
  ck_assert(entry->laws[0]->kind == ETHD_CONTACT && entry->laws[1]->kind == ETHD_TRANSITION &&
            entry->laws[3]->kind == ETHD_TRACKING);
}

/* ---- stopped ---- */

/* Outside of the wall it works, behind it the controller goes safe and stays there until cleared. */
static void open_broken(rig *r, const char *name) {
  rig_open(r, RIG_WALL);
  ethd_setup_transition(&r->setup, (const ethd_transition_law *)(const void *)open_law(name));
  r->setup.limits.step_time = 300e-6;
  rig_start(r);
}

static void expect_stopped(rig *r, ethd_status status, ethd_fault fault, const char *sentence) {
  ethd_event e = rig_poll(r);
  ck_assert_int_eq(r->status, status);
  ck_assert(r->command.safe == 1 && r->command.torque[0] == 0 && r->command.torque[1] == 0);
  ck_assert(e.kind == ETHD_EVENT_FAULT && e.code == (int)fault);
  ck_assert_str_eq(ethd_fault_sentence(fault), sentence);
}

static ethd_sense sense_at(const rig *r, double d) {
  motion m = rig_at(d, 0.1, 0.001);
  return rig_sense(&r->setup.arm, &m);
}

TEST_LOOP(test_stopped, 0, 2) {
  static const struct {
    const char *plugin;
    ethd_status status;
    ethd_fault fault;
    const char *sentence;
  } cases[] = {
      {"says_nan", ETHD_E_NOT_FINITE, ETHD_FAULT_FINITE, "a law's output isn't a finite number in its range"},
      {"fails", ETHD_E_LAW, ETHD_FAULT_LAW, "a law reported a failure"},
  };
  rig r;
  open_broken(&r, cases[_i].plugin);
  ethd_sense out = sense_at(&r, 0.001), in = sense_at(&r, -0.001);
  ck_assert_int_eq(rig_try(&r, &out), ETHD_OK);
  rig_try(&r, &in);
  expect_stopped(&r, cases[_i].status, cases[_i].fault, cases[_i].sentence);
  ck_assert_int_lt(rig_try(&r, &out), 0);
  ethd_control_acknowledge(r.control);
  ck_assert_int_eq(rig_try(&r, &out), ETHD_OK);
  rig_close(&r);
}

/* The library has no clock: who calls step measures it and says so at the next one. */
TEST(test_over_its_time_budget) {
  rig r;
  open_broken(&r, "slow");
  ethd_sense out = sense_at(&r, 0.001), in = sense_at(&r, -0.001);
  ck_assert_int_eq(rig_try(&r, &out), ETHD_OK);
  int64_t start = ethd__clock_now();
  ck_assert_int_eq(rig_try(&r, &in), ETHD_OK);
  out.step_ns = ethd__clock_now() - start;
  ck_assert_int_gt(out.step_ns, 300000);
  rig_try(&r, &out);
  expect_stopped(&r, ETHD_E_BUDGET, ETHD_FAULT_BUDGET, "a step ran over its time budget");
  rig_close(&r);
}

/* ---- the law to copy ---- */

/* A free ring of 0.12 kg at 0.4 m/s, tracking off, 10 steps a tick: where it stands still. */
static double standstill(rig *r) {
  double d = 0.006, v = 0.4;
  r->setup.tracking_p[0] = r->setup.tracking_p[1] = 0;
  rig_start(r);
  for (int tick = 0; tick < 300 && v > 0.001; tick++) {
    motion m = rig_at(d, v, 0);
    const ethd_trace *t = rig_step(r, &m);
    for (int k = 0; k < 10; k++) {
      v -= (t->fe[0] + t->fd[0]) / 0.12 * 1e-4;
      d -= v * 1e-4;
    }
  }
  return d;
}

TEST(test_my_law) {
  const ethd_law *law = open_law("mylaw");
  ck_assert_str_eq(law->id, "brake-ahead");
  rig r;
  rig_open(&r, RIG_WALL);
  double behind = standstill(&r);
  rig_close(&r);
  rig_open(&r, RIG_WALL);
  ethd_setup_transition(&r.setup, (const ethd_transition_law *)(const void *)law);
  r.setup.transition_p[1] = 5; /* v^2 m / (2 F) = 1.92 mm, within d_beta */
  double ahead = standstill(&r);
  rig_close(&r);
  ck_assert_double_lt(behind, -0.0004); /* VO-B: m / B_d (v - v_th) behind the wall at least */
  ck_assert_double_gt(ahead, -0.0004);  /* a tick's way is 0.4 mm */
  ck_assert_double_lt(ahead, 0.0004);
}

/* Posted, checked, swapped like a law of the library. */
TEST(test_my_law_is_nothing_special) {
  rig r;
  ethd_error error;
  rig_begin(&r, RIG_WALL, NULL);
  motion m = rig_at(-0.001, 0.1, 0.001);
  rig_step(&r, &m);
  ethd_setup_transition(&r.setup, (const ethd_transition_law *)(const void *)open_law("mylaw"));
  ck_assert(r.setup.transition_p[0] == 0.12 && r.setup.transition_p[3] == 0.1);
  r.setup.transition_p[1] = -1;
  ck_assert_int_eq(ethd_control_post(r.control, &r.setup, &error), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "transition.force");
  r.setup.transition_p[1] = 4;
  rig_post(&r);
  ethd_sense s = sense_at(&r, -0.0012);
  ethd_command told;
  ck_assert_int_eq(ethd_control_rehearse(r.control, &s, &told), ETHD_OK);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert_mem_eq(told.torque, r.command.torque, sizeof told.torque);
  ck_assert_int_eq(r.trace.state, ETHD_BRAKING);
  rig_close(&r);
}

/* ---- the law that counts ---- */

/* Once a tick, twice at a swap; and its torque is pd's to the last bit. */
TEST(test_counting) {
  const ethd_law *law = open_law("counting");
  void *handle = dlopen(path_of("counting"), RTLD_NOW | RTLD_NOLOAD);
  ck_assert_ptr_nonnull(handle);
  const long *steps = dlsym(handle, "counting_steps");
  rig r, plain;
  rig_open(&r, RIG_WALL);
  rig_open(&plain, RIG_WALL);
  ethd_setup_tracking(&r.setup, (const ethd_tracking_law *)(const void *)law);
  rig_start(&r);
  rig_start(&plain);
  for (int tick = 0; tick < 100; tick++) {
    motion m = rig_at(0.005 - 0.0001 * tick, 0.1, 0.001 * sin(tick));
    rig_step(&r, &m);
    rig_step(&plain, &m);
    ck_assert_mem_eq(&r.trace, &plain.trace, sizeof r.trace);
  }
  ck_assert_int_eq(*steps, 100);
  rig_post(&r);
  motion m = rig_at(0, 0.1, 0);
  rig_step(&r, &m);
  ck_assert_int_eq(*steps, 102);
  dlclose(handle);
  rig_close(&r);
  rig_close(&plain);
}
