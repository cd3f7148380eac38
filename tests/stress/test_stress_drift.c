/* A thousand million ticks: nothing that is added up drifts.

     ages and caps   are counted in periods: a law sees age = k T, and braking ends t_max / T ticks after it began
     static press    the same input gives the same bits
     taps            readings, filters, braking, vo and back, again and again, give the same torques
     time            stamps are integers, and so are the differences between them */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/control.h"
#include "stress/mass.h"

#define PERIOD 0.001

/* ---- braking, then pressing, for ever ---- */

/* The law `offset`, which also notes the age of the contact that it is given. */
static double age_seen;

static ethd_status watch(const double *p, void *state, const ethd_contact *contact, ethd_ruling *out) {
  age_seen = contact->age;
  return ethd_transition_offset.step(p, state, contact, out);
}

static ethd_control *make(const ethd_transition_law *law, double t_max, const ethd_scene *scene) {
  ethd_setup setup = ethd_setup_default();
  ethd_setup_transition(&setup, law);
  setup.scene = scene;
  rig_set(&setup, "transition.eps_max", (double)INFINITY);
  rig_set(&setup, "transition.t_max", t_max);
  return rig_control(&setup);
}

/* The ring stands 1 mm deep and says that it moves: braking goes on until t_max. */
static void press(const ethd_scene *scene, int64_t ticks) {
  ethd_transition_law law = ethd_transition_offset;
  law.law.id = "watched";
  law.step = watch;
  int64_t braking = ticks / 10 * 9;
  ethd_control *control = make(&law, (double)braking * PERIOD, scene);
  ethd_setup setup = ethd_setup_default();
  ethd_sense s;
  ethd_command c, first = {{0, 0}, 0, 0};
  ethd_trace t;
  int64_t ended = -1, changed = 0;
  memset(&s, 0, sizeof s);
  s.have = ETHD_HAVE_DQ | ETHD_HAVE_FINGER;
  ck_assert_int_eq(ethd_arm_angles(&setup.arm, (ethd_vec){0.249, 0.25}, -1, s.q), ETHD_OK);
  s.dq[0] = 0.1 / 0.25;
  s.finger[0] = 0.245, s.finger[1] = 0.25;
  for (int64_t k = 0; k < ticks; k++) {
    s.time_ns = k * 1000000;
    (void)ethd_control_step(control, &s, &c, &t);
    if (ended < 0 && t.state == ETHD_VO) ended = k;
    if (k == 0 || k == ended) first = c;
    changed += memcmp(c.torque, first.torque, sizeof c.torque) != 0;
  }
  within(age_seen, (double)(ticks - 1) * PERIOD, 1e-15 * age_seen, "age of a contact after %g ticks", (double)ticks);
  within((double)ended, (double)braking, 0, "tick at which t_max ended the braking");
  within((double)changed, 0, 0, "ticks on which the torque of a press changed");
  ethd_control_destroy(control);
}

/* Lost ticks count in ages, too. */
static void lost(const ethd_scene *scene) {
  ethd_transition_law law = ethd_transition_offset;
  law.step = watch;
  ethd_control *control = make(&law, (double)INFINITY, scene);
  ethd_setup setup = ethd_setup_default();
  ethd_sense s;
  ethd_command c;
  int64_t periods = 0, before = 0;
  memset(&s, 0, sizeof s);
  s.have = ETHD_HAVE_DQ;
  ck_assert_int_eq(ethd_arm_angles(&setup.arm, (ethd_vec){0.249, 0.25}, -1, s.q), ETHD_OK);
  for (int k = 0; k < 1000; k++) {
    s.missed = k * k % 7;
    before = periods;
    periods += s.missed + 1;
    (void)ethd_control_step(control, &s, &c, NULL);
  }
  near(age_seen, (double)before * PERIOD, 1e-15, "age of a contact, 0 to 6 ticks lost each time");
  ethd_control_destroy(control);
}

/* ---- taps ---- */

#define CYCLE 3000 /* ticks: three taps, a whole number of readings */

static void script(const ethd_arm *arm, ethd_sense senses[CYCLE]) {
  for (int k = 0; k < CYCLE; k++) {
    ethd_sense *s = &senses[k];
    double phase = 2 * M_PI * 3 * k / CYCLE;
    ethd_vec ring = {0.27 - 0.025 * (1 - cos(phase)) / 2, 0.25 + 0.01 * sin(phase)};
    memset(s, 0, sizeof *s);
    ck_assert_int_eq(ethd_arm_angles(arm, ring, -1, s->q), ETHD_OK);
    if (k % 3) continue;
    s->have = ETHD_HAVE_CENTRE;
    s->centre[0] = -0.002 * sin(phase);
    s->centre[1] = 0.001 * cos(phase);
  }
}

/* The largest difference between the torques of two cycles. */
static double apart(const double *a, const double *b) {
  double most = 0;
  for (int i = 0; i < 2 * CYCLE; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

static void taps(const ethd_scene *scene, int64_t ticks) {
  static ethd_sense senses[CYCLE];
  static double early[2 * CYCLE], late[2 * CYCLE];
  ethd_setup setup = ethd_setup_default();
  ethd_control *control = make(&ethd_transition_offset, 0.05, scene);
  ethd_command c;
  int64_t cycles = ticks / CYCLE, braking = 0, vo = 0;
  script(&setup.arm, senses);
  for (int64_t i = 0; i < cycles; i++) {
    for (int k = 0; k < CYCLE; k++) {
      ethd_sense s = senses[k];
      ethd_trace t;
      s.time_ns = (i * CYCLE + k) * 1000000;
      s.sample_ns = s.time_ns - 1900000;
      (void)ethd_control_step(control, &s, &c, i == cycles - 1 ? &t : NULL);
      memcpy((i < 10 ? early : late) + 2 * k, c.torque, sizeof c.torque);
      if (i == cycles - 1) braking += t.state == ETHD_BRAKING, vo += t.state == ETHD_VO;
    }
  }
  within(apart(early, late), 0, 1e-12, "torques of taps 10 and of the last ones, %g ticks later",
         (double)((cycles - 10) * CYCLE));
  bound(-(double)(braking < vo ? braking : vo), -10, "the last ones brake and press (ticks, negated)");
  ethd_control_destroy(control);
}

TEST(test_drift) {
  ethd_scene *scene = rig_scene(RIG_WALL);
  int64_t ticks = pick(1000000, 1000000000);
  press(scene, ticks);
  lost(scene);
  taps(scene, ticks);
  ethd_scene_destroy(scene);
}
