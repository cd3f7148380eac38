#include "tap/metrics.h"

#include <math.h>

#include "tap/felt.h"

const char *const ethd__reason_words[ETHD_TAP_REASON_COUNT] = {
#define ETHD_TAP_WORD(name, word) word,
    ETHD_TAP_REASONS(ETHD_TAP_WORD)
#undef ETHD_TAP_WORD
};

static double along(ethd_vec n, const double v[2]) { return n.x * v[0] + n.y * v[1]; }

static double speed_at(const ethd__tap_rows *rows, const ethd__rule *rule, size_t i) {
  const ethd_truth *truth = &rows->truth[i];
  return along(rule->n, rule->side ? truth->motor_v : truth->ring_v);
}

static bool clear(const ethd__rule *rule, const ethd_trace *trace, const ethd_truth *truth) {
  bool ring = isnan(trace->d_re) || trace->d_re > rule->d_beta;
  return ring && along(rule->n, truth->hand) < rule->meet - rule->d_beta;
}

bool ethd__approach_step(ethd__approach *approach, const ethd__rule *rule, const ethd_trace *trace,
                         const ethd_truth *truth) {
  size_t tick = approach->count++;
  bool inside = trace->d_re < 0;
  if (!approach->begun && ((tick == 0 && !inside) || clear(rule, trace, truth))) {
    approach->begun = true;
    approach->begin = tick;
  }
  if (!approach->begun || approach->met || !inside) return false;
  return approach->met = true;
}

static size_t approach_of(const ethd__tap_rows *rows, const ethd__rule *rule, size_t *begin) {
  ethd__approach approach = {0};
  size_t i = 0;
  while (i < rows->count && !ethd__approach_step(&approach, rule, &rows->trace[i], &rows->truth[i])) i++;
  *begin = approach.begun ? approach.begin : rows->count;
  return i;
}

size_t ethd__metrics_meeting(const ethd__tap_rows *rows, const ethd__rule *rule) {
  size_t begin;
  return approach_of(rows, rule, &begin);
}

static size_t touch_from(const ethd__tap_rows *rows, size_t i) {
  while (i < rows->count && !(rows->truth[i].pad > 0)) i++;
  return i;
}

/* Each extremum counts once the ring has moved back by the hysteresis. */
static double rebound(const ethd__tap_rows *rows, ethd_vec n, int32_t side, size_t from) {
  double peak = -INFINITY, valley = NAN;
  bool turned = false;
  for (size_t i = from; i < rows->count; i++) {
    double s = along(n, side ? rows->truth[i].motor : rows->truth[i].ring);
    if (!turned && s > peak) peak = s;
    if (!turned && s < peak - ETHD_TAP_HYSTERESIS) turned = true, valley = s;
    if (turned && s < valley) valley = s;
    if (turned && s > valley + ETHD_TAP_HYSTERESIS) break;
  }
  return turned ? peak - valley : 0;
}

static double touch_speed(const ethd__tap_rows *rows, const ethd__rule *rule, size_t touch) {
  double after = speed_at(rows, rule, touch);
  if (touch == 0 || !(rows->truth[touch - 1].pad <= 0)) return after;
  double off = -rows->truth[touch - 1].pad, before = speed_at(rows, rule, touch - 1);
  return before + off / (off + rows->truth[touch].pad) * (after - before);
}

static double slowest(const ethd__tap_rows *rows, const ethd__rule *rule, size_t from) {
  double least = INFINITY;
  size_t end = from + (size_t)floor(ETHD_TAP_REBOUND / rule->period + 0.5);
  for (size_t i = from + 1; i < rows->count && i <= end; i++) least = fmin(least, speed_at(rows, rule, i));
  return isinf(least) ? (double)NAN : least;
}

/* Periods from row to row, including those that a live loop missed. */
static size_t periods(const ethd__tap_rows *rows, size_t from, size_t to) {
  size_t n = to - from;
  for (size_t i = from + 1; i <= to; i++) n += (size_t)rows->trace[i].sense.missed;
  return n;
}

/* Delta_s and eps, for laws that brake. A law that has braked before the wall has no time of braking after it. */
static void braking(const ethd__tap_rows *rows, const ethd__rule *rule, size_t from, ethd__metrics *out) {
  size_t i = from;
  while (i < rows->count && rows->trace[i].state != ETHD_BRAKING) i++;
  size_t begin = i;
  while (i < rows->count && rows->trace[i].state != ETHD_VO) i++;
  if (i >= rows->count) return;
  bool before = from > 0 && rows->trace[from - 1].state == ETHD_BRAKING;
  if (!before) out->delta_s = (double)periods(rows, begin, i) * (1e3 * rule->period);
  out->eps = rows->trace[i].eps;
}

/* The pad's front is at the visible wall. */
static size_t sight_from(const ethd__tap_rows *rows, const ethd__rule *rule, size_t i) {
  while (i < rows->count && !(along(rule->n, rows->truth[i].finger) >= rule->seen)) i++;
  return i;
}

static double pressing(const ethd__tap_rows *rows, const ethd__rule *rule, size_t touch) {
  size_t ticks = 0;
  for (size_t i = touch; i < rows->count; i++) ticks += rows->truth[i].pad > 0;
  return (double)ticks * rule->period;
}

static bool comes_back(const ethd__tap_rows *rows, const ethd__rule *rule, size_t touch) {
  size_t i = sight_from(rows, rule, touch);
  while (i < rows->count && along(rule->n, rows->truth[i].finger) > rule->seen - rule->lift) i++;
  return sight_from(rows, rule, i) < rows->count;
}

static double strongest(const ethd__tap_rows *rows) {
  double force = 0;
  for (size_t i = 0; i < rows->count; i++) {
    const double *f = rows->trace[i].fe;
    force = fmax(force, sqrt(f[0] * f[0] + f[1] * f[1]));
  }
  return force;
}

static ethd_fault first_fault(const ethd__tap_rows *rows) {
  for (size_t i = 0; i < rows->count; i++)
    if (rows->trace[i].fault) return (ethd_fault)rows->trace[i].fault;
  return ETHD_FAULT_NONE;
}

/* Conditions on a touch that is in time. */
static ethd__reason judge_touch(const ethd__tap_rows *rows, const ethd__rule *rule, size_t touch) {
  if (touch == rows->count) return ETHD_TAP_NO_CONTACT;
  if (pressing(rows, rule, touch) < rule->graze) return ETHD_TAP_GRAZING;
  return rule->single && comes_back(rows, rule, touch) ? ETHD_TAP_DOUBLE : ETHD_TAP_OK;
}

static ethd__reason judge_speed(const ethd__rule *rule, double speed) {
  if (!(speed >= rule->speed - rule->band)) return ETHD_TAP_TOO_SLOW;
  return speed <= rule->speed + rule->band ? ETHD_TAP_OK : ETHD_TAP_TOO_FAST;
}

/* first: the pad's first touch of the tap, before or after the meeting. */
static ethd__reason judge_by_paper(const ethd__tap_rows *rows, const ethd__rule *rule, size_t first, size_t meeting,
                                   double v_rvo) {
  if (meeting == rows->count) return ETHD_TAP_NO_CONTACT;
  if (first < meeting) return ETHD_TAP_EARLY_CONTACT;
  ethd__reason reason = judge_speed(rule, v_rvo);
  return reason ? reason : judge_touch(rows, rule, touch_from(rows, meeting));
}

static ethd__reason judge_by_finger(const ethd__tap_rows *rows, const ethd__rule *rule, size_t touch,
                                    const ethd__felt *felt) {
  ethd__reason reason = isnan(felt->v_hand) ? ETHD_TAP_NO_CONTACT : judge_speed(rule, felt->v_hand);
  if (!reason && touch < rows->count && felt->early) reason = ETHD_TAP_EARLY_CONTACT;
  return reason ? reason : judge_touch(rows, rule, touch);
}

static void measure_meeting(const ethd__tap_rows *rows, const ethd__rule *rule, size_t meeting, ethd__metrics *out) {
  if (meeting == rows->count) return;
  out->v_rvo = speed_at(rows, rule, meeting);
  out->t_rvo = rows->truth[meeting].t;
  out->d_max = rebound(rows, rule->n, rule->side, meeting);
  out->d_max_ring = rebound(rows, rule->n, 0, meeting);
  braking(rows, rule, meeting, out);
}

static void measure_touch(const ethd__tap_rows *rows, const ethd__rule *rule, size_t touch, ethd__metrics *out) {
  if (touch == rows->count) return;
  out->v_of = touch_speed(rows, rule, touch);
  out->v_of_tick = speed_at(rows, rule, touch);
  out->t_of = rows->truth[touch].t;
  out->v_rmin = slowest(rows, rule, touch);
}

void ethd__metrics_of(const ethd__tap_rows *rows, const ethd__rule *rule, ethd__metrics *out) {
  size_t begin, meeting = approach_of(rows, rule, &begin), first = touch_from(rows, begin);
  bool by_finger = rule->validity == ETHD_TAP_BY_FINGER;
  size_t touch = by_finger ? first : touch_from(rows, meeting), sight = sight_from(rows, rule, begin);
  const ethd__felt felt = ethd__felt_of(rows, rule, begin, first);
  *out = (ethd__metrics){.v_rvo = NAN,
                         .v_of = NAN,
                         .v_of_tick = NAN,
                         .d_max = NAN,
                         .d_max_ring = NAN,
                         .v_rmin = NAN,
                         .delta_s = NAN,
                         .eps = NAN,
                         .t_rvo = NAN,
                         .t_of = NAN,
                         .t_seen = NAN,
                         .v_hand = felt.v_hand,
                         .touch_depth = felt.depth,
                         .eps_felt = felt.eps,
                         .peak_force = strongest(rows),
                         .fault = first_fault(rows)};
  measure_meeting(rows, rule, meeting, out);
  measure_touch(rows, rule, touch, out);
  if (sight < rows->count) out->t_seen = rows->truth[sight].t;
  ethd__reason whatever = out->fault ? ETHD_TAP_FAULT : rule->never_fast ? ETHD_TAP_TOO_SLOW : ETHD_TAP_OK;
  out->by_ring = whatever ? whatever : judge_by_paper(rows, rule, first, meeting, out->v_rvo);
  out->by_finger = whatever ? whatever : judge_by_finger(rows, rule, first, &felt);
  out->reason = by_finger ? out->by_finger : out->by_ring;
}
