/* What holds in space whatever the numbers are: the reaction distance that delay and acceleration need, and where a mass
   under forces comes to rest. */
#include <math.h>
#include <stdlib.h>

#include "unit/mover.h"
#include "unit/suite.h"

#define T 1e-3 /* s */

/* ---- reaction distance ---- */

/* A finger that speeds up with a / 4 and goes on at v: its place and speed along n. */
typedef struct run {
  double v, a, t_d, gap;
} run;

static double finger_speed(const run *r, double t) { return fmin(r->a / 4 * t, r->v); }

static double finger_place(const run *r, double t) {
  const double whole = 4 * r->v / r->a, part = fmin(t, whole);
  return r->a / 8 * part * part + r->v * (t - part);
}

typedef struct touch {
  bool met, steady;     /* the finger has had its speed for t_d */
  double speed, offset; /* of the effector along n, m/s; how deep in the wall it is, m */
} touch;

/* The effector as the finger meets it: an oblique wall, 0.3 s after the finger has its speed. With `wait` it is a plate,
   else a ring. */
static touch touched(const run *r, const ethd_transition_law *law, double wait) {
  mover m = {.setup = ethd_space_setup_default()};
  m.setup.radius = r->gap + 0.008;
  m.setup.finger_radius = m.setup.finger_radius_max = 0.008;
  m.setup.acceleration = r->a;
  ethd_space_transition(&m.setup, law);
  if (law == &ethd_transition_approach)
    ck_assert_int_eq(ethd_space_set(&m.setup, "transition.wait", wait, NULL), ETHD_OK);
  const int late = (int)lround(r->t_d / T);
  const ethd_vec3 n = any_unit();
  const double face = wait > 0 ? m.setup.radius : 0; /* the place of the plate's point, beyond the ring's centre */
  m.setup.effector = wait > 0 ? ETHD_EFFECTOR_PLATE : ETHD_EFFECTOR_RING;
  mover_open(&m, late, ethd_vec3_scale(face, n));
  const double wall = finger_place(r, 4 * r->v / r->a + 0.3) + m.setup.radius;
  touch out = {false, false, 0, 0};
  for (int i = 0; i < 20000 && !out.met; i++) {
    const double finger = finger_place(r, i * T), x = ethd_vec3_dot(n, m.past[late]) - face;
    out.met = finger - x >= r->gap;
    out.steady = i * T >= 4 * r->v / r->a + r->t_d;
    out.speed = (x + face - ethd_vec3_dot(n, m.past[late + 1])) / T;
    out.offset = x + m.setup.radius - wall;
    const ethd_surface near = wall_at(m.at, n, wall, 0);
    ethd_space_sense s = {.have = ETHD_SPACE_HAVE_FINGER | ETHD_SPACE_HAVE_NORMAL};
    ethd_vec3_put(n, s.normal);
    ethd_vec3_put(ethd_vec3_scale(finger, n), s.finger);
    ethd_vec3_put(ethd_vec3_scale(finger_speed(r, i * T), n), s.finger_v);
    mover_sense(&m, &s, &near, 1);
    ck_assert_int_eq(m.status, ETHD_OK);
  }
  ethd_space_destroy(m.space);
  return out;
}

/* Returns the gap that `approach` needs to come to d before the wall: the finger's way until then, less the effector's. Its
   speed is the one from which its own share of the acceleration stops at that distance (Simpson's rule over the square
   root of the distance). */
static double needed(const run *r, double d) {
  enum { STEPS = 2000 };
  const double a = 0.8 * r->a, late = r->t_d + T, from = r->v * late + r->v * r->v / (2 * a);
  const double low = sqrt(d), step = (sqrt(from) - low) / STEPS;
  double time = 0;
  if (from <= d) return r->v * r->t_d;
  for (int i = 0; i <= STEPS; i++) {
    const double root = low + i * step, speed = 2 * root * root / (late + sqrt(late * late + 2 * root * root / a));
    time += (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2) * step / 3 * 2 * root / speed;
  }
  return r->v * r->t_d + r->v * time - (from - d);
}

/* No effector that follows leads the finger, it is t_d late, and changes its speed by a: if it has the speed u when a
   finger of speed v meets it, then  gap >= v t_d + (v - u)^2 / (2 a).  So one that stands there, at the offset e in the
   wall, has  gap + e >= v t_d + v^2 / (2 a).  A plate that waits is ahead by gap + wait at most. And `approach` is where it is to
   be when the gap leaves the time for it. */
TEST_LOOP(test_reaction_distance, 0, 4) {
  static const ethd_transition_law *const laws[] = {&ethd_transition_approach, &ethd_transition_approach,
                                                    &ethd_transition_smooth, &ethd_transition_offset};
  const double wait = _i == 1 ? 0.1 : 0;
  static const double speeds[] = {0.1, 0.2, 0.4, 0.6}, accelerations[] = {2, 10, 40}, delays[] = {0, 8e-3, 30e-3},
                      gaps[] = {0.01, 0.03, 0.06, 0.12};
  int stood = 0, moved = 0, could = 0;
  for (int k = 0; k < 4 * 3 * 3 * 4; k++) {
    const run r = {speeds[k % 4], accelerations[k / 4 % 3], delays[k / 12 % 3], gaps[k / 36]};
    const touch at = touched(&r, laws[_i], wait);
    const double ahead = r.gap + wait;
    const double needs = r.v * r.t_d + r.v * r.v / (2 * r.a), sampling = 2 * r.v * T;
    ck_assert(at.met);
    if (!at.steady) { /* the finger is on it while both are free */
      ck_assert(r.gap <= r.v * r.t_d + sampling);
      continue;
    }
    const double slower = fmax(r.v - at.speed, 0);
    ck_assert_msg(ahead >= r.v * r.t_d + slower * slower / (2 * r.a) - sampling,
                  "%g m/s, %g m/s2, %g s, gap %g m: met at %g m/s", r.v, r.a, r.t_d, r.gap, at.speed);
    const bool stands = fabs(at.speed) < 0.02;
    if (stands) ck_assert(ahead + at.offset >= needs - sampling);
    stood += stands;
    moved += !stands;
    if (_i > 1 || r.gap < needed(&r, 1e-4) + sampling) continue;
    ck_assert_msg(stands && fabs(at.offset) < 1.2e-4, "%g m/s, %g m/s2, %g s, gap %g m: %g m/s, offset %g m", r.v, r.a,
                  r.t_d, r.gap, at.speed, at.offset);
    could++;
  }
  printf("%s: stood in %d, moved in %d of 144; %d had the room\n", laws[_i]->law.id, stood, moved, could);
  ck_assert(_i == 1 ? stood > 120 : moved > 10);
  ck_assert(_i > 1 || (stood >= could && could > 50));
}

/* ---- forces ---- */

/* A free mass under force commands, `late` ticks behind. */
typedef struct mass {
  ethd_space *space;
  ethd_space_setup setup;
  ethd_vec3 x, v, waiting[LATE_MAX + 1]; /* forces, the newest first */
  int late;
  ethd_space_trace trace;
} mass;

static void mass_step(mass *m, int tick, ethd_vec3 finger, ethd_vec3 finger_v, const ethd_surface *near) {
  ethd_space_sense s = {.time_ns = 1000000 * (int64_t)tick, .have = ETHD_SPACE_HAVE_FINGER};
  ethd_space_command command;
  ethd_vec3_put(m->x, s.x);
  ethd_vec3_put(m->v, s.v);
  ethd_vec3_put(finger, s.finger);
  ethd_vec3_put(finger_v, s.finger_v);
  ck_assert_int_eq(ethd_space_step(m->space, &s, near, 1, &command, &m->trace), ETHD_OK);
  for (int i = m->late; i > 0; i--) m->waiting[i] = m->waiting[i - 1];
  m->waiting[0] = ethd_vec3_of(command.value);
  const ethd_vec3 a = ethd_vec3_scale(1 / m->setup.ability.mass, m->waiting[m->late]);
  m->x = ethd_vec3_add(m->x, ethd_vec3_add(ethd_vec3_scale(T, m->v), ethd_vec3_scale(T * T / 2, a)));
  m->v = ethd_vec3_add(m->v, ethd_vec3_scale(T, a));
}

/* Where `approach` rests: the spring to the finger, which has met the wall, against the wall and the hold (bisection). */
static double rest_of(const ethd_space_setup *s, double gap, double brake, double late) {
  const double a = 0.8 * s->ability.force / s->ability.mass;
  double low = 0, high = gap;
  for (int i = 0; i < 100; i++) {
    const double e = (low + high) / 2, hold = brake * 2 * e / (late + sqrt(late * late + 2 * e / a));
    *(s->tracking_p[0] * (gap - e) > hold + s->contact_p[0] * e ? &low : &high) = e;
  }
  return low;
}

/* A mass under forces before an oblique wall is held by a damping, so the finger's spring takes it into the wall: it comes
   to rest where that spring, the wall and the hold are in balance. */
TEST_LOOP(test_mass_under_forces, 0, 24) {
  const double v = (double[]){0.1, 0.2, 0.4}[_i % 3], gap = _i / 3 % 2 ? 0.06 : 0.01, kg = _i / 6 % 2 ? 2 : 0.3;
  mass m = {.setup = ethd_space_setup_default(), .late = _i / 12 ? 3 : 0};
  ethd_space_setup *s = &m.setup;
  s->kind = ETHD_SPACE_FORCE;
  s->radius = gap + 0.008;
  s->finger_radius = s->finger_radius_max = 0.008;
  s->force = s->ability.force = 30;
  s->ability.mass = kg;
  s->ability.delay = m.late * T;
  m.space = made(s);
  const double wall = 0.5, late = s->ability.delay + T, brake = kg / (exp(1) * late);
  const ethd_vec3 n = any_unit();
  double x = 0, deepest = 0;
  for (int i = 0; i * T < 0.5 / v + 3; i++) {
    const bool stops = v * i * T >= wall - 0.008;
    const ethd_surface near = wall_at(m.x, n, wall, 0);
    mass_step(&m, i, ethd_vec3_scale(stops ? wall - 0.008 : v * i * T, n), ethd_vec3_scale(stops ? 0 : v, n), &near);
    x = ethd_vec3_dot(n, m.x) + s->radius - wall;
    deepest = fmax(deepest, x);
  }
  printf("%g m/s, gap %g m, %g kg, %d ticks late: at most %.3f mm deep, rests %.3f mm deep\n", v, gap, kg, m.late,
         1e3 * deepest, 1e3 * x);
  ck_assert(m.trace.state == ETHD_VO && ethd_vec3_norm(m.v) < 1e-6);
  ck_assert_double_eq_tol(x, rest_of(s, gap, brake, late), 1e-7);
  ethd_space_destroy(m.space);
}
