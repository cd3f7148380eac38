#include "arm/servo.h"

#include <math.h>
#include <string.h>

/* y'' + 2 z w y' + w^2 y = 0 with z <= 1: y is a wave of w sqrt(1 - z^2) that decays by exp(-z w t). */
static ethd__arm_ahead ahead(const ethd__arm_table *table, double h) {
  const double w = table->servo.frequency, z = table->servo.damping, turn = w * sqrt((1 - z) * (1 + z));
  const double decay = ethd_exp(-z * w * h);
  const double cosine = decay * ethd_cos(turn * h), sine = decay * (turn * h > 0 ? ethd_sin(turn * h) / turn : h);
  return (ethd__arm_ahead){h, cosine + z * w * sine, sine, -w * w * sine, cosine - z * w * sine};
}

void ethd__arm_servo_start(const ethd__arm_table *table, const double *q, ethd__arm_servo *out) {
  const double T = table->limits.period;
  memset(out, 0, sizeof *out);
  out->table = table;
  out->whole = (uint32_t)floor(table->servo.delay / T * (1 + 1e-12));
  const double late = fmax(0, table->servo.delay - out->whole * T);
  out->late = ahead(table, late);
  out->rest = ahead(table, T - late);
  for (uint32_t i = 0; i < table->limits.count; i++) out->joint[i].q = q[i];
}

static void pass(const ethd__arm_table *table, const ethd__arm_ahead *to, double u, ethd__arm_joint *j) {
  const double w = table->servo.frequency, y = j->v - u, a = j->a;
  const double y1 = to->yy * y + to->ya * a, a1 = to->ay * y + to->aa * a;
  /* the equation's integral: a1 - a + 2 z w (y1 - y) + w^2 (motion - u h) = 0 */
  j->q += u * to->h - (a1 - a + 2 * table->servo.damping * w * (y1 - y)) / (w * w);
  j->v = u + y1;
  j->a = a1;
}

static const double *held_since(const ethd__arm_servo *s, uint64_t periods) {
  return s->held[(s->period - periods) % ETHD__ARM_HELD];
}

void ethd__arm_servo_step(ethd__arm_servo *s, const double *u) {
  memcpy(s->held[s->period % ETHD__ARM_HELD], u, s->table->limits.count * sizeof *u);
  const double *before = held_since(s, s->whole + 1), *now = held_since(s, s->whole);
  for (uint32_t i = 0; i < s->table->limits.count; i++) {
    pass(s->table, &s->late, before[i], &s->joint[i]);
    pass(s->table, &s->rest, now[i], &s->joint[i]);
  }
  s->period++;
}

void ethd__arm_servo_brake(ethd__arm_servo *s) {
  memset(s->held, 0, sizeof s->held);
  for (uint32_t i = 0; i < s->table->limits.count; i++) s->joint[i].v = s->joint[i].a = 0;
}
