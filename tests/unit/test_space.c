/* The front for space: against the front of the plane, against closed forms, and under bad input. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/space.h"
#include "space/state.h"
#include "unit/mover.h"
#include "unit/rig.h"

static ethd_error error;

/* ---- the plane, turned ---- */

typedef struct frame {
  ethd_vec3 a, b; /* the plane's x and y in space */
  ethd_vec3 at;   /* its origin */
} frame;

static frame any_frame(void) {
  frame f;
  f.a = any_unit();
  const ethd_vec3 side = ethd_vec3_cross(f.a, any_unit());
  f.b = ethd_vec3_scale(1 / ethd_vec3_norm(side), side);
  f.at = ethd_vec3_scale(between(0, 3), any_unit());
  return f;
}

static ethd_vec3 turned(const frame *f, ethd_vec v) {
  return ethd_vec3_add(ethd_vec3_scale(v.x, f->a), ethd_vec3_scale(v.y, f->b));
}

static ethd_vec3 placed(const frame *f, ethd_vec x) { return ethd_vec3_add(f->at, turned(f, x)); }

static void near_to(ethd_vec3 got, ethd_vec3 wanted, double most) {
  ck_assert_msg(ethd_vec3_norm(ethd_vec3_sub(got, wanted)) <= most, "%g %g %g, not %g %g %g", got.x, got.y, got.z,
                wanted.x, wanted.y, wanted.z);
}

static uint32_t surfaces_of(const frame *f, const ethd_scene *scene, ethd_vec x, ethd_surface out[8]) {
  ethd_touch touches[8];
  const size_t found = ethd_scene_touches(scene, x, 0.1, touches, 8);
  for (size_t i = 0; i < found; i++)
    out[i] = (ethd_surface){
        .point = placed(f, touches[i].point), .n = turned(f, touches[i].n), .id = touches[i].object, .material = -1};
  return (uint32_t)found;
}

static const ethd_transition_law *const laws[] = {&ethd_transition_smooth, &ethd_transition_offset,
                                                  &ethd_transition_abrupt};

/* Taps of a pushed ring at two walls: in any plane of space the forces are those of the plane. */
TEST_LOOP(test_plane_turned, 0, 3) {
  const frame f = any_frame();
  rig r;
  rig_open(&r, RIG_WALL "halfplane 0 1 0.262\n");
  ethd_setup_tracking(&r.setup, &ethd_tracking_follow);
  ethd_setup_transition(&r.setup, laws[_i]);
  rig_start(&r);
  ethd_space_setup setup = ethd_space_setup_default();
  setup.kind = ETHD_SPACE_FORCE;
  setup.radius = r.setup.ring_radius;
  setup.finger_radius = r.setup.finger_radius;
  setup.finger_radius_max = r.setup.finger_radius_max;
  setup.v_hysteresis = r.setup.v_hysteresis;
  ethd_space_transition(&setup, laws[_i]);
  ethd_space *space = made(&setup);
  int touched = 0;
  for (int k = 0; k < 4000; k++) {
    const double t = 0.0303 + 1e-3 * k; /* no tick is at the wall to the bit */
    const motion m = {.x = {0.25 + 0.006 * sin(9 * t), 0.24 + 0.015 * sin(4 * t)},
                      .v = {0.054 * cos(9 * t), 0.06 * cos(4 * t)},
                      .xf = {0.25 + 0.007 * sin(9 * t - 0.1), 0.24 + 0.016 * sin(4 * t + 0.1)},
                      .vf = {0.063 * cos(9 * t - 0.1), 0.064 * cos(4 * t + 0.1)}};
    const ethd_trace *plane = rig_step(&r, &m);
    const ethd_vec x = ethd_vec_of(plane->x), v = ethd_vec_of(plane->v);
    ethd_space_sense s = {.time_ns = plane->sense.time_ns, .have = ETHD_SPACE_HAVE_FINGER};
    ethd_surface near[8];
    ethd_space_command command;
    ethd_space_trace trace;
    ethd_pose pose;
    double torque[2];
    ethd_vec3_put(placed(&f, x), s.x);
    ethd_vec3_put(turned(&f, v), s.v);
    ethd_vec3_put(placed(&f, m.xf), s.finger);
    ethd_vec3_put(turned(&f, m.vf), s.finger_v);
    const uint32_t count = surfaces_of(&f, r.scene, x, near);
    ck_assert_int_eq(ethd_space_step(space, &s, near, count, &command, &trace), ETHD_OK);
    near_to(ethd_vec3_of(trace.fe), turned(&f, ethd_vec_of(plane->fe)), 1e-8);
    near_to(ethd_vec3_of(trace.fd), turned(&f, ethd_vec_of(plane->fd)), 1e-9);
    ck_assert(fabs(trace.beta - plane->beta) < 1e-9 && trace.contacts == plane->contacts);
    ck_assert(trace.contacts == 0 || (fabs(trace.d_re - plane->d_re) < 1e-12 && trace.state == plane->state));
    const ethd_vec3 force = ethd_vec3_of(command.value);
    ethd_arm_pose(&r.setup.arm, plane->sense.q, &pose);
    ethd_pose_torques(&pose, (ethd_vec){ethd_vec3_dot(force, f.a), ethd_vec3_dot(force, f.b)}, torque);
    ck_assert(fabs(torque[0] - plane->tau[0]) < 1e-8 && fabs(torque[1] - plane->tau[1]) < 1e-8);
    touched += trace.contacts > 1;
  }
  ck_assert_int_gt(touched, 100);
  ethd_space_destroy(space);
  rig_close(&r);
}

/* ---- bounds ---- */

/* The projection by Dykstra's alternating projections (Boyle and Dykstra 1986), which converge to it. */
static ethd_vec3 projected(ethd_vec3 u, const struct ethd__bound *b, int count) {
  ethd_vec3 rest[8] = {{0, 0, 0}};
  for (int round = 0; round < 20000; round++) {
    for (int i = 0; i < count; i++) {
      const ethd_vec3 y = ethd_vec3_add(u, rest[i]);
      const double over = ethd_vec3_dot(b[i].n, y) - b[i].speed;
      u = over > 0 || b[i].held ? ethd_vec3_sub(y, ethd_vec3_scale(over, b[i].n)) : y;
      rest[i] = ethd_vec3_sub(y, u);
    }
  }
  return u;
}

TEST(test_within_bounds) {
  int exact = 0;
  for (int k = 0; k < 300; k++) {
    struct ethd__bound b[6];
    const int count = 1 + k % 6;
    for (int i = 0; i < count; i++) b[i] = (struct ethd__bound){any_unit(), between(0, 0.5), false};
    if (k % 5 == 0) b[0].held = true;
    const ethd_vec3 asked = ethd_vec3_scale(between(0, 2), any_unit());
    const ethd_vec3 got = ethd__space_within(asked, b, count), wanted = projected(asked, b, count);
    double over = 0;
    for (int i = 0; i < count; i++) {
      const double excess = ethd_vec3_dot(b[i].n, wanted) - b[i].speed;
      over = fmax(over, b[i].held ? fabs(excess) : excess);
    }
    if (over > 1e-9) continue; /* a held bound against others, or an acute corner, which converges slowly */
    near_to(got, wanted, 1e-6);
    exact += ethd_vec3_norm(ethd_vec3_sub(got, wanted)) < 1e-9;
  }
  ck_assert_int_gt(exact, 200);
  /* closed forms: free, one bound, a corner of three */
  const struct ethd__bound corner[] = {{{1, 0, 0}, 0.1, false}, {{0, 1, 0}, 0.2, false}, {{0, 0, 1}, -0.3, false}};
  near_to(ethd__space_within((ethd_vec3){0.05, 0.1, -1}, corner, 3), (ethd_vec3){0.05, 0.1, -1}, 0);
  near_to(ethd__space_within((ethd_vec3){1, 0.1, -1}, corner, 3), (ethd_vec3){0.1, 0.1, -1}, 1e-15);
  near_to(ethd__space_within((ethd_vec3){1, 1, 1}, corner, 3), (ethd_vec3){0.1, 0.2, -0.3}, 1e-15);
}

/* ---- a device that takes velocities ---- */

/* Minimum-jerk reach (Flash and Hogan 1985): share of the way and its rate at the share s of the time. */
static double reached(double s) { return s >= 1 ? 1 : s * s * s * (10 + s * (6 * s - 15)); }
static double rate(double s) { return s >= 1 ? 0 : 30 * s * s * (1 - s) * (1 - s); }

/* A reach through an oblique wall with `approach`: the plate stands in the wall when the finger comes, and the finger,
   which is stopped by the plate, feels the wall where it is. Gap 60 mm, delays 8 and 30 ms. */
TEST_LOOP(test_approach, 0, 2) {
  const int late = _i ? 30 : 8;
  double worst_speed = 0, worst_offset = 0, sum = 0;
  int early = 0, taps = 60;
  for (int k = 0; k < taps; k++) {
    mover m = {.setup = ethd_space_setup_default()};
    m.setup.radius = 0.068;
    m.setup.finger_radius = m.setup.finger_radius_max = 0.008;
    m.setup.speed = 2;
    m.setup.acceleration = 20;
    ethd_space_tracking(&m.setup, &ethd_tracking_follow);
    const ethd_vec3 n = any_unit(), along = any_unit();
    ethd_vec3 way = ethd_vec3_add(n, ethd_vec3_scale(0.4, along));
    way = ethd_vec3_scale(1 / ethd_vec3_norm(way), way);
    const double length = between(0.25, 0.45), time = length * 1.875 / between(0.35, 0.5);
    const ethd_vec3 start = ethd_vec3_scale(0.5, any_unit());
    const double c = ethd_vec3_dot(n, start) + between(0.6, 0.8) * length * ethd_vec3_dot(n, way);
    mover_open(&m, late, start);
    const double gap = m.setup.radius - m.setup.finger_radius;
    bool touched = false;
    for (int i = 0; i * m.setup.period < time + 0.5 && !touched; i++) {
      const double s = i * m.setup.period / time;
      const ethd_vec3 finger = ethd_vec3_add(start, ethd_vec3_scale(length * reached(s), way));
      const ethd_vec3 v = ethd_vec3_scale(length * rate(s) / time, way);
      const ethd_surface near = wall_at(m.at, n, c - 0.0, 0);
      const ethd_vec3 was = real_place(&m);
      mover_step(&m, finger, v, &near, 1);
      ck_assert_int_eq(m.status, ETHD_OK);
      /* the finger is stopped where it meets the plate's face, R_r - R_f ahead of X along n */
      const double ahead = ethd_vec3_dot(n, ethd_vec3_sub(finger, real_place(&m)));
      if (ahead < gap) continue;
      touched = true;
      const double depth = ethd_vec3_dot(n, real_place(&m)) + m.setup.radius - c;
      const double speed = fabs(ethd_vec3_dot(n, ethd_vec3_sub(real_place(&m), was))) / m.setup.period;
      early += depth < -1e-3;
      worst_offset = fmax(worst_offset, depth);
      worst_speed = fmax(worst_speed, speed);
      sum += depth;
    }
    ck_assert(touched);
    ethd_space_destroy(m.space);
  }
  printf("%d ms: mean offset %.3f mm, worst %.3f mm, worst speed %.3f m/s, early %d of %d\n", late, 1e3 * sum / taps,
         1e3 * worst_offset, worst_speed, early, taps);
  ck_assert(worst_offset < 1e-4 && fabs(sum / taps) < (late > 8 ? 2e-4 : 2e-5));
  ck_assert_int_le(early, late > 8 ? 5 : 3);
  ck_assert(worst_speed < (late > 8 ? 0.1 : 0.05));
}

/* An oblique tap is the straight one along n, with v cos a, and goes on along the wall as the finger does. */
TEST(test_oblique) {
  const ethd_vec3 n = {0, 0, 1}, side = {0.6, 0.8, 0};
  mover straight = {.setup = ethd_space_setup_default()}, oblique = straight;
  straight.setup.radius = oblique.setup.radius = 0.068;
  straight.setup.ability.acceleration = oblique.setup.ability.acceleration = 20;
  mover_open(&straight, 8, (ethd_vec3){0, 0, 0});
  mover_open(&oblique, 8, (ethd_vec3){0, 0, 0});
  for (int i = 0; i < 1500; i++) {
    const double t = 1e-3 * i, v = 0.3;
    const ethd_vec3 along = ethd_vec3_scale(v * t, n), across = ethd_vec3_scale(0.5 * v * t, side);
    const ethd_vec3 v_n = ethd_vec3_scale(v, n), v_t = ethd_vec3_scale(0.5 * v, side);
    const ethd_surface a = wall_at(straight.at, n, 0.35, 0), b = wall_at(oblique.at, n, 0.35, 0);
    mover_step(&straight, along, v_n, &a, 1);
    mover_step(&oblique, ethd_vec3_add(along, across), ethd_vec3_add(v_n, v_t), &b, 1);
    ck_assert(fabs(straight.at.z - oblique.at.z) < 1e-12);
    near_to(ethd_vec3_sub(oblique.at, straight.at), ethd_vec3_scale(0.5 * v * (t + 1e-3), side), 1e-12);
  }
  ck_assert_int_eq(straight.trace.state, ETHD_VO);
  ck_assert(fabs(straight.at.z - 0.35 + 0.068) < 1e-6);
  ethd_space_destroy(straight.space);
  ethd_space_destroy(oblique.space);
}

/* In the seam of two walls the effector rests R_r from both: the closed form of two equations. */
TEST(test_seam) {
  mover m = {.setup = ethd_space_setup_default()};
  m.setup.acceleration = 20;
  mover_open(&m, 0, (ethd_vec3){0, 0, 0});
  const ethd_vec3 n[2] = {{1, 0, 0}, {0.6, 0.8, 0}};
  const double c[2] = {0.1, 0.15}, R = m.setup.radius;
  for (int i = 0; i < 3000; i++) {
    const ethd_surface near[2] = {wall_at(m.at, n[i % 2], c[i % 2], i % 2),
                                  wall_at(m.at, n[1 - i % 2], c[1 - i % 2], 1 - i % 2)};
    mover_step(&m, (ethd_vec3){0.4, 0.3, 0.05}, (ethd_vec3){0, 0, 0}, near, 2);
    ck_assert_int_eq(m.status, ETHD_OK);
  }
  const double x = c[0] - R;
  near_to(m.at, (ethd_vec3){x, (c[1] - R - 0.6 * x) / 0.8, 0.05}, 1e-6);
  ethd_space_destroy(m.space);
}

/* A plane of triangles, each with an id of its own, is one surface: the contact goes on, also where two are as near, and
   where the id is new in each tick. */
TEST_LOOP(test_sliding, 0, 2) {
  mover m = {.setup = ethd_space_setup_default()};
  m.setup.acceleration = 20;
  mover_open(&m, 0, (ethd_vec3){0, 0, 0});
  ethd_counters counters;
  for (int i = 0; i < 2000; i++) {
    const double y = i > 800 ? 1e-4 * (i - 800) : 0;
    const int32_t tile = (int32_t)floor(m.at.y / 0.01);
    ethd_surface near[2] = {wall_at(m.at, (ethd_vec3){1, 0, 0}, 0.05, _i ? i : tile),
                            wall_at(m.at, (ethd_vec3){1, 0, 0}, 0.05, _i ? -2 - i : tile + 1)};
    mover_step(&m, (ethd_vec3){0.048, y, 0}, (ethd_vec3){0, i > 800 ? 0.1 : 0, 0}, near, 2);
    ck_assert_int_eq(m.status, ETHD_OK);
    if (i > 790) ck_assert_int_eq(m.trace.state, ETHD_VO);
    if (i > 790) ck_assert(fabs(m.at.x - 0.05 + m.setup.radius) < 1e-5);
  }
  ck_assert(fabs(m.at.y - 0.12) < 2e-3); /* along the wall it follows */
  ethd_space_counters(m.space, &counters);
  ck_assert_uint_eq(counters.contacts_lost, 0);
  ethd_space_destroy(m.space);
}

/* ---- limits ---- */

/* A finger that turns back beside a wall takes the command over no limit, though the wall is near. */
TEST(test_turn_at_the_limits) {
  mover m = {.setup = ethd_space_setup_default()};
  m.setup.speed = 1;
  m.setup.acceleration = 2;
  mover_open(&m, 0, (ethd_vec3){0, 0, 0});
  ethd_vec3 finger = {0, 0, 0};
  for (int i = 0; i < 3000; i++) {
    const ethd_vec3 v = i < 1000 ? (ethd_vec3){1, 0, 0} : (ethd_vec3){0, -1, 0}, was = m.v;
    const ethd_surface near = wall_at(m.at, (ethd_vec3){0, 1, 0}, 0.3, 0);
    finger = ethd_vec3_add(finger, ethd_vec3_scale(1e-3, v));
    mover_step(&m, finger, v, &near, 1);
    ck_assert_int_eq(m.status, ETHD_OK);
    ck_assert(ethd_vec3_norm(m.v) <= 1 + 1e-12 && ethd_vec3_norm(ethd_vec3_sub(m.v, was)) <= 2e-3 * (1 + 1e-9));
  }
  near_to(m.v, (ethd_vec3){0, -1, 0}, 0.1);
  ethd_space_destroy(m.space);
}

/* A stop brakes with the acceleration, also when it is acknowledged meanwhile or follows from a posted speed limit of 0;
   what takes all power is zero at once. */
TEST(test_stops) {
  for (int k = 0; k < 4; k++) {
    mover m = {.setup = ethd_space_setup_default()};
    m.setup.acceleration = 2;
    mover_open(&m, 0, (ethd_vec3){0, 0, 0});
    for (int i = 0; i < 1000; i++) mover_step(&m, (ethd_vec3){1e-3 * i, 0, 0}, (ethd_vec3){1, 0, 0}, NULL, 0);
    ck_assert(m.v.x > 0.9);
    m.setup.speed = 0;
    if (k == 3) ck_assert_int_eq(ethd_space_post(m.space, &m.setup, &error), ETHD_OK);
    for (int i = 0; i < 1200; i++) {
      const ethd_vec3 was = m.v;
      ethd_space_sense s = {.time_ns = 1000000 * m.tick++, .have = ETHD_SPACE_HAVE_FINGER};
      ethd_space_command command;
      ethd_vec3_put(m.at, s.x);
      ethd_vec3_put(m.at, s.finger);
      ethd_vec3_put(m.v, s.v);
      if (i == 0 && k < 3) s.faults = ETHD_FAULT_BIT(k == 2 ? ETHD_FAULT_EMERGENCY_STOP : ETHD_FAULT_APPLICATION);
      if (k == 1 && i == 2) ethd_space_acknowledge(m.space);
      ethd_space_step(m.space, &s, NULL, 0, &command, NULL);
      m.v = ethd_vec3_of(command.value);
      m.at = ethd_vec3_add(m.at, ethd_vec3_scale(1e-3, m.v));
      if (k == 2) ck_assert(m.v.x == 0 && command.safe);
      if (k != 2) ck_assert(fabs(m.v.x - was.x) <= 2e-3 * (1 + 1e-9) && command.safe == (k != 1 && m.v.x == 0));
    }
    ck_assert(m.v.x == 0 || k == 1);
    ethd_space_destroy(m.space);
  }
}

/* ---- what is wrong ---- */

TEST(test_impossible_input) {
  static const double bad[] = {NAN, INFINITY, -INFINITY, 1e7};
  ethd_space_setup setup = ethd_space_setup_default();
  setup.latch = 0;
  ethd_space *space = made(&setup);
  for (int k = 0; k < 4 * 12 + 4; k++) {
    ethd_space_sense s = {.time_ns = k, .have = ETHD_SPACE_HAVE_FINGER | ETHD_SPACE_HAVE_NORMAL, .normal = {0, 0, 1}};
    ethd_surface near[ETHD_SURFACES_MAX + 1];
    ethd_space_command command;
    uint32_t count = 1;
    for (int i = 0; i <= ETHD_SURFACES_MAX; i++) near[i] = wall_at((ethd_vec3){0, 0, 0}, (ethd_vec3){0, 1, 0}, 0.1, i);
    ck_assert_int_eq(ethd_space_step(space, &s, near, count, &command, NULL), ETHD_OK);
    double *const numbers[] = {&s.x[0],      &s.v[2],          &s.finger[1], &s.finger_v[0],
                               &s.normal[1], &near[0].point.x, &near[0].v.z, &near[0].n.x,
                               &near[0].n.y, &near[0].point.z, &near[0].n.z, &s.x[2]};
    if (k < 48) *numbers[k / 4] = bad[k % 4];
    if (k == 48) near[0].material = 0;
    if (k == 49) near[0].material = -2;
    if (k == 50) near[0].n = (ethd_vec3){0, 1.00001, 0};
    if (k == 51) count = ETHD_SURFACES_MAX + 1;
    ck_assert_int_eq(ethd_space_step(space, &s, near, count, &command, NULL), ETHD_E_NOT_FINITE);
    ck_assert(command.safe && !command.value[0] && !command.value[1] && !command.value[2]);
  }
  ethd_space_destroy(space);
}

TEST(test_refused_setups) {
  ethd_space *space;
  ethd_space_setup s = ethd_space_setup_default();
  s.cookie = 0;
  ck_assert_int_eq(ethd_space_create(&s, &space, &error), ETHD_E_ARGUMENT);
  ethd_space_setup_fill(&s, sizeof s - 8);
  ck_assert_int_eq(ethd_space_create(&s, &space, &error), ETHD_E_SIZE);
  s = ethd_space_setup_default();
  s.radius = NAN;
  ck_assert_int_eq(ethd_space_create(&s, &space, &error), ETHD_E_NOT_FINITE);
  ck_assert_str_eq(error.name, "radius");
  s = ethd_space_setup_default();
  ethd_space_tracking(&s, &ethd_tracking_pd);
  ck_assert_int_eq(ethd_space_create(&s, &space, &error), ETHD_E_ARGUMENT);
  ck_assert_str_eq(error.name, "tracking.law (it has no velocity)");
  s = ethd_space_setup_default();
  s.materials = 1; /* whose parameters are below their least */
  s.material_p[0][0] = -1;
  ck_assert_int_eq(ethd_space_create(&s, &space, &error), ETHD_E_RANGE);
  s = ethd_space_setup_default();
  space = made(&s);
  s.kind = ETHD_SPACE_FORCE;
  ck_assert_int_eq(ethd_space_post(space, &s, &error), ETHD_E_ARGUMENT);
  ethd_space_destroy(space);
}
