/* Where the workspace ends: a plate that turns and slides there, and walls that would lead over its bound. */
#include <math.h>

#include "unit/mover.h"
#include "unit/suite.h"

#define T 1e-3 /* s */

/* A plate that follows a finger to and fro between the walls of a corner, in which its workspace ends: it turns to the
   nearer wall no faster than it may, and its face stays in the workspace, whatever the finger does. */
TEST(test_plate_turns_at_its_bound) {
  mover m = {.setup = ethd_space_setup_default()};
  ethd_space_setup *s = &m.setup;
  s->effector = ETHD_EFFECTOR_PLATE;
  s->radius = 0.068;
  s->finger_radius = s->finger_radius_max = 0.008;
  s->speed = 1;
  s->acceleration = 10;
  s->turn_rate = 4;
  s->x_max = 0.3;
  s->reach = 0.45;
  mover_open(&m, 0, (ethd_vec3){0.1, 0, 0});
  const ethd_vec3 n[2] = {{1, 0, 0}, {0, 0.6, 0.8}};
  ethd_vec3 facing = {0, 0, 0};
  double turned = 0, nearest[2] = {1, 1}, most_x = 0, most_r = 0;
  int at_rate = 0;
  for (int i = 0; i < 20000; i++) {
    const double t = T * i;
    const ethd_vec3 finger = {0.25 + 0.2 * sin(2.1 * t), 0.2 + 0.3 * sin(1.3 * t), 0.15 + 0.3 * cos(1.7 * t)};
    const ethd_vec3 v = {0.42 * cos(2.1 * t), 0.39 * cos(1.3 * t), -0.51 * sin(1.7 * t)};
    const ethd_surface near[2] = {wall_at(m.at, n[0], 0.32, 0), wall_at(m.at, n[1], 0.4, 1)};
    const ethd_vec3 was = m.v;
    mover_step(&m, finger, v, near, 2);
    if (m.status != ETHD_OK) ck_abort_msg("tick %d: fault %d", i, (int)m.trace.fault);
    const ethd_vec3 now = ethd_vec3_of(m.command.normal);
    ck_assert(fabs(ethd_vec3_norm(now) - 1) <= 1e-12);
    if (i) {
      const double angle = atan2(ethd_vec3_norm(ethd_vec3_cross(facing, now)), ethd_vec3_dot(facing, now));
      ck_assert_double_le(angle, 4 * T * (1 + 1e-9));
      at_rate += angle > 4 * T * (1 - 1e-9);
      turned += angle;
    }
    facing = now;
    for (int k = 0; k < 2; k++) nearest[k] = fmin(nearest[k], ethd_vec3_norm(ethd_vec3_sub(facing, n[k])));
    ck_assert(ethd_vec3_norm(m.v) <= 1 + 1e-12 && ethd_vec3_norm(ethd_vec3_sub(m.v, was)) <= 10 * T * (1 + 1e-9));
    most_x = fmax(most_x, m.at.x);
    most_r = fmax(most_r, ethd_vec3_norm(m.at));
  }
  printf("turned by %.1f rad, %d ticks at the fastest; nearest to the bounds %.1e and %.1e m\n", turned, at_rate,
         0.3 - most_x, 0.45 - most_r);
  ck_assert(most_x <= 0.3 + 1e-9 && most_r <= 0.45 + 1e-9 && most_x > 0.29);
  ck_assert(nearest[0] < 1e-6 && nearest[1] < 1e-6 && at_rate > 1000);
  ethd_space_destroy(m.space);
}

/* A wall that the effector is held at begins to move, aslant to the workspace's bound: the way along the wall's normal
   would lead over the bound. */
TEST(test_held_at_its_bound) {
  mover m = {.setup = ethd_space_setup_default()};
  m.setup.acceleration = 10;
  m.setup.x_max = 0.1;
  mover_open(&m, 0, (ethd_vec3){0, 0, 0});
  const ethd_vec3 n = {0.6, 0.8, 0}, finger = {0.12, 0.01, 0};
  double wall = 0.06 + m.setup.radius;
  for (int i = 0; i < 3000; i++) {
    ethd_surface near = wall_at(m.at, n, wall, 0);
    if (i > 2000) near.v = ethd_vec3_scale(0.2, n), wall += 0.2 * T;
    mover_step(&m, i > 2000 ? ethd_vec3_add(finger, ethd_vec3_scale(0.2 * T * (i - 2000), n)) : finger, near.v, &near,
               1);
    if (m.status != ETHD_OK) ck_abort_msg("tick %d: fault %d", i, (int)m.trace.fault);
    if (i == 2000) ck_assert(m.trace.state == ETHD_VO && m.at.x > 0.1 - 1e-6);
  }
  ck_assert(m.at.x <= 0.1 + 1e-9 && m.at.y > 0.1);
  ethd_space_destroy(m.space);
}
