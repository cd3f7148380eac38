/* What a loop asks of a controller in space beside its steps. */
#include <math.h>
#include <string.h>

#include "space/state.h"
#include "unit/mover.h"
#include "unit/suite.h"

static ethd_space_sense sense_at(int k) {
  return (ethd_space_sense){.time_ns = 1000000 * k,
                            .have = ETHD_SPACE_HAVE_FINGER,
                            .x = {2e-4 * k, 0, 0},
                            .v = {0.2, 0, 0},
                            .finger = {2e-4 * k + 0.003, 0, 0},
                            .finger_v = {0.2, 0, 0}};
}

/* A rehearsal gives the command that the step will give, and leaves no trace. */
TEST_LOOP(test_rehearse, 0, 2) {
  ethd_space_setup setup = ethd_space_setup_default();
  setup.kind = (ethd_space_kind)_i;
  setup.acceleration = 20;
  ethd_space *one = made(&setup), *other = made(&setup);
  ck_assert(ethd_space_commands(one) == setup.kind && ethd_space_period(one) == setup.period);
  for (int k = 0; k < 400; k++) {
    const ethd_space_sense s = sense_at(k);
    const ethd_surface near = wall_at(ethd_vec3_of(s.x), (ethd_vec3){1, 0, 0}, 0.05, 0);
    ethd_space_command a, b, c;
    ethd_space_trace ta, tb;
    ck_assert_int_eq(ethd_space_rehearse(one, &s, &near, 1, &a), ETHD_OK);
    ck_assert_int_eq(ethd_space_step(one, &s, &near, 1, &b, &ta), ETHD_OK);
    ck_assert_int_eq(ethd_space_step(other, &s, &near, 1, &c, &tb), ETHD_OK);
    ck_assert_mem_eq(&a, &b, sizeof a);
    ck_assert_mem_eq(&ta, &tb, sizeof ta);
  }
  ethd_space_destroy(one);
  ethd_space_destroy(other);
}

/* A restart forgets the ticks and the fault, and keeps what was learnt. */
TEST(test_restart) {
  ethd_space_setup setup = ethd_space_setup_default();
  ethd_space *space = made(&setup);
  ethd_space_command command;
  ethd_counters counters;
  ethd_space_sense s = sense_at(0);
  ck_assert_int_eq(ethd_space_step(space, &s, NULL, 0, &command, NULL), ETHD_OK);
  s.x[0] = NAN;
  ck_assert_int_eq(ethd_space_step(space, &s, NULL, 0, &command, NULL), ETHD_E_NOT_FINITE);
  space->state.core.memory[1] = 0.75;
  ethd_space_restart(space);
  ck_assert_double_eq(space->state.core.memory[1], 0.75);
  ethd_space_counters(space, &counters);
  ck_assert_uint_eq(counters.ticks, 0);
  s = sense_at(1);
  ck_assert_int_eq(ethd_space_step(space, &s, NULL, 0, &command, NULL), ETHD_OK);
  ethd_space_destroy(space);
}

/* While a law's code runs, anybody can see which one it is. */
static ethd_space *seen;
static const ethd_law *runs;
static ethd_status look(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)p, (void)state, (void)gap, (void)speed, (void)entering;
  runs = ethd_space_law(seen);
  *force = 0;
  return ETHD_OK;
}
static const ethd_contact_law looking = {
    .law = {sizeof(ethd_contact_law), ETHD_ABI, ETHD_CONTACT, 0, "looking", "as it is told", NULL, 0, NULL, NULL},
    .step = look};

TEST(test_law) {
  ethd_space_setup setup = ethd_space_setup_default();
  ethd_space_contact(&setup, &looking);
  ethd_space_transition(&setup, &ethd_transition_smooth);
  setup.kind = ETHD_SPACE_FORCE;
  seen = made(&setup);
  ethd_space_command command;
  ethd_space_sense s = sense_at(0);
  const ethd_surface near = wall_at(ethd_vec3_of(s.x), (ethd_vec3){1, 0, 0}, 0.01, 0);
  ck_assert_int_eq(ethd_space_rehearse(seen, &s, &near, 1, &command), ETHD_OK);
  ck_assert_ptr_eq(runs, &looking.law);
  runs = NULL;
  ck_assert_int_eq(ethd_space_step(seen, &s, &near, 1, &command, NULL), ETHD_OK);
  ck_assert_ptr_eq(runs, &looking.law);
  ck_assert_ptr_null(ethd_space_law(seen));
  ethd_space_destroy(seen);
}
