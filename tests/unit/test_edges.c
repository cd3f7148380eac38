/* Values exactly at an edge, states that must be forgotten, and what is shared: found by changing lib at random
   (tests/mutation.sh), as those of test_details.c. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/fence.h"
#include "ethd/estimate.h"
#include "proximity_ring/decoder.h"
#include "unit/rig.h"

static ethd_error error;

/* ---- control ---- */

/* Two bodies share a scene; when it is replaced it comes back once, for the first of them, or it would be freed
   twice. */
TEST(test_shared_scene_comes_back_once) {
  rig r;
  rig_open(&r, RIG_WALL);
  ethd_scene *shared = rig_scene("circle 0 0 0.01\n");
  r.setup.bodies[0] = r.setup.bodies[1] = shared;
  rig_start(&r);
  motion m = rig_at(0.05, 0, 0);
  rig_step(&r, &m);
  r.setup.bodies[0] = r.setup.bodies[1] = NULL;
  rig_post(&r);
  rig_step(&r, &m);
  int back = 0;
  for (ethd_event e; (e = rig_poll(&r)).kind;) {
    back += e.scene == shared;
    ck_assert(e.scene != shared || (e.kind == ETHD_EVENT_RELEASED && e.code == 1));
  }
  ck_assert_int_eq(back, 1);
  ethd_scene_destroy(shared);
  rig_close(&r);
}

/* Torque that a row takes away is zero in the trace, too: not nearly so. */
TEST(test_raw_torque_is_zero) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  motion m = rig_at(-0.002, 0, 0.001);
  rig_step(&r, &m);
  ck_assert(r.trace.tau_raw[0] != 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  s.grave = ETHD_FAULT_BIT(ETHD_FAULT_LOOP);
  (void)rig_try(&r, &s);
  ck_assert(r.trace.tau_raw[0] == 0 && r.trace.tau_raw[1] == 0);
  ck_assert(r.command.torque[0] == 0 && r.command.torque[1] == 0);
  rig_close(&r);
}

/* Built-in laws are called directly, all of them; a copy is foreign. */
TEST(test_whose_law_it_is) {
  const ethd_contact_law copy = ethd_contact_spring;
  for (const ethd_law *const *law = ethd_laws; *law; law++) ck_assert(!ethd__law_is_foreign(*law));
  ck_assert(ethd__law_is_foreign(&copy.law));
}

/* Whichever block's law hangs, it is named. */
TEST(test_each_block_says_whose_law_runs) {
  static ethd__core state;
  const ethd_law *const law = &ethd_contact_spring.law;
  ck_assert_ptr_null(ethd__fence_runs(&state));
  for (int i = -1; i < 2 * ETHD_CONTACTS_MAX; i++) {
    ethd__slot *slot = &state.slots[(i < 0 ? 0 : i) / 2];
    ethd__law_block *block = i < 0 ? &state.tracking : i % 2 ? &slot->contact : &slot->transition;
    block->law = law;
    block->running = 1;
    ck_assert_ptr_eq(ethd__fence_runs(&state), law);
    block->running = 0;
    ck_assert_ptr_null(ethd__fence_runs(&state));
  }
}

/* ---- laws, limits, estimators ---- */

/* offset takes a wall over when the ring rests there: slower than v_th, or at the wall for 50 ms. */
TEST(test_what_offset_adopts) {
  static const struct {
    double v, since;
    int is_adopted;
  } cases[] = {{0.5, 0.049, 0}, {0.5, 0.051, 1}, {0.001, 0, 1}};
  const ethd_transition_law *law = &ethd_transition_offset;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double p[ETHD_PARAMS_MAX], state[ETHD_STATE_MAX / sizeof(double)] = {0};
    ethd_params_default(law->law.params, law->law.param_count, p);
    const ethd_past past = {
        .offset = 0.002, .d_re = -0.003, .v = cases[i].v, .since = cases[i].since, .state = ETHD_VO};
    const ethd_contact c = {.d_re = -0.003, .d_fr = -0.003, .d_beta = 0.004, .v = cases[i].v, .period = 1e-3};
    ethd_ruling out = {.beta = 1};
    law->adopt(p, state, &past);
    ck_assert_int_eq(law->step(p, state, &c, &out), ETHD_OK);
    ck_assert_msg((out.state == ETHD_VO) == cases[i].is_adopted, "%zu: state %d", i, out.state);
  }
}

/* A filter that begins anew knows nothing of the acceleration before, along neither axis. */
TEST(test_filter_forgets_acceleration) {
  ethd_filter filter;
  ethd_filter_state s;
  double p[ETHD_PARAMS_MAX];
  const ethd_method *ca = &ethd_filter_methods[ETHD_FILTER_CA];
  ethd_params_default(ca->params, ca->param_count, p);
  memset(&s, 0, sizeof s);
  ck_assert_int_eq(ethd_filter_prepare(ETHD_FILTER_CA, p, 1e-3, &filter, &error), ETHD_OK);
  s.a[0] = 3, s.a[1] = 4;
  ethd_filter_start(&filter, &s, (ethd_vec){0.1, 0.2}, (ethd_vec){0, 0});
  ck_assert(s.a[0] == 0 && s.a[1] == 0);
}

/* ---- scenes ---- */

static ethd_status parse(const char *text) {
  ethd_scene *out;
  ethd_status status = ethd_scene_parse(text, strlen(text), &out, &error);
  if (!status) ethd_scene_destroy(out);
  return status;
}

TEST(test_names_of_materials) {
  static const char *const refused[] = {"a+b", "a!b", "a(b", "a,b", "a'b", "a/b", "a:b", "a@b", "a[b", "a`b", "a{b"};
  char text[64];
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    strcat(strcat(strcpy(text, "material "), refused[i]), " k_e=1\ncircle 0 0 1\n");
    ck_assert_msg(parse(text) < 0, "%s is taken", refused[i]);
  }
  ck_assert_int_eq(parse("material aZ0_-.9 k_e=1\ncircle 0 0 1\n"), ETHD_OK);
}

/* ---- the ring's decoder ---- */

/* Noise without a delimiter, in pieces: no more of it is held than a frame has. */
TEST(test_noise_that_goes_on) {
  ethd__decoder d = {0};
  ethd__ring_frame frame;
  uint8_t noise[ETHD__FRAME_WIRE];
  memset(noise, 0x55, sizeof noise);
  for (int i = 0; i < 10; i++) {
    const uint8_t *at = noise;
    ck_assert(!ethd__decoder_next(&d, &at, noise + sizeof noise, &frame));
    ck_assert_uint_le(d.held, ETHD__FRAME_WIRE);
  }
}
