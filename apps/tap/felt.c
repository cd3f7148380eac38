#include "tap/felt.h"

#include <math.h>

static double along(ethd_vec n, const double v[2]) { return n.x * v[0] + n.y * v[1]; }

static size_t ticks(const ethd__rule *rule, double seconds) { return (size_t)floor(seconds / rule->period + 0.5); }

/* The voluntary path's crossing of the touch plane. */
static double path_speed(const ethd__tap_rows *rows, const ethd__rule *rule, size_t begin) {
  for (size_t i = begin + 1; i < rows->count; i++) {
    double here = along(rule->n, rows->truth[i].hand), before = along(rule->n, rows->truth[i - 1].hand);
    if (here >= rule->seen) return (here - before) / (rows->truth[i].t - rows->truth[i - 1].t);
  }
  return NAN;
}

/* A device doesn't measure the hand's voluntary path. The finger's mean speed in the last ETHD_TAP_CARRIED s before the
   touch is used as the hand's speed. */
static double carried_speed(const ethd__tap_rows *rows, const ethd__rule *rule, size_t begin, size_t touch) {
  size_t back = ticks(rule, ETHD_TAP_CARRIED);
  size_t from = touch > begin + back ? touch - back : begin;
  if (touch >= rows->count || touch == from) return NAN;
  double way = along(rule->n, rows->truth[touch].finger) - along(rule->n, rows->truth[from].finger);
  return way / (rows->truth[touch].t - rows->truth[from].t);
}

static double depth(const ethd__tap_rows *rows, const ethd__rule *rule, size_t i) {
  return along(rule->n, rows->truth[i].ring) - rule->meet;
}

/* First tick at which the ring is behind the wall, or stands at it. */
static size_t ready_from(const ethd__tap_rows *rows, const ethd__rule *rule, size_t i) {
  for (; i < rows->count; i++) {
    const ethd_truth *truth = &rows->truth[i];
    double speed = fabs(along(rule->n, rule->side ? truth->motor_v : truth->ring_v)), d = depth(rows, rule, i);
    if (d >= 0 || (d > -ETHD_TAP_NEAR && speed < ETHD_TAP_STILL)) break;
  }
  return i;
}

/* Returns the wall's offset ETHD_TAP_FELT s after the touch. If no wall is rendered at that tick, returns the last
   offset since the touch; NaN: none. */
static double offset_after(const ethd__tap_rows *rows, const ethd__rule *rule, size_t touch) {
  size_t last = touch + ticks(rule, ETHD_TAP_FELT);
  double eps = NAN;
  for (size_t i = touch; i < rows->count && i <= last; i++)
    if (rows->trace[i].state == ETHD_VO) eps = rows->trace[i].eps;
  return eps;
}

ethd__felt ethd__felt_of(const ethd__tap_rows *rows, const ethd__rule *rule, size_t begin, size_t touch) {
  ethd__felt out = {NAN, NAN, NAN, true};
  out.v_hand = rule->carried ? carried_speed(rows, rule, begin, touch) : path_speed(rows, rule, begin);
  if (touch >= rows->count) return out;
  out.depth = depth(rows, rule, touch);
  out.eps = offset_after(rows, rule, touch);
  out.early = touch < ready_from(rows, rule, begin);
  return out;
}
