#include "servo/feedback.h"

#include <math.h>
#include <string.h>

#include "servo/words.h"

static const ethd__servo_register *role(const ethd__servo_link *l, int which, double *raw) {
  int32_t r = l->map->roles[which];
  if (r < 0) return NULL;
  *raw = l->raw[r];
  return &l->map->registers[r];
}

/* ---- joints ---- */

/* The shorter way round a counter of r->bits. */
static double unwrap(ethd__servo_axis *a, const ethd__servo_register *r, double raw) {
  uint32_t mask = r->bits < 32 ? (1u << r->bits) - 1 : UINT32_MAX, half = 1u << (r->bits - 1);
  uint32_t now = (uint32_t)(int64_t)raw & mask, up = (now - a->last) & mask;
  if (!a->started) a->count = (int64_t)raw;
  else a->count += up >= half ? (int64_t)up - (int64_t)mask - 1 : (int64_t)up;
  a->last = now;
  return (double)a->count;
}

static void take_axis(ethd__servo_feedback *f, const ethd__servo_link *l, int i) {
  double raw, speed;
  ethd__servo_axis *a = &f->axes[i];
  const ethd__servo_register *r = role(l, ETHD__SERVO_POSITION1 + i, &raw);
  if (!r) return;
  double q = ethd__servo_joint(r, r->type == ETHD__SERVO_F32 ? raw : unwrap(a, r, raw));
  if (!a->started) a->offset = isnan(f->home[i]) ? 0 : f->home[i] - q;
  a->started = true;
  f->sample.q[i] = q + a->offset;
  r = role(l, ETHD__SERVO_SPEED1 + i, &speed);
  if (!r) f->sample.has &= ~ETHD__SERVO_HAS_SPEED;
  else f->sample.dq[i] = ethd__servo_joint(r, speed);
}

static void take_reading(ethd__servo_feedback *f, const ethd__servo_link *l) {
  double count, x = 0, y = 0, age = 0;
  const ethd__servo_register *r = role(l, ETHD__SERVO_READING_COUNT, &count);
  if (!r || (f->sample.readings && count == f->count)) return;
  f->count = count;
  f->sample.reading[0] = ethd__servo_joint(role(l, ETHD__SERVO_READING_X, &x), x);
  f->sample.reading[1] = ethd__servo_joint(role(l, ETHD__SERVO_READING_Y, &y), y);
  r = role(l, ETHD__SERVO_READING_AGE, &age);
  f->sample.reading_ns = f->sample.stamp_ns - (r ? (int64_t)(1e9 * ethd__servo_joint(r, age)) : 0);
  f->sample.readings++;
  f->sample.has |= ETHD__SERVO_HAS_READING;
}

/* ---- a drive that doesn't follow ---- */

static double scale_at_joint(const ethd__servo_register *r) {
  return fabs((ethd__servo_joint(r, 1) - ethd__servo_joint(r, 0)) / r->scale);
}

/* Answers may be of the set-point before, so either counts. */
static bool follows(ethd__servo_axis *a, const ethd__servo_link *l, int i, double torque) {
  double raw, before = a->torque;
  const ethd__servo_register *r = role(l, ETHD__SERVO_MEASURED1 + i, &raw);
  a->torque = torque;
  if (!r || !(r->tolerance > 0)) return true;
  double measured = ethd__servo_joint(r, raw), most = r->tolerance * scale_at_joint(r);
  return fabs(measured - torque) <= most || fabs(measured - before) <= most;
}

static void watch_torque(ethd__servo_feedback *f, const ethd__servo_link *l, const double torque[2]) {
  f->sample.levels &= ~ETHD_FAULT_BIT(ETHD_FAULT_NOT_FOLLOWED);
  for (int i = 0; i < 2; i++) {
    ethd__servo_axis *a = &f->axes[i];
    bool fine = follows(a, l, i, torque[i]) || l->state != ETHD__SERVO_ENABLED;
    if (fine) a->since_ns = 0;
    else if (!a->since_ns) a->since_ns = f->sample.stamp_ns;
    if (a->since_ns && 1e-9 * (double)(f->sample.stamp_ns - a->since_ns) >= ETHD__SERVO_FOLLOW)
      f->sample.levels |= ETHD_FAULT_BIT(ETHD_FAULT_NOT_FOLLOWED);
  }
}

void ethd__servo_feedback_take(ethd__servo_feedback *f, const ethd__servo_link *l, int64_t stamp_ns,
                               const double torque[2]) {
  f->sample.stamp_ns = stamp_ns;
  f->sample.number++;
  f->sample.has |= ETHD__SERVO_HAS_SPEED;
  for (int i = 0; i < 2; i++) take_axis(f, l, i);
  take_reading(f, l);
  watch_torque(f, l, torque);
}

/* ---- what lasts ---- */

static bool drive_fault(const ethd__servo_link *l) {
  for (uint32_t i = 0; i < l->map->count; i++) {
    const ethd__servo_register *r = &l->map->registers[i];
    if (!(r->fault_mask | r->enabled_mask)) continue;
    uint32_t bits = (uint32_t)(int64_t)l->raw[i];
    if ((bits & r->fault_mask) != r->healthy) return true;
    if (l->state == ETHD__SERVO_ENABLED && (bits & r->enabled_mask) != r->enabled) return true;
  }
  return false;
}

static bool voltage_fault(const ethd__servo_link *l) {
  double raw;
  const ethd__servo_register *r = role(l, ETHD__SERVO_BUS_VOLTAGE, &raw);
  double volts = r ? ethd__servo_joint(r, raw) : 0;
  return r && !(volts >= r->min && volts <= r->max);
}

static void put(int64_t *bits, ethd_fault row, bool on) {
  *bits = on ? *bits | ETHD_FAULT_BIT(row) : *bits & ~ETHD_FAULT_BIT(row);
}

void ethd__servo_feedback_judge(ethd__servo_feedback *f, const ethd__servo_link *l) {
  ethd__servo_sample *s = &f->sample;
  bool spoilt = l->bucket > ETHD__SERVO_BUCKET_LIMIT;
  put(&s->levels, ETHD_FAULT_LINK_LOST, l->state == ETHD__SERVO_DOWN);
  put(&s->levels, ETHD_FAULT_REPLY_BAD, spoilt);
  put(&s->levels, ETHD_FAULT_SET_POINT, l->set_point_stays);
  put(&s->grave, ETHD_FAULT_REPLY_BAD, spoilt);
  memcpy(s->rows, l->rows, sizeof s->rows);
  if (!l->counts.exchanges) return;
  put(&s->levels, ETHD_FAULT_DRIVE, drive_fault(l));
  put(&s->levels, ETHD_FAULT_BUS_VOLTAGE, voltage_fault(l));
}
