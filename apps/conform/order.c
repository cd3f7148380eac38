#include "conform/order.h"

#include <math.h>
#include <stdio.h>

#include "servo/words.h"

#define TURN 6.283185307179586 /* rad: no joint stands further from its zero */
#define STEP 1.0               /* rad: no joint moves so far between two readings */

static const char *const names[] = {"high-first", "low-first"};

/* A counter's numbers are those around zero, whatever its type. */
static double fold(const ethd__servo_register *r, double counts) {
  double span = ldexp(1, (int)r->bits);
  return r->counts > 0 ? counts - span * rint(counts / span) : counts;
}

static double angle(const ethd__servo_register *r, int32_t order, const uint16_t *words) {
  ethd__servo_register read = *r;
  read.order = order;
  return ethd__servo_joint(r, fold(r, ethd__servo_unpack(&read, words)));
}

static double change(const ethd__servo_register *r, double from, double to) {
  double count = ethd__servo_joint(r, 1) - ethd__servo_joint(r, 0);
  return count * fold(r, (to - from) / count);
}

void ethd__position_see(const ethd__servo_register *r, const uint16_t *words, ethd__position_seen *seen) {
  for (int32_t order = 0; order < 2; order++) {
    double q = angle(r, order, words);
    double step = seen->begun ? change(r, seen->angle[order], q) : 0;
    seen->step[order] = fmax(seen->step[order], fabs(step));
    seen->moved[order] += step;
    seen->angle[order] = q;
  }
  seen->begun = true;
}

static bool is_plausible(const ethd__position_seen *seen, int32_t order) {
  return fabs(seen->angle[order]) <= TURN && seen->step[order] <= STEP;
}

int32_t ethd__position_order(const ethd__servo_register *r, const ethd__position_seen *seen) {
  bool high = is_plausible(seen, ETHD__SERVO_HIGH_FIRST), low = is_plausible(seen, ETHD__SERVO_LOW_FIRST);
  if (ethd__servo_words(r) < 2 || high == low) return ETHD__SERVO_NO_ORDER;
  return high ? ETHD__SERVO_HIGH_FIRST : ETHD__SERVO_LOW_FIRST;
}

static void report_orders(const ethd__servo_register *r, const ethd__position_seen *seen) {
  int32_t order = ethd__position_order(r, seen);
  printf("%-10s %s high-first: %.6g rad, low-first: %.6g rad: ", "order", r->name, seen->angle[ETHD__SERVO_HIGH_FIRST],
         seen->angle[ETHD__SERVO_LOW_FIRST]);
  if (order != ETHD__SERVO_NO_ORDER)
    printf("%s is plausible; the map says %s\n", names[order], names[r->order]);
  else if (is_plausible(seen, r->order))
    printf("both are possible: turn the joint (--by-hand)\n");
  else
    printf("both are absurd: check address, type, counts and ratio\n");
  if (order != ETHD__SERVO_NO_ORDER && order != r->order)
    printf("%-10s order = %s is needed for %s, the map says %s\n", "mend", names[order], r->name, names[r->order]);
}

void ethd__position_report(const ethd__servo_register *r, const ethd__position_seen *seen) {
  if (!seen->begun) return;
  if (ethd__servo_words(r) == 2)
    report_orders(r, seen);
  else if (!is_plausible(seen, ETHD__SERVO_HIGH_FIRST))
    printf("%-10s %s: %.6g rad is absurd: check address, type, counts and ratio\n", "doubt", r->name, seen->angle[0]);
}
