/* The control thread's side of the servo. It touches two cells and nothing else. */
#include <string.h>

#include "servo/device.h"

#define OLD_LEAST 5000000 /* ns: feedback older than this, or than two exchanges, is a fault */
#define GRACE 100000000   /* ns after a start for the first fresh sample */

int64_t ethd__servo_old(const ethd__servo_device *d) {
  int64_t two = 2 * d->exchange_ns;
  return two > OLD_LEAST ? two : OLD_LEAST;
}

static void add_edges(ethd__servo_device *d, ethd_sense *out) {
  const ethd__servo_sample *s = &d->newest;
  for (int row = 0; row < ETHD_FAULT_COUNT; row++) {
    if (s->rows[row] != d->seen_rows[row]) out->faults |= ETHD_FAULT_BIT(row);
    if (s->worst[row] != d->seen_worst[row]) out->grave |= ETHD_FAULT_BIT(row);
  }
  memcpy(d->seen_rows, s->rows, sizeof s->rows);
  memcpy(d->seen_worst, s->worst, sizeof s->worst);
}

/* Two units are read one after the other: the sense has the later sample's time, and the other sample has an age. */
static void add_ages(const ethd__servo_device *d, ethd_sense *out) {
  const int64_t *later = d->newest.later_ns, last = later[0] > later[1] ? later[0] : later[1];
  out->time_ns += last;
  if (d->joint[0] < 0 || d->joint[1] < 0 || !last) return;
  out->have |= ETHD_HAVE_AGE;
  for (int i = 0; i < 2; i++) out->age[d->joint[i]] = 1e-9 * (double)(last - later[i]);
}

static void add_commanded(const ethd__servo_device *d, ethd_sense *out) {
  if (d->joint[0] < 0 || d->joint[1] < 0 || !(d->newest.has & ETHD__SERVO_HAS_CUT)) return;
  out->have |= ETHD_HAVE_COMMANDED;
  for (int i = 0; i < 2; i++) out->commanded[d->joint[i]] = d->newest.torque[i];
}

static void add_joints(const ethd__servo_device *d, ethd_sense *out) {
  const ethd__servo_sample *s = &d->newest;
  out->time_ns = s->stamp_ns;
  add_ages(d, out);
  for (int i = 0; i < 2; i++) {
    int32_t joint = d->joint[i];
    if (joint < 0) continue;
    out->q[joint] = s->q[i];
    if (s->has & ETHD__SERVO_HAS_SPEED) out->dq[joint] = s->dq[i];
  }
  if (s->has & ETHD__SERVO_HAS_SPEED) out->have |= ETHD_HAVE_DQ;
}

/* A reading that is younger than a late tick waits for the next one. */
static void add_reading(ethd__servo_device *d, int64_t now_ns, ethd_sense *out) {
  const ethd__servo_sample *s = &d->newest;
  if (!(s->has & ETHD__SERVO_HAS_READING) || s->readings == d->seen_readings || s->reading_ns > now_ns) return;
  d->seen_readings = s->readings;
  out->have |= ETHD_HAVE_CENTRE;
  out->sample_ns = s->reading_ns;
  out->centre[0] = s->reading[0];
  out->centre[1] = s->reading[1];
}

/* The fault bit of old feedback; not in the first moments after a start, while the threads come up. */
static int64_t is_old(ethd__servo_device *d, int64_t now_ns) {
  if (d->seen_epoch != d->newest.epoch) {
    d->seen_epoch = d->newest.epoch;
    d->grace_ns = now_ns + GRACE;
  }
  if (now_ns < d->grace_ns) return 0;
  return now_ns - d->newest.stamp_ns > ethd__servo_old(d) ? ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD) : 0;
}

ethd_status ethd__servo_read(void *device, int64_t now_ns, ethd_sense *out) {
  ethd__servo_device *d = device;
  (void)!ethd_cell_take(d->samples, &d->newest);
  const ethd__servo_sample *s = &d->newest;
  int fresh = s->number != d->seen_number;
  int64_t lasting = s->levels | is_old(d, now_ns);
  d->seen_number = s->number;
  if (fresh) {
    d->grace_ns = d->grace_ns < now_ns ? d->grace_ns : now_ns;
    ethd_histogram_add(&d->age, now_ns - s->stamp_ns);
  }
  /* a row that only counts waits for the next sample; one that ends the torque doesn't */
  if (!fresh && !lasting) return ETHD_STATUS_STALE;
  add_edges(d, out);
  out->faults |= lasting;
  out->grave |= s->grave;
  add_joints(d, out);
  if (fresh) add_commanded(d, out);
  if (fresh) add_reading(d, now_ns, out);
  return fresh ? ETHD_OK : ETHD_STATUS_STALE;
}

ethd_status ethd__servo_write(void *device, int64_t now_ns, const ethd_command *command) {
  ethd__servo_device *d = device;
  ethd__servo_command c = {.stamp_ns = now_ns, .epoch = atomic_load_explicit(&d->epoch, memory_order_relaxed)};
  for (int i = 0; i < 2; i++)
    if (d->joint[i] >= 0 && !command->safe) c.torque[i] = command->torque[d->joint[i]];
  ethd_cell_put(d->commands, &c);
  return ETHD_OK;
}

void ethd__servo_safe(void *device) {
  atomic_store_explicit(&((ethd__servo_device *)device)->safe, 1, memory_order_relaxed);
}
