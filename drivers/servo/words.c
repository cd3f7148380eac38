#include "servo/words.h"

#include <math.h>
#include <string.h>

#define TURN 6.283185307179586

enum { NM = 1, A, COUNT, TURNS, COUNT_S = 6, RPM };
const char ethd__servo_units[] = "1|Nm|A|count|turn|rad|count/s|rpm|rad/s|V|m|s";

/* ---- words ---- */

static bool is_wide(const ethd__servo_register *r) { return r->type >= ETHD__SERVO_U32; }

uint32_t ethd__servo_words(const ethd__servo_register *r) { return is_wide(r) ? 2 : 1; }

ethd__servo_span ethd__servo_span_of(const ethd__servo_register *r) {
  return (ethd__servo_span){r->bus_unit, r->space, r->address, ethd__servo_words(r)};
}

uint32_t ethd__servo_bits(const ethd__servo_register *r, const uint16_t *w) {
  if (!is_wide(r)) return w[0];
  return r->order == ETHD__SERVO_LOW_FIRST ? (uint32_t)w[1] << 16 | w[0] : (uint32_t)w[0] << 16 | w[1];
}

static void put_bits(const ethd__servo_register *r, uint32_t bits, uint16_t *out) {
  int low = !is_wide(r) || r->order == ETHD__SERVO_LOW_FIRST ? 0 : 1;
  out[low] = (uint16_t)bits;
  if (is_wide(r)) out[!low] = (uint16_t)(bits >> 16);
}

void ethd__servo_range(const ethd__servo_register *r, double *min, double *max) {
  static const double least[] = {0, -32768, 0, -2147483648.0, -0x1.fffffep127};
  static const double most[] = {65535, 32767, 4294967295.0, 2147483647, 0x1.fffffep127};
  *min = least[r->type];
  *max = most[r->type];
}

void ethd__servo_pack(const ethd__servo_register *r, double raw, uint16_t *out) {
  double min, max;
  uint32_t bits;
  ethd__servo_range(r, &min, &max);
  raw = raw == raw ? fmin(fmax(raw, min), max) : 0;
  if (r->type == ETHD__SERVO_F32) {
    float f = (float)raw;
    memcpy(&bits, &f, sizeof bits);
  } else {
    bits = (uint32_t)(int64_t)rint(raw);
  }
  put_bits(r, bits, out);
}

double ethd__servo_unpack(const ethd__servo_register *r, const uint16_t *words) {
  uint32_t bits = ethd__servo_bits(r, words);
  float f;
  switch (r->type) {
  case ETHD__SERVO_I16: return (int16_t)bits;
  case ETHD__SERVO_I32: return (int32_t)bits;
  case ETHD__SERVO_F32: memcpy(&f, &bits, sizeof f); return (double)f;
  default: return bits;
  }
}

/* ---- units ---- */

double ethd__servo_factor(const ethd__servo_register *r) {
  switch (r->unit) {
  case A: return r->torque_constant;
  case COUNT:
  case COUNT_S: return TURN / r->counts;
  case TURNS: return TURN;
  case RPM: return TURN / 60;
  default: return 1;
  }
}

/* The factor from the motor to the joint: the ratio multiplies torques and divides everything else. */
static double at_joint(const ethd__servo_register *r) {
  double ratio = r->unit == NM || r->unit == A ? r->ratio : 1 / r->ratio;
  return (r->reversed ? -ratio : ratio) * ethd__servo_factor(r);
}

static double nearest(const ethd__servo_register *r, double raw) {
  return r->type == ETHD__SERVO_F32 ? (double)(float)raw : rint(raw);
}

static double next_towards(const ethd__servo_register *r, double raw, double to) {
  if (r->type == ETHD__SERVO_F32) return (double)nextafterf((float)raw, (float)to);
  return raw + (to > raw ? 1 : -1);
}

/* Rounding to the nearest keeps a torque that the words hold exactly; one that grew by it goes a step towards zero. */
double ethd__servo_raw(const ethd__servo_register *r, double joint) {
  double asked = joint == joint ? joint / at_joint(r) : 0, zero = nearest(r, -r->offset / r->scale);
  double value = fmin(fmax(asked, r->min), r->max);
  double most = value == asked ? fabs(joint) : fabs(at_joint(r) * value);
  double raw = value == 0 ? zero : nearest(r, (value - r->offset) / r->scale);
  while (raw != zero && fabs(ethd__servo_joint(r, raw)) > most) raw = next_towards(r, raw, zero);
  return raw;
}

double ethd__servo_joint(const ethd__servo_register *r, double raw) {
  return at_joint(r) * (r->scale * raw + r->offset);
}

double ethd__servo_least(const ethd__servo_register *r) {
  return r->type == ETHD__SERVO_F32 ? 0 : fabs(at_joint(r) * r->scale);
}

double ethd__servo_most(const ethd__servo_register *r) { return fabs(at_joint(r)) * fmin(r->max, -r->min); }
