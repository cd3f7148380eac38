/* Setups in, events out: posting, handing back, reset, rehearsal. */
#include <math.h>
#include <string.h>

#include "unit/draw.h"
#include "unit/rig.h"

static motion tap(int tick) {
  double d = 0.004 - 0.0002 * tick;
  return rig_at(d, 0.2 - 0.004 * tick, 0.001 + 1e-4 * sin(tick));
}

static void run(rig *r, int from, int to) {
  for (int tick = from; tick < to; tick++) {
    motion m = tap(tick);
    rig_step(r, &m);
  }
}

/* ---- posting ---- */

TEST(test_taken_at_the_next_step) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  run(&r, 0, 3);
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  rig_post(&r);
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  ck_assert_int_eq(ethd_control_post(r.control, &r.setup, NULL), ETHD_STATUS_BUSY);
  run(&r, 3, 4);
  ck_assert_int_eq(r.trace.swap, 1);
  ethd_event e = rig_poll(&r);
  ck_assert(e.kind == ETHD_EVENT_TAKEN && e.tick == r.trace.tick && e.scene == NULL); /* the scene stays in use */
  run(&r, 4, 5);
  ck_assert_int_eq(r.trace.swap, 0);
  rig_post(&r);
  rig_close(&r);
}

/* Half a setup can't be: what comes in between is refused and leaves everything as it was. */
TEST(test_refusal_changes_nothing) {
  rig r, untouched;
  ethd_error error;
  rig_open(&r, RIG_WALL);
  rig_open(&untouched, RIG_WALL);
  rig_start(&r);
  rig_start(&untouched);
  for (int tick = 0; tick < 40; tick++) {
    ethd_setup bad = r.setup;
    ethd_setup_transition(&bad, &ethd_transition_smooth);
    if (tick % 3 == 0) bad.contact_p[0] = -1;
    if (tick % 3 == 1) bad.period = 0.002;
    if (tick % 3 == 2) bad.cookie = 0;
    ck_assert_int_lt(ethd_control_post(r.control, &bad, &error), 0);
    run(&r, tick, tick + 1);
    run(&untouched, tick, tick + 1);
    ck_assert_mem_eq(&r.trace, &untouched.trace, sizeof r.trace);
  }
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  rig_post(&r);
  ck_assert_int_eq(ethd_control_post(r.control, NULL, NULL), ETHD_STATUS_BUSY);
  run(&r, 0, 1);
  ck_assert_int_eq(ethd_control_post(r.control, NULL, NULL), ETHD_E_ARGUMENT);
  rig_close(&r);
  rig_close(&untouched);
}

TEST(test_period_cannot_change) {
  rig r;
  ethd_error error;
  rig_begin(&r, NULL, NULL);
  r.setup.period = 0.002;
  ck_assert_int_eq(ethd_control_post(r.control, &r.setup, &error), ETHD_E_ARGUMENT);
  ck_assert_str_eq(error.name, "loop.period");
  ck_assert(error.found == 0.002 && error.min == 0.001);
  rig_close(&r);
}

/* A replaced scene comes back once, when it is no longer used. */
TEST(test_scene_comes_back) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  run(&r, 0, 10);
  ethd_scene *first = r.scene, *second = rig_scene("halfplane 1 0 0.3\n");
  r.setup.scene = second;
  rig_post(&r);
  run(&r, 10, 11);
  ethd_event e = rig_poll(&r);
  ck_assert(e.kind == ETHD_EVENT_TAKEN && e.scene == first);
  ethd_scene_destroy(first);
  ck_assert_int_eq(r.trace.contacts, 0);
  r.setup.scene = NULL;
  rig_post(&r);
  run(&r, 11, 12);
  ck_assert_ptr_eq(rig_poll(&r).scene, second);
  ethd_scene_destroy(second);
  r.scene = rig_scene(RIG_WALL);
  r.setup.scene = r.scene;
  rig_post(&r);
  run(&r, 12, 13);
  ck_assert_ptr_eq(rig_poll(&r).scene, NULL);
  rig_close(&r);
}

/* A wall that stands where one stood goes on under the ring, whatever scene it is of; one that stands elsewhere is a
   new contact: braking again. */
TEST(test_new_wall_restarts_contacts) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  motion m = rig_at(-0.001, 0.3, 0);
  rig_step(&r, &m);
  m = rig_at(-0.001, 0, 0);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_VO);
  rig_post(&r);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_VO); /* the same scene: it stays */
  ethd_scene *old = r.scene;
  r.setup.scene = r.scene = rig_scene(RIG_WALL);
  rig_post(&r);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_VO);
  ethd_scene_destroy(old);
  old = r.scene;
  r.setup.scene = r.scene = rig_scene("halfplane -1 0 -0.2385");
  rig_post(&r);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_BRAKING);
  ethd_scene_destroy(old);
  rig_close(&r);
}

/* ---- the event ring ---- */

/* Full: faults are dropped and counted, but a post waits for room for all its scenes, so that none is lost. */
TEST(test_full_ring) {
  rig r;
  ethd_counters c;
  rig_open(&r, RIG_WALL);
  r.setup.limits.latch = 0;
  rig_start(&r);
  motion m = tap(0);
  ethd_sense bad = rig_sense(&r.setup.arm, &m);
  bad.q[0] = NAN;
  for (int i = 0; i < 70; i++) rig_try(&r, &bad);
  ethd_control_counters(r.control, &c);
  ck_assert(c.events_dropped == 6 && c.faults[ETHD_FAULT_INPUT] == 70);
  ethd_scene *old = r.scene;
  r.setup.scene = r.scene = rig_scene(RIG_WALL);
  rig_post(&r);
  run(&r, 0, 3);
  ck_assert_int_eq(r.trace.swap, 0);
  ck_assert_int_eq(ethd_control_post(r.control, &r.setup, NULL), ETHD_STATUS_BUSY);
  for (int i = 0; i < 1 + ETHD_BODIES_MAX; i++) {
    ethd_event e = rig_poll(&r);
    ck_assert(e.kind == ETHD_EVENT_FAULT && e.code == ETHD_FAULT_INPUT && e.tick == i);
  }
  run(&r, 3, 4);
  ck_assert_int_eq(r.trace.swap, 1);
  for (int i = 1 + ETHD_BODIES_MAX; i < 64; i++) ck_assert_int_eq(rig_poll(&r).kind, ETHD_EVENT_FAULT);
  ck_assert_ptr_eq(rig_poll(&r).scene, old);
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  ethd_scene_destroy(old);
  rig_close(&r);
}

TEST(test_ring_goes_round) {
  rig r;
  rig_begin(&r, NULL, NULL);
  for (int i = 0; i < 1000; i++) {
    rig_post(&r);
    run(&r, 0, 1);
    ethd_event e = rig_poll(&r);
    ck_assert(e.kind == ETHD_EVENT_TAKEN && e.tick == i);
    ck_assert_int_eq(rig_poll(&r).kind, 0);
  }
  rig_close(&r);
}

/* ---- forgetting and rehearsing ---- */

TEST(test_reset) {
  rig r, fresh;
  rig_open(&r, RIG_WALL);
  rig_open(&fresh, RIG_WALL);
  rig_start(&r);
  rig_start(&fresh);
  run(&r, 0, 30);
  ethd_control_reset(r.control);
  r.sense.time_ns = 0;
  for (int tick = 0; tick < 30; tick++) {
    run(&r, tick, tick + 1);
    run(&fresh, tick, tick + 1);
    ck_assert_mem_eq(&r.trace, &fresh.trace, sizeof r.trace);
  }
  /* a posted setup stays posted */
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  rig_post(&r);
  ethd_control_reset(r.control);
  run(&r, 0, 1);
  ck_assert(r.trace.swap == 1 && r.trace.tick == 0);
  rig_close(&r);
  rig_close(&fresh);
}

/* It tells what the step would give, and nothing is different after it. */
TEST(test_rehearse) {
  rig r, plain;
  rig_open(&r, RIG_WALL);
  rig_open(&plain, RIG_WALL);
  rig_start(&r);
  rig_start(&plain);
  for (int tick = 0; tick < 60; tick++) {
    motion m = tap(tick);
    ethd_sense s = rig_sense(&r.setup.arm, &m), odd = s;
    ethd_command told, other;
    s.time_ns = r.sense.time_ns + 1000000;
    ck_assert_int_eq(ethd_control_rehearse(r.control, &s, &told), ETHD_OK);
    odd.q[1] = NAN;
    ck_assert_int_eq(ethd_control_rehearse(r.control, &odd, &other), ETHD_E_NOT_FINITE);
    ck_assert(other.torque[0] == 0 && other.safe == 1);
    odd.q[1] = 0.3;
    (void)!ethd_control_rehearse(r.control, &odd, &other);
    rig_step(&r, &m);
    rig_step(&plain, &m);
    ck_assert_mem_eq(&told, &r.command, sizeof told);
    ck_assert_mem_eq(&r.trace, &plain.trace, sizeof r.trace);
  }
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  rig_close(&r);
  rig_close(&plain);
}

TEST(test_without_trace) {
  rig r, plain;
  rig_open(&r, RIG_WALL);
  rig_open(&plain, RIG_WALL);
  rig_start(&r);
  rig_start(&plain);
  for (int tick = 0; tick < 60; tick++) {
    motion m = tap(tick);
    rig_step(&plain, &m);
    ethd_command command;
    ck_assert_int_eq(ethd_control_step(r.control, &plain.sense, &command, NULL), ETHD_OK);
    ck_assert_mem_eq(&command, &plain.command, sizeof command);
  }
  rig_close(&r);
  rig_close(&plain);
}

TEST(test_counters) {
  rig r;
  ethd_counters c;
  rig_open(&r, RIG_WALL);
  r.setup.limits.torque = 1e-6;
  rig_start(&r);
  uint64_t queried = 0; /* some ticks far from the wall pass without */
  for (int tick = 0; tick < 10; tick++) {
    run(&r, tick, tick + 1);
    queried += (uint64_t)r.trace.queried;
  }
  r.setup.scene = NULL;
  rig_post(&r);
  run(&r, 10, 15);
  ethd_control_counters(r.control, &c);
  ck_assert(queried > 5 && queried < 10);
  ck_assert(c.ticks == 15 && c.queried == queried && c.swaps == 1 && c.events_dropped == 0);
  ck_assert(c.guard[1] == 15 && c.guard[0] == 0 && c.faults[ETHD_FAULT_INPUT] == 0);
  rig_close(&r);
}

/* ---- what a setup may be ---- */

typedef struct refusal {
  size_t at; /* of a double in the setup */
  double value;
  const char *name;
  ethd_status status;
} refusal;

#define AT(field) offsetof(ethd_setup, field)
static const refusal refusals[] = {
    {AT(period), 0, "loop.period", ETHD_E_RANGE},
    {AT(period), NAN, "loop.period", ETHD_E_NOT_FINITE},
    {AT(arm.link1), -0.25, "arm.link1", ETHD_E_RANGE},
    {AT(arm.link2), NAN, "arm.link2", ETHD_E_NOT_FINITE},
    {AT(ring_radius), INFINITY, "ring.radius", ETHD_E_RANGE},
    {AT(ring_radius), 0, "ring.radius", ETHD_E_RANGE},
    {AT(finger_radius), 0.0121, "finger.radius", ETHD_E_RANGE},
    {AT(finger_radius), 5e-5, "finger.radius", ETHD_E_RANGE},
    {AT(finger_radius_max), 0.012, "finger.radius_max", ETHD_E_RANGE},
    {AT(finger_radius_max), NAN, "finger.radius_max", ETHD_E_NOT_FINITE},
    {AT(velocity_p[0]), 0, "velocity.cutoff", ETHD_E_RANGE},
    {AT(filter_p[3]), 0, "finger_filter.noise", ETHD_E_RANGE},
    {AT(tracking_p[0]), -1, "tracking.k_t", ETHD_E_RANGE},
    {AT(tracking_p[2]), 0.5, "tracking.derivative", ETHD_E_RANGE},
    {AT(contact_p[0]), INFINITY, "contact.k_e", ETHD_E_NOT_FINITE},
    {AT(contact_p[1]), NAN, "contact.b_e", ETHD_E_NOT_FINITE},
    {AT(transition_p[1]), 0, "transition.v_th", ETHD_E_RANGE},
    {AT(transition_p[2]), 1.01, "transition.beta_min", ETHD_E_RANGE},
    {AT(transition_p[3]), -0.001, "transition.eps_max", ETHD_E_RANGE},
    {AT(swap_time), -0.001, "transition.swap_time", ETHD_E_RANGE},
    {AT(swap_time), 1.5, "transition.swap_time", ETHD_E_RANGE},
    {AT(v_hysteresis), NAN, "transition.v_hysteresis", ETHD_E_NOT_FINITE},
    {AT(limits.torque), -1, "limits.torque", ETHD_E_RANGE},
    {AT(limits.torque_rate), NAN, "limits.torque_rate", ETHD_E_NOT_FINITE},
    {AT(limits.speed), -0.1, "limits.speed", ETHD_E_RANGE},
    {AT(limits.step_time), 0, "limits.step_time", ETHD_E_RANGE},
    {AT(limits.workspace[0]), NAN, "limits.workspace", ETHD_E_NOT_FINITE},
    {AT(limits.workspace[1]), NAN, "limits.workspace", ETHD_E_NOT_FINITE},
    {AT(limits.workspace[3]), NAN, "limits.workspace", ETHD_E_NOT_FINITE},
};

TEST_LOOP(test_refusals, 0, sizeof refusals / sizeof *refusals) {
  const refusal *c = &refusals[_i];
  ethd_setup s = ethd_setup_default();
  ethd_control *control = (ethd_control *)&s;
  ethd_error error;
  ck_assert_int_eq(ethd_setup_check(&s, &error), ETHD_OK);
  memcpy((char *)&s + c->at, &c->value, sizeof c->value);
  ethd_status status = ethd_setup_check(&s, &error);
  if (status != c->status || strcmp(error.name, c->name) != 0)
    ck_abort_msg("%s = %g: %s, %s", c->name, c->value, error.name, ethd_status_sentence(status));
  ck_assert(error.status == status && error.line == 0);
  ck_assert(isnan(c->value) ? isnan(error.found) : error.found == c->value);
  ck_assert_int_eq(ethd_control_create(&s, &control, NULL), c->status);
  ck_assert_ptr_null(control);
  if (status != ETHD_E_RANGE || c->at == AT(ring_radius)) return; /* the finger must fit the ring */
  memcpy((char *)&s + c->at, &error.min, sizeof error.min);       /* what is said to be allowed is */
  ck_assert_int_eq(ethd_setup_check(&s, NULL), ETHD_OK);
  memcpy((char *)&s + c->at, &error.max, sizeof error.max);
  ck_assert_int_eq(ethd_setup_check(&s, NULL), ETHD_OK);
}

/* eps_max and t_max may be infinite, as in the paper; limits may be infinite or narrow. */
TEST(test_infinities_that_are_fine) {
  ethd_setup s = ethd_setup_default();
  s.transition_p[3] = s.transition_p[4] = INFINITY;
  s.limits.torque = s.limits.torque_rate = 0;
  ck_assert_int_eq(ethd_setup_check(&s, NULL), ETHD_OK);
  s.limits.workspace[0] = 0.3;
  s.limits.workspace[1] = 0.2;
  ck_assert_int_eq(ethd_setup_check(&s, NULL), ETHD_E_RANGE);
}
