#include "unit/mover.h"

#include <check.h>
#include <string.h>

#include "unit/draw.h"

static uint64_t drawn = 1;

double between(double a, double b) { return draw(drawn++, a, b); }

ethd_vec3 any_unit(void) {
  for (;;) {
    const ethd_vec3 a = {between(-1, 1), between(-1, 1), between(-1, 1)};
    const double length = ethd_vec3_norm(a);
    if (length > 0.1 && length < 1) return ethd_vec3_scale(1 / length, a);
  }
}

ethd_space *made(const ethd_space_setup *setup) {
  ethd_error error;
  ethd_space *space;
  ck_assert_msg(ethd_space_create(setup, &space, &error) == ETHD_OK, "%s", error.name);
  return space;
}

void mover_open(mover *m, int late, ethd_vec3 at) {
  m->setup.ability.delay = late * m->setup.period;
  m->space = made(&m->setup);
  m->late = late;
  m->at = at;
  m->v = (ethd_vec3){0, 0, 0};
  m->tick = 0;
  for (int i = 0; i <= LATE_MAX; i++) m->past[i] = at;
}

int64_t mover_now(const mover *m) { return (int64_t)(1e9 * m->setup.period) * m->tick; }

void mover_sense(mover *m, ethd_space_sense *s, const ethd_surface *near, uint32_t count) {
  s->time_ns = mover_now(m);
  m->tick++;
  ethd_vec3_put(m->at, s->x);
  ethd_vec3_put(m->v, s->v);
  m->status = ethd_space_step(m->space, s, near, count, &m->command, &m->trace);
  m->v = ethd_vec3_of(m->command.value);
  m->at = ethd_vec3_add(m->at, ethd_vec3_scale(m->setup.period, m->v));
  memmove(m->past + 1, m->past, sizeof m->past - sizeof *m->past);
  m->past[0] = m->at;
}

void mover_step(mover *m, ethd_vec3 finger, ethd_vec3 finger_v, const ethd_surface *near, uint32_t count) {
  ethd_space_sense s = {.have = ETHD_SPACE_HAVE_FINGER};
  ethd_vec3_put(finger, s.finger);
  ethd_vec3_put(finger_v, s.finger_v);
  mover_sense(m, &s, near, count);
}

ethd_surface wall_at(ethd_vec3 x, ethd_vec3 n, double c, int32_t id) {
  const double d = c - ethd_vec3_dot(n, x);
  return (ethd_surface){.point = ethd_vec3_add(x, ethd_vec3_scale(d, n)), .n = n, .id = id, .material = -1};
}
