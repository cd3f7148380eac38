/* Adds what one driver has measured to the sense that other drivers, or earlier ticks without a step, have filled. */
#ifndef ETHD__ADD_SENSE_H
#define ETHD__ADD_SENSE_H

#include <stdbool.h>
#include <string.h>

#include "ethd/sense.h"
#include "ethd/space.h"

/* The bits of a reading of the finger, which belong together. */
#define ETHD__READING \
  ((int64_t)(ETHD_HAVE_FINGER | ETHD_HAVE_CENTRE | ETHD_HAVE_RAYS | ETHD_HAVE_RING | ETHD_HAVE_WORLD))

/* Puts a whole reading in the place of the one that is there. [any, rt-safe] */
static inline void ethd__sense_put_reading(const ethd_sense *from, ethd_sense *to) ETHD_RT {
  to->have = (to->have & ~ETHD__READING) | (from->have & ETHD__READING);
  to->sample_ns = from->sample_ns;
  to->finger_noise = from->finger_noise;
  memcpy(to->finger, from->finger, sizeof to->finger);
  memcpy(to->finger_v, from->finger_v, sizeof to->finger_v);
  memcpy(to->centre, from->centre, sizeof to->centre);
  memcpy(to->ring, from->ring, sizeof to->ring);
  memcpy(to->rays, from->rays, sizeof to->rays);
}

/* Adds what `from` holds; its joint sample only if that is new. [any, rt-safe] */
static inline void ethd__sense_add(const ethd_sense *from, bool has_joints, ethd_sense *to) ETHD_RT {
  to->faults |= from->faults;
  to->grave |= from->grave;
  if (from->have & ETHD__READING) ethd__sense_put_reading(from, to);
  if (from->have & ETHD_HAVE_START) memcpy(to->finger, from->finger, sizeof to->finger);
  if (from->have & ETHD_HAVE_COMMANDED) memcpy(to->commanded, from->commanded, sizeof to->commanded);
  to->have |= from->have;
  for (int b = 0; b < ETHD_BODIES_MAX; b++)
    if (from->have & ((int64_t)ETHD_HAVE_BODY << b))
      memcpy(to->bodies + 6 * b, from->bodies + 6 * b, 6 * sizeof *from->bodies);
  if (!has_joints) return;
  to->time_ns = from->time_ns;
  memcpy(to->q, from->q, sizeof to->q);
  if (from->have & ETHD_HAVE_DQ) memcpy(to->dq, from->dq, sizeof to->dq);
  if (from->have & ETHD_HAVE_AGE) memcpy(to->age, from->age, sizeof to->age);
}

/* The same in space. */
#define ETHD__SPACE_READING                                                                 \
  ((int64_t)(ETHD_SPACE_HAVE_FINGER | ETHD_SPACE_HAVE_READING | ETHD_SPACE_HAVE_READING_V | \
             ETHD_SPACE_HAVE_EXTRAPOLATED))

static inline void ethd__space_put_reading(const ethd_space_sense *from, ethd_space_sense *to) ETHD_RT {
  to->have = (to->have & ~ETHD__SPACE_READING) | (from->have & ETHD__SPACE_READING);
  to->sample_ns = from->sample_ns;
  to->reading_noise = from->reading_noise;
  to->reading_v_noise = from->reading_v_noise;
  memcpy(to->finger, from->finger, sizeof to->finger);
  memcpy(to->finger_v, from->finger_v, sizeof to->finger_v);
  memcpy(to->reading, from->reading, sizeof to->reading);
  memcpy(to->reading_v, from->reading_v, sizeof to->reading_v);
}

static inline void ethd__space_add(const ethd_space_sense *from, bool has_effector, ethd_space_sense *to) ETHD_RT {
  to->faults |= from->faults;
  to->grave |= from->grave;
  if (from->have & ETHD__SPACE_READING) ethd__space_put_reading(from, to);
  if (from->have & ETHD_SPACE_HAVE_NORMAL) memcpy(to->normal, from->normal, sizeof to->normal);
  if (from->have & ETHD_SPACE_HAVE_ABILITY) memcpy(to->ability, from->ability, sizeof to->ability);
  if (from->have & ETHD_SPACE_HAVE_COMMANDED) memcpy(to->commanded, from->commanded, sizeof to->commanded);
  to->have |= from->have;
  if (!has_effector) return;
  to->time_ns = from->time_ns;
  memcpy(to->x, from->x, sizeof to->x);
  memcpy(to->v, from->v, sizeof to->v);
}

#endif
