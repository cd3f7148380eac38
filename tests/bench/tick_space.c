/* The tick in space beside the plane's: the same taps, with one surface handed in, and with as many as a tick takes. */
#include <stdlib.h>

#include "bench/tick.h"
#include "cli/cli.h"
#include "ethd/space.h"

typedef struct spacing {
  ethd_space *space;
  ethd_space_sense senses[ETHD__TAP_TICKS];
  ethd_surface surfaces[ETHD_SURFACES_MAX];
  uint32_t count; /* of surfaces */
  ethd_space_trace traces[ETHD__TICK_RING];
  unsigned next;
} spacing;

/* The plane's taps as a device in space tells them. */
static void tell(const ethd__ticking *plane, spacing *s) {
  const ethd_setup setup = ethd_setup_default();
  for (int k = 0; k < ETHD__TAP_TICKS; k++) {
    const ethd_sense *from = &plane->senses[k];
    ethd_space_sense *to = &s->senses[k];
    ethd_pose pose;
    ethd_arm_pose(&setup.arm, from->q, &pose);
    to->time_ns = from->time_ns;
    to->sample_ns = from->sample_ns;
    if (from->have & ETHD_HAVE_CENTRE) to->have |= ETHD_SPACE_HAVE_READING;
    for (int i = 0; i < 2; i++) to->reading[i] = (i ? pose.x.y : pose.x.x) + from->centre[i];
    to->x[0] = pose.x.x;
    to->x[1] = pose.x.y;
  }
}

static spacing *spacing_create(const ethd__ticking *plane, uint32_t count) {
  spacing *s = calloc(1, sizeof *s);
  ethd_space_setup setup = ethd_space_setup_default();
  setup.kind = ETHD_SPACE_FORCE;
  setup.radius = 0.012;
  setup.finger_radius_max = 0.0095;
  ethd_space_transition(&setup, &ethd_transition_offset);
  if (!s || ethd_space_create(&setup, &s->space, NULL) < 0) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  tell(plane, s);
  for (s->count = 0; s->count < count; s->count++)
    s->surfaces[s->count] =
        (ethd_surface){{0.238 - 0.05 * s->count, 0.25, 0}, {-1, 0, 0}, {0, 0, 0}, (int32_t)s->count, -1};
  return s;
}

static void tap(void *data) {
  spacing *s = data;
  for (int k = 0; k < ETHD__TAP_TICKS; k++) {
    ethd_space_sense *sense = &s->senses[k];
    ethd_space_command command;
    sense->time_ns += 1000000 * (int64_t)ETHD__TAP_TICKS;
    sense->sample_ns += 1000000 * (int64_t)ETHD__TAP_TICKS;
    if (ethd_space_step(s->space, sense, s->surfaces, s->count, &command, &s->traces[s->next++ % ETHD__TICK_RING]) < 0)
      ethd__fail(ETHD_EXIT_FAILED, "tick %u in space is at fault", s->next);
  }
}

void ethd__tick_space(const bench_entry *plane, int quick) {
  static const uint32_t counts[] = {1, ETHD_SURFACES_MAX};
  bench_entry all[3] = {*plane};
  for (int i = 0; i < 2; i++)
    all[1 + i] = (bench_entry){"", tap, spacing_create(plane->data, counts[i]), ETHD__TAP_TICKS, 0};
  bench_race(all, 3, quick ? 0.2 : 2);
  const double each = (all[2].ns - all[1].ns) / (ETHD_SURFACES_MAX - 1);
  printf("in space: %.0f ns a tick with one surface, %.1f ns more for each that is far; in the plane without a scene "
         "%.0f ns\n",
         all[1].ns, each, all[0].ns);
  bench_goal("hot mean in space with one surface, against the plane's without scene, times", all[1].ns / all[0].ns, 1.2,
             "");
  for (int i = 1; i < 3; i++) {
    ethd_space_destroy(((spacing *)all[i].data)->space);
    free(all[i].data);
  }
}
