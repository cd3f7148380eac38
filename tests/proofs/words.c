/* A servo's words: every number packs without an undefined conversion, stays within its register's type, and whole
   numbers in that range come back as they were. */
#include "servo/words.h"

double nondet_double(void);

/* the two functions of libm that packing needs, as CBMC can handle them */
double fmin(double a, double b) { return a < b ? a : b; }
double fmax(double a, double b) { return a > b ? a : b; }
double rint(double v) {
  __CPROVER_assert(v >= -4294967296.0 && v <= 4294967296.0, "what is converted fits");
  return (double)(long long)v; /* toward zero: within one of the nearest */
}

#include "../../drivers/servo/words.c"

int main(void) {
  ethd__servo_register r;
  uint16_t words[2];
  double raw = nondet_double(), min, max;
  __CPROVER_assume(r.type >= ETHD__SERVO_U16 && r.type <= ETHD__SERVO_I32);
  __CPROVER_assume(r.order == ETHD__SERVO_LOW_FIRST || r.order == ETHD__SERVO_HIGH_FIRST);
  ethd__servo_range(&r, &min, &max);
  ethd__servo_pack(&r, raw, words);
  double back = ethd__servo_unpack(&r, words);
  __CPROVER_assert(back >= min && back <= max, "within the register's type");
  if (raw >= min && raw <= max && raw == (double)(long long)raw)
    __CPROVER_assert(back == raw, "a whole number comes back");
  if (raw > max) __CPROVER_assert(back == max, "what is more becomes the most");
  if (raw < min) __CPROVER_assert(back == min, "what is less becomes the least");
  if (raw != raw) __CPROVER_assert(back == 0, "what is no number becomes 0");
  return 0;
}
