/* Cuts a recording's rows into stretches. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/evidence.h"

#define NEAR 0.6       /* of the gap between finger and ring: a finger farther out may touch before the next reading */
#define APART 12e-3    /* s before and after a reading that is near which are left out */
#define PACE 0.25      /* largest deviation of a sampling interval from the period, in periods */
#define TORQUE_MAX 1e4 /* Nm: no device was commanded more */
#define CLIPS (ETHD_GUARD_TORQUE | ETHD_GUARD_RATE)

static void *longer(void *old, size_t count, size_t size) {
  void *now = realloc(old, (count ? count : 1) * size);
  if (!now) ethd__fail_memory();
  return now;
}

/* ---- the finger ---- */

static bool is_near(const ethd_setup *setup, const ethd_trace *row) {
  const ethd_sense *s = &row->sense;
  double gap = setup->ring_radius - setup->finger_radius;
  if (s->have & ETHD_HAVE_CENTRE) {
    bool world = s->have & ETHD_HAVE_WORLD;
    double x = s->centre[0] - (world ? row->x[0] : 0), y = s->centre[1] - (world ? row->x[1] : 0);
    return !(hypot(x, y) < NEAR * gap);
  }
  for (int i = 0; i < ETHD_RAYS && s->have & ETHD_HAVE_RAYS; i++)
    if (s->rays[i] < (1 - NEAR) * gap) return true;
  return false;
}

/* Leaves out the ticks about each reading of a finger that is near. */
static void keep_apart(const ethd_setup *setup, const ethd_trace *rows, size_t count, unsigned char *good) {
  int64_t pad = (int64_t)ceil(APART / setup->period);
  for (size_t i = 0; i < count; i++) {
    const ethd_sense *s = &rows[i].sense;
    if (!is_near(setup, &rows[i])) continue;
    int64_t age = (int64_t)(ethd__evidence_apart(s->sample_ns, s->time_ns) / setup->period);
    int64_t at = (int64_t)i - (age > 0 && age < 1000 ? age : 0);
    for (int64_t k = at - pad; k <= at + pad; k++)
      if (k >= 0 && k < (int64_t)count) good[k] = 0;
  }
}

static void add_delivery(ethd__evidence *e, const ethd_setup *setup, const ethd_trace *rows, size_t i) {
  const ethd_sense *s = &rows[i].sense;
  if (!(s->have & (ETHD_HAVE_CENTRE | ETHD_HAVE_RAYS))) return;
  ethd__delivery d = {s->sample_ns,
                      i ? rows[i - 1].sense.time_ns : s->sample_ns,
                      s->time_ns,
                      e->recording_count - 1,
                      {(double)NAN, (double)NAN},
                      is_near(setup, &rows[i])};
  bool world = s->have & ETHD_HAVE_WORLD;
  if (s->have & ETHD_HAVE_CENTRE && world) d.finger = (ethd_vec){s->centre[0], s->centre[1]};
  if (s->have & ETHD_HAVE_CENTRE && !world && s->have & ETHD_HAVE_RING)
    d.finger = (ethd_vec){s->ring[0] + s->centre[0], s->ring[1] + s->centre[1]};
  if (i && s->time_ns <= rows[i - 1].sense.time_ns) return; /* the clock was set back */
  if (!(e->delivery_count & (e->delivery_count + 1)))
    e->deliveries = longer(e->deliveries, 2 * e->delivery_count + 2, sizeof *e->deliveries);
  e->deliveries[e->delivery_count++] = d;
}

/* ---- stretches ---- */

static bool follows(const ethd__evidence *e, const ethd_trace *row) {
  double apart = ethd__evidence_apart(row[-1].sense.time_ns, row[0].sense.time_ns);
  return fabs(apart - e->period) <= PACE * e->period && !row->sense.missed &&
         (uint64_t)row[0].tick == (uint64_t)row[-1].tick + 1;
}

/* Returns false for NaN. */
static bool is_possible(const double v[2], double most) { return fabs(v[0]) <= most && fabs(v[1]) <= most; }

static bool is_known(const ethd_trace *row) {
  const ethd_sense *s = &row->sense;
  return !s->faults && is_possible(s->q, ETHD_SENSE_ANGLE_MAX) && is_possible(row->tau, TORQUE_MAX);
}

static void add_stretch(ethd__evidence *e, size_t first, size_t count) {
  if (count <= 2 * ETHD__BACK) return;
  e->stretches = longer(e->stretches, e->stretch_count + 1, sizeof *e->stretches);
  e->stretches[e->stretch_count++] = (ethd__passage){first, count, e->recording_count - 1};
}

static void cut(ethd__evidence *e, const ethd_trace *rows, size_t count, const unsigned char *good, size_t base) {
  size_t begin = 0;
  for (size_t i = 0; i <= count; i++) {
    if (i < count && good[i] && (i == begin || follows(e, &rows[i]))) continue;
    add_stretch(e, base + begin, i - begin);
    begin = i < count && good[i] ? i : i + 1;
  }
}

/* Updates the share of ticks at which the guard cut the torque, over all rows so far. */
static void note_clipped(ethd__evidence *e, const ethd_trace *rows, size_t count, const unsigned char *good) {
  size_t clipped = 0, counted = 0;
  for (size_t i = 0; i < count; i++) {
    if (!good[i]) continue;
    counted++;
    clipped += (rows[i].guard & CLIPS) != 0;
  }
  double before = (double)(e->count), now = (double)counted;
  if (before + now > 0) e->clipped = (e->clipped * before + (double)clipped) / (before + now);
}

void ethd__evidence_rows(ethd__evidence *e, const ethd_setup *setup, const ethd_trace *rows, size_t count,
                         const unsigned char *armed) {
  size_t base = e->count;
  ETHD__FREED unsigned char *good = longer(NULL, count, 1);
  memcpy(good, armed, count);
  e->q = longer(e->q, base + count, sizeof *e->q);
  e->torque = longer(e->torque, base + count, sizeof *e->torque);
  for (size_t i = 0; i < count; i++) {
    memcpy(e->q[base + i], rows[i].sense.q, sizeof *e->q);
    memcpy(e->torque[base + i], rows[i].tau, sizeof *e->torque);
    if (!is_known(&rows[i])) good[i] = 0;
    e->not_numbers += !isfinite(rows[i].sense.q[0] + rows[i].sense.q[1] + rows[i].tau[0] + rows[i].tau[1]);
    e->uneven += i && !follows(e, &rows[i]);
    e->unarmed += !good[i];
    add_delivery(e, setup, rows, i);
  }
  keep_apart(setup, rows, count, good);
  for (size_t i = 0; i < count; i++) e->touched += armed[i] && is_known(&rows[i]) && !good[i];
  note_clipped(e, rows, count, good);
  cut(e, rows, count, good, base);
  e->count += count;
}
