/* Random ticks in space: commands stay within their limits, and each tick repeats from its trace to the bit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit/mover.h"
#include "unit/suite.h"

/* As ck_assert, which also writes to a file each time. */
#define KEPT(so) \
  if (!(so)) ck_abort_msg("tick %ld: %s", k, #so)

/* Runs a tick again from its trace, on a controller that has had the same ones before. */
static void repeat(ethd_space *space, const ethd_space_trace *trace, long k) {
  ethd_surface near[ETHD_NEAR_MAX];
  ethd_space_command command;
  ethd_space_trace again;
  for (int i = 0; i < trace->near; i++)
    near[i] = (ethd_surface){.point = ethd_vec3_of(trace->near_point + 3 * i),
                             .n = ethd_vec3_of(trace->near_n + 3 * i),
                             .v = ethd_vec3_of(trace->near_v + 3 * i),
                             .id = (int32_t)trace->near_id[i],
                             .material = (int32_t)trace->near_material[i]};
  (void)ethd_space_step(space, &trace->sense, near, (uint32_t)trace->near, &command, &again);
  again.overflow = trace->overflow;
  KEPT(memcmp(&again, trace, sizeof again) == 0);
}

static void events(ethd_space *space) {
  ethd_event event;
  while (ethd_space_poll(space, &event) == ETHD_OK) {
  }
}

/* Whatever comes in, a velocity command stays within speed, acceleration and workspace; after a fault it goes to zero
   with the acceleration, and an acknowledgement lets it go on. */
TEST_LOOP(test_random_ticks, 0, 2) {
  const long ticks = getenv("ETHD_STRESS") ? 25000000 : 100000;
  const bool refuses = _i; /* impossible surfaces come, which no trace has */
  mover m = {.setup = ethd_space_setup_default()};
  m.setup.speed = 0.8;
  m.setup.acceleration = 12;
  m.setup.x_min = m.setup.y_min = m.setup.z_min = -0.3;
  m.setup.x_max = m.setup.y_max = m.setup.z_max = 0.3;
  m.setup.reach = 0.4;
  m.setup.gap = 0.005;
  mover_open(&m, 0, (ethd_vec3){0, 0, 0});
  ethd_space *twin = made(&m.setup);
  long faults = 0, moved = 0;
  for (long k = 0; k < ticks; k++) {
    ethd_surface near[ETHD_SURFACES_MAX];
    const uint32_t count = (uint32_t)between(0, k % 100 == 0 ? ETHD_SURFACES_MAX : 5);
    for (uint32_t i = 0; i < count; i++) {
      near[i] = wall_at(m.at, any_unit(), between(-0.2, 0.3), (int32_t)between(0, 3));
      near[i].v = ethd_vec3_scale(between(0, 0.3), any_unit());
    }
    if (refuses && k % 997 == 0 && count) near[0].n.x += between(-1, 1);
    if (k % 5000 == 0) {
      ethd_error error;
      ethd_space_transition(&m.setup, k % 10000 ? &ethd_transition_offset : &ethd_transition_approach);
      KEPT(ethd_space_post(m.space, &m.setup, &error) >= ETHD_OK);
      KEPT(ethd_space_post(twin, &m.setup, &error) >= ETHD_OK);
    }
    if (k % 300 == 0) {
      ethd_space_acknowledge(m.space);
      ethd_space_acknowledge(twin);
    }
    const ethd_vec3 was = m.v;
    mover_step(&m, ethd_vec3_scale(between(0, 1), any_unit()), ethd_vec3_scale(between(0, 3), any_unit()), near, count);
    if (!refuses) repeat(twin, &m.trace, k);
    KEPT(ethd_vec3_norm(m.v) <= 0.8 * (1 + 1e-12));
    const double change = ethd_vec3_norm(ethd_vec3_sub(m.v, was));
    KEPT(change <= 12e-3 * (1 + 1e-9) || m.status == ETHD_E_NOT_FINITE);
    KEPT(ethd_vec3_norm(m.at) <= 0.4 + 1e-9);
    KEPT(fmax(fmax(fabs(m.at.x), fabs(m.at.y)), fabs(m.at.z)) <= 0.3 + 1e-9);
    faults += m.status < 0;
    moved += change > 0;
    events(m.space);
    events(twin);
  }
  ck_assert(moved > ticks / 10 && (faults > ticks / 100) == refuses);
  ethd_space_destroy(m.space);
  ethd_space_destroy(twin);
}
