#include "servo/feedback.h"

#include <math.h>

#include "clock.h"
#include "servo/words.h"

static const ethd__servo_register *role(const ethd__servo_link *l, int which, double *raw) {
  int32_t r = l->map->roles[which];
  if (r < 0) return NULL;
  *raw = l->raw[r];
  return &l->map->registers[r];
}

/* ---- joints ---- */

static double given_or(double given, double otherwise) { return given > 0 ? given : otherwise; }

ethd_status ethd__servo_feedback_make(ethd__servo_feedback *f, const ethd__servo_map *map, double torque, double period,
                                      ethd_error *error) {
  ethd_status status = ETHD_OK;
  for (int i = 0; i < 2 && !status; i++) {
    int32_t at = map->roles[ETHD__SERVO_POSITION1 + i];
    const ethd__servo_register *r = at < 0 ? NULL : &map->registers[at];
    f->absolute[i] = !r || r->absolute;
    if (!r || !(r->counts > 0) || r->type == ETHD__SERVO_F32) continue;
    double most = fmin(torque, ethd__servo_most(&map->registers[map->roles[ETHD__SERVO_TORQUE1 + i]]));
    f->axes[i].counts = true;
    f->axes[i].def = (ethd__encoder_def){.ceiling = ethd__count_ceiling(r->bits),
                                         .counts_per_turn = (int64_t)r->counts,
                                         .ratio = r->ratio,
                                         .speed_max = r->speed_max,
                                         .freeze_torque = given_or(r->freeze_torque, ETHD__SERVO_FREEZE * most),
                                         .freeze_time = r->freeze_time,
                                         .reverse_torque = given_or(r->reverse_torque, ETHD__SERVO_REVERSE * most),
                                         .reverse_time = r->reverse_time,
                                         .inertia = r->inertia,
                                         .sign = r->reversed ? -1 : 1};
    status = ethd__encoder_check(&f->axes[i].def, period, error);
  }
  return status;
}

static bool is_absolute(const ethd__servo_feedback *f, const ethd__servo_axis *a) { return f->absolute[a - f->axes]; }

/* Returns the angle of a counter, and counts the fault rows that its sample shows. */
static double follow(ethd__servo_feedback *f, ethd__servo_axis *a, double raw) {
  int64_t grave = 0;
  const ethd__count count = {.time_ns = f->sample.stamp_ns, .raw = (uint64_t)(int64_t)raw & a->def.ceiling};
  int64_t seen = ethd__encoder_step(&a->def, &a->encoder, &count, f->homing ? (double)NAN : a->torque, &grave);
  /* two jumps in a row, however far apart a slow bus's samples are, mean that the counter restarted or lost counts */
  bool jumps = (seen & ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_JUMP)) != 0;
  if (jumps && a->jumped) grave |= ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_JUMP);
  if (grave & ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_JUMP)) a->referenced = is_absolute(f, a);
  a->jumped = jumps;
  for (int row = ETHD_FAULT_ENCODER_JUMP; row <= ETHD_FAULT_INDEX; row++) {
    f->rows[row] += (seen & ETHD_FAULT_BIT(row)) != 0;
    f->sample.worst[row] += (grave & ETHD_FAULT_BIT(row)) != 0;
  }
  return a->encoder.q;
}

static void take_axis(ethd__servo_feedback *f, const ethd__servo_link *l, int i) {
  double raw, speed;
  ethd__servo_axis *a = &f->axes[i];
  const ethd__servo_register *r = role(l, ETHD__SERVO_POSITION1 + i, &raw);
  if (!r) return;
  double q = a->counts ? follow(f, a, raw) : ethd__servo_joint(r, raw);
  if (!a->started) {
    a->offset = isnan(f->home[i]) ? 0 : f->home[i] - q;
    a->referenced = is_absolute(f, a) || !isnan(f->home[i]);
  }
  a->started = true;
  f->sample.q[i] = q + a->offset;
  r = role(l, ETHD__SERVO_SPEED1 + i, &speed);
  if (!r)
    f->sample.has &= ~ETHD__SERVO_HAS_SPEED;
  else
    f->sample.dq[i] = ethd__servo_joint(r, speed);
}

/* The value read or written last, in SI at the joint; 0: the map has no such register. */
static double value(const ethd__servo_link *l, int which) {
  double raw;
  const ethd__servo_register *r = role(l, which, &raw);
  return r ? ethd__servo_joint(r, raw) : 0;
}

#define READING_AGE_MAX 10.0 /* s: a reading whose age is greater, negative or NaN is ignored */

static void take_reading(ethd__servo_feedback *f, const ethd__servo_link *l) {
  double count;
  const ethd__servo_register *r = role(l, ETHD__SERVO_READING_COUNT, &count);
  if (!r || (f->sample.readings && count == f->count)) return;
  f->count = count;
  double age = value(l, ETHD__SERVO_READING_AGE);
  if (!(age >= 0 && age <= READING_AGE_MAX)) return;
  f->sample.reading[0] = value(l, ETHD__SERVO_READING_X);
  f->sample.reading[1] = value(l, ETHD__SERVO_READING_Y);
  int64_t last_ns = f->sample.has & ETHD__SERVO_HAS_READING ? f->sample.reading_ns : 0;
  f->sample.reading_ns = ethd__clock_after(last_ns, f->sample.stamp_ns - (int64_t)(1e9 * age));
  f->sample.readings++;
  f->sample.has |= ETHD__SERVO_HAS_READING;
}

/* ---- a drive that doesn't follow ---- */

static void put(int64_t *bits, ethd_fault row, bool on) {
  *bits = on ? *bits | ETHD_FAULT_BIT(row) : *bits & ~ETHD_FAULT_BIT(row);
}

static double scale_at_joint(const ethd__servo_register *r) {
  return fabs((ethd__servo_joint(r, 1) - ethd__servo_joint(r, 0)) / r->scale);
}

/* The measured torque may still follow the set-point before, so a match with either of the two counts. */
static bool follows(ethd__servo_axis *a, const ethd__servo_link *l, int i, double torque) {
  double raw, before = a->torque;
  const ethd__servo_register *r = role(l, ETHD__SERVO_MEASURED1 + i, &raw);
  a->torque = torque;
  if (!r || !(r->tolerance > 0)) return true;
  double measured = ethd__servo_joint(r, raw), most = r->tolerance * scale_at_joint(r);
  return fabs(measured - torque) <= most || fabs(measured - before) <= most;
}

static bool is_measured_now(const ethd__servo_link *l, int i) {
  int32_t r = l->map->roles[ETHD__SERVO_MEASURED1 + i];
  return r < 0 || ethd__servo_plan_fresh(&l->plan, r);
}

/* A slow register keeps its last value between two readings. */
static void compare(ethd__servo_feedback *f, const ethd__servo_link *l, int i) {
  ethd__servo_axis *a = &f->axes[i];
  bool fine = follows(a, l, i, value(l, ETHD__SERVO_TORQUE1 + i)) || l->state != ETHD__SERVO_ENABLED;
  if (!is_measured_now(l, i) && !(fine && l->state != ETHD__SERVO_ENABLED)) return;
  if (fine)
    a->since_ns = 0;
  else if (!a->since_ns)
    a->since_ns = f->sample.stamp_ns;
}

static void watch_torque(ethd__servo_feedback *f, const ethd__servo_link *l) {
  bool lasts = false;
  for (int i = 0; i < 2; i++) {
    compare(f, l, i);
    int64_t since = f->axes[i].since_ns;
    lasts |= since && 1e-9 * (double)(f->sample.stamp_ns - since) >= ETHD__SERVO_FOLLOW;
  }
  put(&f->sample.levels, ETHD_FAULT_NOT_FOLLOWED, lasts);
}

void ethd__servo_feedback_take(ethd__servo_feedback *f, const ethd__servo_link *l, int64_t stamp_ns) {
  bool other_clock = stamp_ns <= f->sample.stamp_ns;
  bool unseen = f->connects != l->counts.connects || other_clock;
  f->sample.stamp_ns = stamp_ns;
  f->sample.number++;
  f->sample.has |= ETHD__SERVO_HAS_SPEED;
  if (other_clock) f->sample.has &= ~ETHD__SERVO_HAS_READING; /* its stamp belongs to the other clock */
  /* the arm may have moved while the line was lost, and a start may use another clock than the run after it */
  for (int i = 0; i < 2 && unseen; i++) ethd__encoder_pause(&f->axes[i].encoder);
  for (int i = 0; i < 2 && f->connects && f->connects != l->counts.connects; i++)
    f->axes[i].referenced &= f->absolute[i]; /* the drive may have lost its power */
  f->connects = l->counts.connects;
  for (int i = 0; i < 2; i++) take_axis(f, l, i);
  take_reading(f, l);
  watch_torque(f, l);
}

void ethd__servo_feedback_place(ethd__servo_feedback *f, int axis, double q) {
  f->axes[axis].offset += q - f->sample.q[axis];
  f->axes[axis].referenced = true;
  f->sample.q[axis] = q;
}

/* ---- rows that hold at present ---- */

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

void ethd__servo_feedback_judge(ethd__servo_feedback *f, const ethd__servo_link *l) {
  ethd__servo_sample *s = &f->sample;
  bool spoilt = l->bucket > ETHD__SERVO_BUCKET_LIMIT;
  put(&s->levels, ETHD_FAULT_LINK_LOST, l->state == ETHD__SERVO_DOWN);
  put(&s->levels, ETHD_FAULT_REPLY_BAD, spoilt);
  put(&s->levels, ETHD_FAULT_SET_POINT, l->set_point_stays);
  put(&s->grave, ETHD_FAULT_REPLY_BAD, spoilt);
  for (int row = 0; row < ETHD_FAULT_COUNT; row++) s->rows[row] = l->rows[row] + f->rows[row];
  if (!l->counts.exchanges) return;
  put(&s->levels, ETHD_FAULT_DRIVE, drive_fault(l));
  put(&s->levels, ETHD_FAULT_BUS_VOLTAGE, voltage_fault(l));
}
