/* Laws that aren't built in: their side effects are found at the same tick and undone. */
#include <fenv.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "control/state.h"
#include "ethd/plugin.h"
#include "unit/rig.h"

static const ethd_transition_law *open_law(const char *name) {
  char path[4096];
  const char *build = getenv("BUILD");
  const ethd_plugin_entry *entry;
  snprintf(path, sizeof path, "%s/tests/plugins/%s.so", build ? build : "build", name);
  ck_assert_int_eq(ethd_plugin_open(path, &entry, NULL), ETHD_OK);
  return (const ethd_transition_law *)(const void *)entry->laws[0];
}

/* The value of a LAW event: the kind of law, and what it did. */
static double told(ethd_kind kind, ethd_status status) { return 100 * (int)kind - (int)status; }

static ethd_sense sense_at(const rig *r, double d) {
  motion m = rig_at(d, 0.1, 0.001);
  return rig_sense(&r->setup.arm, &m);
}

/* Before the surface all is well; behind it this fault comes at the same tick, with zero torque. */
static void expect_found(rig *r, ethd_kind kind, ethd_status status) {
  ethd_sense out = sense_at(r, 0.001), in = sense_at(r, -0.001);
  ck_assert_int_eq(rig_try(r, &out), ETHD_OK);
  ck_assert_int_eq(rig_try(r, &in), ETHD_E_LAW);
  ck_assert(r->command.safe == 1 && r->command.torque[0] == 0 && r->command.torque[1] == 0);
  ethd_event e = rig_poll(r);
  if (e.kind == ETHD_EVENT_CLEARED) e = rig_poll(r);
  ck_assert(e.kind == ETHD_EVENT_FAULT && e.code == ETHD_FAULT_LAW);
  ck_assert(e.value == told(kind, status));
}

/* ---- beside the state block ---- */

TEST_LOOP(test_writes_past, 0, 6) {
  rig r;
  rig_open(&r, RIG_WALL);
  ethd_setup_transition(&r.setup, open_law("writes_past"));
  r.setup.transition_p[0] = _i;
  rig_start(&r);
  expect_found(&r, ETHD_TRANSITION, ETHD_E_FENCE);
  /* the overwritten bytes are restored, so that the next violation is found, too */
  ethd_control_acknowledge(r.control);
  expect_found(&r, ETHD_TRANSITION, ETHD_E_FENCE);
  rig_close(&r);
}

/* All of its state, to the last byte, is a law's own. */
static ethd_status fills(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  (void)p, (void)in;
  memset(state, 0x5a, 13);
  tau[0] = tau[1] = 0;
  return ETHD_OK;
}

static ethd_status fills_more(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  ((char *)state)[13] = 0;
  return fills(p, state, in, tau);
}

static void reset_more(const double *p, void *state) {
  (void)p;
  ((char *)state)[-1] = 0;
}

static void reset_rounding(const double *p, void *state) {
  (void)p, (void)state;
  fesetround(FE_UPWARD);
}

/* The last byte of the fence behind the block, which no whole word of the pattern ends at. */
static ethd_status fills_far(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  ((char *)state)[sizeof(ethd__law_block) - offsetof(ethd__law_block, at) - 1] ^= 1;
  return fills(p, state, in, tau);
}

static ethd_status fills_far_with_more(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  ((char *)state)[sizeof(ethd__law_block) - offsetof(ethd__law_block, at) - 1] = (char)0xff;
  return fills(p, state, in, tau);
}

/* Whose block it is, before it. */
static ethd_status forgets(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  memset((char *)state - offsetof(ethd__law_block, at), 0, sizeof(ethd_law *));
  return fills(p, state, in, tau);
}

#if defined(__SSE__)
/* x87 precision of 53 bits instead of 64, which SSE doesn't have. */
static ethd_status cuts(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  unsigned short word;
  __asm__ volatile("fnstcw %0" : "=m"(word));
  word = (unsigned short)((word & ~0x300) | 0x200);
  __asm__ volatile("fldcw %0" : : "m"(word));
  return fills(p, state, in, tau);
}
#else
#define cuts fills_more
#endif

TEST(test_to_the_byte) {
  static const struct {
    ethd_status (*step)(const double *p, void *state, const ethd_tracking_in *in, double tau[2]);
    void (*reset)(const double *p, void *state);
    ethd_status status;
  } cases[] = {{fills, NULL, ETHD_OK},
               {fills_more, NULL, ETHD_E_FENCE},
               {fills_far, NULL, ETHD_E_FENCE},
               {fills_far_with_more, NULL, ETHD_E_FENCE},
               {forgets, NULL, ETHD_E_FENCE},
               {cuts, NULL, cuts == fills_more ? ETHD_E_FENCE : ETHD_E_FENV},
               {fills, reset_more, ETHD_E_FENCE},
               {fills, reset_rounding, ETHD_E_FENV}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    ethd_tracking_law law = ethd_tracking_pd;
    law.law.state_size = 13;
    law.law.param_count = 0;
    law.law.check = NULL;
    law.law.reset = cases[i].reset;
    law.step = cases[i].step;
    law.gains = NULL;
    rig r;
    rig_open(&r, RIG_WALL);
    ethd_setup_tracking(&r.setup, &law);
    rig_start(&r);
    ck_assert_int_eq(fegetround(), FE_TONEAREST);
    ethd_sense s = sense_at(&r, 0.001);
    ck_assert_int_eq(rig_try(&r, &s), cases[i].status ? ETHD_E_LAW : ETHD_OK);
    if (cases[i].status) ck_assert(rig_poll(&r).value == told(ETHD_TRACKING, cases[i].status));
    rig_close(&r);
  }
}

/* ---- what a law does when it is asked how far it looks, and when it takes a contact over ---- */

static int misdeed;

static double range_of(const double *p, double speed) {
  (void)p, (void)speed;
  if (misdeed == 1) fesetround(FE_UPWARD);
  return 0.01;
}

static void adopt(const double *p, void *state, const ethd_past *past) {
  (void)p, (void)past;
  if (misdeed == 2) fesetround(FE_UPWARD);
  if (misdeed == 3) ((char *)state)[-1] = 0;
  if (misdeed == 4) ((char *)state)[ETHD_STATE_MAX] = 0;
}

/* In contact, a law is swapped in that misbehaves (1: at every tick, also in its very first one). */
TEST_LOOP(test_range_and_adopt, 0, 5) {
  const ethd_status found = _i == 0 ? ETHD_OK : _i < 3 ? ETHD_E_FENV : ETHD_E_FENCE;
  ethd_transition_law law = ethd_transition_smooth;
  law.range = range_of;
  law.adopt = adopt;
  misdeed = 0;
  rig r;
  rig_begin(&r, RIG_WALL, &ethd_transition_offset);
  ethd_sense s = sense_at(&r, -0.001);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ethd_setup_transition(&r.setup, &law);
  rig_post(&r);
  misdeed = _i;
  ck_assert_int_eq(rig_try(&r, &s), found ? ETHD_E_LAW : ETHD_OK);
  ck_assert_int_eq(fegetround(), FE_TONEAREST);
  if (found) ck_assert(r.command.torque[0] == 0 && r.command.torque[1] == 0);
  ethd_event e = rig_poll(&r);
  while (e.kind && e.kind != ETHD_EVENT_FAULT) e = rig_poll(&r);
  ck_assert_int_eq(e.kind, found ? ETHD_EVENT_FAULT : 0);
  if (found) ck_assert(e.code == ETHD_FAULT_LAW && e.value == told(ETHD_TRANSITION, found));
  rig_close(&r);
}

/* Laws of one and the same code, once as the library's own and once as a foreign one: equal to the last bit, swaps
   from one to the other included. */
TEST(test_fenced_is_the_same) {
  static ethd_tracking_law tracking;
  static ethd_contact_law contact;
  static ethd_transition_law transition;
  rig own, foreign;
  rig_open(&own, RIG_WALL);
  rig_open(&foreign, RIG_WALL);
  ethd_setup before = foreign.setup;
  ethd_setup_transition(&before, &ethd_transition_smooth);
  tracking = ethd_tracking_pd, contact = ethd_contact_hunt_crossley, transition = ethd_transition_offset;
  ethd_setup_tracking(&own.setup, &ethd_tracking_pd);
  ethd_setup_contact(&own.setup, &ethd_contact_hunt_crossley);
  ethd_setup_transition(&own.setup, &ethd_transition_offset);
  ethd_setup_tracking(&foreign.setup, &tracking);
  ethd_setup_contact(&foreign.setup, &contact);
  ethd_setup_transition(&foreign.setup, &transition);
  rig_start(&own);
  rig_start(&foreign);
  for (int tick = 0; tick < 400; tick++) {
    motion m = rig_at(0.004 - 0.00002 * tick, 0.02, 0.001);
    if (tick == 300) {
      before.scene = own.setup.scene;
      own.setup = before;
      before.scene = foreign.setup.scene;
      foreign.setup = before;
      rig_post(&own);
      rig_post(&foreign);
    }
    rig_step(&own, &m);
    rig_step(&foreign, &m);
    if (tick == 300) foreign.trace.swap = own.trace.swap;
    ck_assert_mem_eq(&own.trace, &foreign.trace, sizeof own.trace);
  }
  ck_assert(foreign.trace.contacts == 1 && foreign.trace.fe[0] != 0);
  rig_close(&own);
  rig_close(&foreign);
}

/* ---- the processor ---- */

static unsigned control_now(void) {
#if defined(__SSE__)
  return _mm_getcsr() & 0xffc0u;
#else
  return (unsigned)fegetround();
#endif
}

TEST_LOOP(test_rounds, 0, 3) {
  rig r;
  unsigned before = control_now();
  rig_open(&r, RIG_WALL);
  ethd_setup_transition(&r.setup, open_law("rounds"));
  r.setup.transition_p[0] = _i;
  rig_start(&r);
  expect_found(&r, ETHD_TRANSITION, ETHD_E_FENV);
  ck_assert_uint_eq(control_now(), before);
  ck_assert_int_eq(fegetround(), FE_TONEAREST);
  volatile double third = 1, three = 3;
  ck_assert(third / three == 0x1.5555555555555p-2);
  rig_close(&r);
}

/* ---- which law runs ---- */

static const ethd_control *asked;
static const ethd_law *answer;

static ethd_status asks(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  (void)p, (void)state, (void)in;
  answer = ethd_control_law(asked);
  tau[0] = tau[1] = 0;
  return ETHD_OK;
}

TEST(test_running_law) {
  ethd_tracking_law law = ethd_tracking_pd;
  law.step = asks;
  for (int rehearsed = 0; rehearsed < 2; rehearsed++) {
    rig r;
    rig_open(&r, RIG_WALL);
    ethd_setup_tracking(&r.setup, &law);
    rig_start(&r);
    asked = r.control;
    answer = NULL;
    ethd_sense s = sense_at(&r, 0.001);
    ck_assert_ptr_null(ethd_control_law(r.control));
    if (rehearsed)
      ck_assert_int_eq(ethd_control_rehearse(r.control, &s, &r.command), ETHD_OK);
    else
      ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    ck_assert_ptr_eq(answer, &law.law);
    ck_assert_ptr_null(ethd_control_law(r.control));
    rig_close(&r);
  }
}

/* ---- strings ---- */

TEST(test_strings) {
  const char *const bad[] = {NULL, "", "\033[2J", "a\nb", "tab\t", "\x7f", "caf\xc3\xa9"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ethd_transition_law law = ethd_transition_smooth;
    ethd_error error;
    law.law.brief = bad[i];
    ck_assert_int_eq(ethd_law_check(&law.law, &error), ETHD_E_ARGUMENT);
    ck_assert_str_eq(error.name, "smooth");
    for (int unit = 0; unit < 2; unit++) {
      ethd_param row = {"gain", "1", 0, 1, 0, "a gain"};
      *(unit ? &row.unit : &row.brief) = bad[i];
      ck_assert_int_eq(ethd_params_check_table(&row, 1, &error), ETHD_E_TABLE);
      ck_assert_str_eq(error.name, "gain");
    }
  }
  ethd_param row = {"g\033]0;x", "1", 0, 1, 0, "a gain"};
  ethd_error error;
  ck_assert_int_eq(ethd_params_check_table(&row, 1, &error), ETHD_E_TABLE);
  ck_assert_str_eq(error.name, "g?]0;x"); /* what people are shown steers no terminal */
}
