/* Taps on an oblique wall with a cap: its rays show a sphere, whose centre is the reading, and an arm that takes
   velocities and is 8 ms late brings the cap. And a finger that leaves over the rim, row FINGER_OUT. */
#include <math.h>

#include "unit/cap_rig.h"
#include "unit/mover.h"
#include "unit/suite.h"

#define T 1e-3 /* s */
#define LATE 8 /* ticks */
#define R_R 0.020
#define R_F 0.008
#define RIM 0.004

typedef struct tapping {
  mover m;
  cap_rig cap;
  ethd_vec3 n; /* of the wall, into it */
  double wall; /* n.p */
  bool told;   /* who reads the rays says that the finger is out */
} tapping;

/* rim: of the setup, at which the controller itself notices. */
static void open(tapping *t, ethd_vec3 axis, ethd_vec3 start, double rim) {
  ethd_space_setup *s = &t->m.setup;
  *s = ethd_space_setup_default();
  s->effector = ETHD_EFFECTOR_CAP;
  s->radius = R_R;
  s->finger_radius = s->finger_radius_max = R_F;
  s->speed = 1;
  s->acceleration = 20;
  s->finger_age = 0.01;
  s->finger_lost = 0.03;
  s->rim = rim;
  t->cap = cap_rig_of(R_R, R_F, axis, RIM);
  mover_open(&t->m, LATE, start);
}

/* One tick: the cap measures where it really is, and the reading is taken to R_0 by the device's joints. */
static void tick(tapping *t, ethd_vec3 finger) {
  mover *m = &t->m;
  ethd_cap_finger found;
  ethd_vec3 sd;
  const ethd_vec3 real = real_place(m);
  const bool seen = cap_rig_read(&t->cap, ethd_vec3_sub(finger, real), &found) == ETHD_OK;
  ethd_space_sense s = {.have = ETHD_SPACE_HAVE_NORMAL};
  ethd_vec3_put(t->cap.axis, s.normal);
  if (seen) {
    s.have |= ETHD_SPACE_HAVE_READING;
    s.sample_ns = mover_now(m);
    ethd_vec3_put(ethd_vec3_add(real, found.centre), s.reading);
    if (ethd_cap_bound(&t->cap.cap, found.centre, t->cap.noise, &sd) == ETHD_OK)
      s.reading_noise = ethd_vec3_norm(sd) / sqrt(3);
  }
  if (t->told && seen && found.gone) s.faults = ETHD_FAULT_BIT(ETHD_FAULT_FINGER_OUT);
  const ethd_surface near = wall_at(m->at, t->n, t->wall, 0);
  mover_sense(m, &s, &near, 1);
}

/* Minimum-jerk reach (Flash and Hogan 1985): share of the way at the share s of the time. */
static double reached(double s) { return s >= 1 ? 1 : s * s * s * (10 + s * (6 * s - 15)); }

/* The finger meets the cap's top where the wall is, and the cap stands. */
TEST(test_taps_on_an_oblique_wall) {
  enum { TAPS = 100 };
  double offsets = 0, speeds = 0, worst_offset = 0, worst_speed = 0;
  int early = 0;
  for (int k = 0; k < TAPS; k++) {
    tapping t = {.n = any_unit(), .told = true};
    ethd_vec3 axis = ethd_vec3_add(t.n, ethd_vec3_scale(0.5, any_unit())), way;
    axis = ethd_vec3_scale(1 / ethd_vec3_norm(axis), axis);
    way = ethd_vec3_add(t.n, ethd_vec3_scale(0.4, any_unit()));
    way = ethd_vec3_scale(1 / ethd_vec3_norm(way), way);
    const double length = between(0.25, 0.45), time = length * 1.875 / between(0.25, 0.4);
    const ethd_vec3 start = ethd_vec3_scale(0.5, any_unit());
    t.wall = ethd_vec3_dot(t.n, start) + between(0.6, 0.8) * length * ethd_vec3_dot(t.n, way);
    open(&t, axis, start, RIM);
    bool touched = false;
    for (int i = 0; !touched; i++) {
      const ethd_vec3 finger = ethd_vec3_add(start, ethd_vec3_scale(length * reached(i * T / time), way));
      const ethd_vec3 real = real_place(&t.m), before = t.m.past[LATE + 1];
      ck_assert_msg(i * T < time + 0.5, "tap %d: no touch", k);
      if (ethd_vec3_norm(ethd_vec3_sub(finger, real)) >= R_R - R_F) {
        const double offset = ethd_vec3_dot(t.n, real) + R_R - t.wall;
        const double speed = fabs(ethd_vec3_dot(t.n, ethd_vec3_sub(real, before))) / T;
        touched = true;
        early += offset < -1e-3;
        offsets += offset / TAPS;
        speeds += speed / TAPS;
        worst_offset = fmax(worst_offset, fabs(offset));
        worst_speed = fmax(worst_speed, speed);
      } else {
        tick(&t, finger);
        if (t.m.status != ETHD_OK) ck_abort_msg("tap %d: fault %d", k, (int)t.m.trace.fault);
      }
    }
    ethd_space_destroy(t.m.space);
  }
  printf("%d taps, %d early: offset %.3f mm (worst %.3f), speed at the touch %.4f m/s (worst %.3f)\n", TAPS, early,
         1e3 * offsets, 1e3 * worst_offset, speeds, worst_speed);
  ck_assert_double_le(fabs(offsets), 1e-4);
  ck_assert_double_le(speeds, 0.01);
  ck_assert_double_le(worst_speed, 0.05);
  ck_assert_int_le(early, TAPS * 5 / 100);
}

/* A finger that leaves over the rim faster than the cap can follow: who reads the rays says it at the next tick, the
   controller by its own estimate later; the cap stops. */
TEST_LOOP(test_out_of_the_cap, 0, 2) {
  const bool told = _i;
  tapping t;
  t.n = (ethd_vec3){0, 0, 1};
  t.wall = 1;
  t.told = told;
  open(&t, t.n, (ethd_vec3){0, 0, 0}, told ? (double)INFINITY : RIM);
  int out = -1, noted = -1;
  for (int i = 0; i < 400; i++) {
    const double s = fmax(i - 100, 0) * T;
    const ethd_vec3 finger = {0, 0, -15 * s * s};
    const ethd_vec3 was = t.m.v;
    if (out < 0 && real_place(&t.m).z - finger.z > RIM) out = i;
    tick(&t, finger);
    if (t.m.trace.fault && noted < 0) noted = i;
    if (noted >= 0) ck_assert_int_eq(t.m.trace.fault, ETHD_FAULT_FINGER_OUT);
    ck_assert_double_le(ethd_vec3_norm(ethd_vec3_sub(t.m.v, was)), 20 * T * (1 + 1e-9));
  }
  printf("%s: out at tick %d, noted at %d\n", told ? "by the rays" : "by the estimate", out, noted);
  ck_assert(t.m.command.safe && ethd_vec3_norm(t.m.v) == 0);
  ck_assert(noted >= out && noted <= out + (told ? 2 : 10));
  ethd_space_destroy(t.m.space);
}
