#include "tap/paper.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "tap/summary.h"

#define FEWEST 6       /* valid taps of a statistic, at least */
#define TURN 0.3e-3    /* m: smallest reversal of an oscillation, */
#define TURN_END 0.1   /* s after t_r/vo */
#define BEYOND 1e-3    /* m: largest distance of the ring behind x_eps, */
#define HELD 0.06      /* s after vo */
#define TIME_MAX 20    /* ms, of Delta_s */
#define DEPTH_MAX 3e-3 /* m, of eps */

static const struct {
  const char *group;
  double low, high;
  const char *unit, *brief;
} lines[ETHD_PAPER_COUNT] = {
#define ROW(name, group, ...) {#group, __VA_ARGS__},
    ETHD_PAPER_LINES(ROW)
#undef ROW
};

/* ---- taps ---- */

/* Figures of a tap in addition to metrics.h. */
typedef struct watched {
  double turns; /* of the measured side */
  bool held;    /* the ring never passed x_eps + BEYOND */
} watched;

typedef struct taps {
  ethd__cell cell;
  watched *watched;
} taps;

static double along(ethd_vec n, const double x[2]) { return n.x * x[0] + n.y * x[1]; }

static double turns_of(const ethd__tap_rows *rows, const ethd__rule *rule, size_t from) {
  size_t end = from + (size_t)(TURN_END / rule->period + 0.5);
  double most = -INFINITY, sign = 1, turns = 0;
  for (size_t i = from; i < rows->count && i <= end; i++) {
    const ethd_truth *t = &rows->truth[i];
    double s = sign * along(rule->n, rule->side ? t->motor : t->ring);
    most = fmax(most, s);
    if (s < most - TURN) sign = -sign, most = -s, turns++;
  }
  return turns;
}

static bool holds(const ethd__tap_rows *rows, const ethd__rule *rule, size_t from) {
  while (from < rows->count && rows->trace[from].state != ETHD_VO) from++;
  if (from == rows->count) return false;
  size_t end = from + (size_t)(HELD / rule->period + 0.5);
  double most = rule->meet + rows->trace[from].eps + BEYOND;
  for (size_t i = from; i < rows->count && i <= end; i++)
    if (along(rule->n, rows->truth[i].ring) > most) return false;
  return true;
}

static watched see(const ethd__stage *stage, const ethd__result *result, const ethd__speed *speed) {
  const ethd__rule rule = ethd__stage_rule(stage, speed, result->finger_radius);
  size_t from = ethd__metrics_meeting(&stage->rows, &rule);
  return (watched){turns_of(&stage->rows, &rule, from), holds(&stage->rows, &rule, from)};
}

static ethd_status run_taps(const ethd__study *study, const char *law, int speed, uint64_t count, taps *out,
                            char *message) {
  ethd__stage stage;
  *out = (taps){{.law = law, .speed = &study->speeds[speed]}, calloc(count, sizeof(watched))};
  out->cell.results = calloc(count, sizeof(ethd__result));
  if (!out->cell.results || !out->watched) ethd__fail_memory();
  ethd_status status = ethd__stage_open(study, law, &stage, message);
  if (status) return status;
  for (uint64_t tap = 0; !status && tap < count && !ethd__stop; tap++) {
    ethd__result *result = &out->cell.results[tap];
    status = ethd__stage_run(&stage, out->cell.speed, tap, result, message);
    out->watched[tap] = see(&stage, result, out->cell.speed);
    out->cell.count += !status;
  }
  ethd__stage_close(&stage);
  return status;
}

/* ---- figures; NaN where too few taps have one ---- */

static double at_least(const ethd__cell *cell, double value) {
  return ethd__cell_valid(cell) < FEWEST ? (double)NAN : value;
}

static void take_table(const ethd__cell *cell, double out[4]) {
  ethd__figure time = ethd__cell_figure(cell, ETHD_TAP_FIELD(delta_s));
  ethd__figure depth = ethd__cell_figure(cell, ETHD_TAP_FIELD(eps));
  const double values[] = {time.mean, time.sd, 1e3 * depth.mean, 1e3 * depth.sd};
  for (int i = 0; i < 4; i++) out[i] = at_least(cell, values[i]);
}

static int by_commanded(const void *a, const void *b) {
  double x = ((const ethd__result *)a)->commanded, y = ((const ethd__result *)b)->commanded;
  return (x > y) - (x < y);
}

/* Returns the commanded speed above which taps are early: the one that misjudges the fewest taps. NaN unless some taps
   are early and some are not. */
static double early_from(const ethd__cell *cell) {
  ethd__result *r = malloc(cell->count * sizeof *r);
  size_t early = 0, n = cell->count;
  double best = NAN;
  if (!r) ethd__fail_memory();
  memcpy(r, cell->results, n * sizeof *r);
  qsort(r, n, sizeof *r, by_commanded);
  for (size_t i = 0; i < n; i++) early += r[i].metrics.reason == ETHD_TAP_EARLY_CONTACT;
  double mistakes = (double)(n - early), fewest = mistakes;
  for (size_t i = 0; i < n && early && early < n; i++) {
    mistakes += r[i].metrics.reason == ETHD_TAP_EARLY_CONTACT ? 1 : -1;
    if (mistakes < fewest) fewest = mistakes, best = r[i].commanded;
  }
  free(r);
  return best;
}

static double difference(const ethd__cell *offset, const ethd__cell *smooth, size_t field) {
  return at_least(offset, at_least(smooth, ethd__cell_median(offset, field) - ethd__cell_median(smooth, field)));
}

/* Returns the mean size of a figure over the cell's valid taps. */
static double size_of(const ethd__cell *cell, size_t field) {
  double sum = 0, n = 0;
  for (size_t i = 0; i < cell->count; i++) {
    const ethd__metrics *m = &cell->results[i].metrics;
    double value = fabs(*(const double *)((const char *)m + field));
    if (m->reason == ETHD_TAP_OK && !isnan(value)) sum += value, n++;
  }
  return at_least(cell, sum / n);
}

static double times(const ethd__cell *a, const ethd__cell *b, size_t field) {
  return size_of(a, field) / fmax(1e-9, size_of(b, field));
}

/* Means over the valid taps. */
static double turns_mean(const taps *t) {
  double sum = 0;
  for (size_t i = 0; i < t->cell.count; i++)
    if (t->cell.results[i].metrics.reason == ETHD_TAP_OK) sum += t->watched[i].turns;
  return at_least(&t->cell, sum / (double)ethd__cell_valid(&t->cell));
}

static double held_share(const taps *t) {
  double sum = 0;
  for (size_t i = 0; i < t->cell.count; i++)
    sum += t->cell.results[i].metrics.reason == ETHD_TAP_OK && t->watched[i].held;
  return at_least(&t->cell, sum / (double)ethd__cell_valid(&t->cell));
}

static double vo_first_share(const ethd__cell *cell, double period) {
  double sum = 0;
  for (size_t i = 0; i < cell->count; i++) {
    const ethd__metrics *m = &cell->results[i].metrics;
    sum += m->reason == ETHD_TAP_OK && m->t_rvo + 1e-3 * m->delta_s < m->t_of - period / 2;
  }
  return at_least(cell, sum / (double)ethd__cell_valid(cell));
}

static double attempts(const ethd__cell *a, const ethd__cell *b) {
  return 3 * (double)(a->count + b->count) / (double)(ethd__cell_valid(a) + ethd__cell_valid(b));
}

/* ---- lines ---- */

static void take_low(const ethd__cell *offset, const ethd__cell *smooth, double *out) {
  take_table(offset, &out[ETHD_PAPER_ds_low]);
  out[ETHD_PAPER_alike_d_max] = 1e3 * difference(offset, smooth, ETHD_TAP_FIELD(d_max));
  out[ETHD_PAPER_alike_v_of] = difference(offset, smooth, ETHD_TAP_FIELD(v_of));
  out[ETHD_PAPER_alike_v_rmin] = difference(offset, smooth, ETHD_TAP_FIELD(v_rmin));
  out[ETHD_PAPER_smooth_low] = size_of(smooth, ETHD_TAP_FIELD(v_of));
  out[ETHD_PAPER_attempts_low] = attempts(offset, smooth);
  out[ETHD_PAPER_slightly] = times(smooth, offset, ETHD_TAP_FIELD(v_rmin));
}

static void take_high(const taps *offset, const taps *smooth, double period, double *out) {
  const ethd__cell *o = &offset->cell, *s = &smooth->cell;
  take_table(o, &out[ETHD_PAPER_ds_high]);
  out[ETHD_PAPER_times_d_max] = times(s, o, ETHD_TAP_FIELD(d_max));
  out[ETHD_PAPER_times_v_rmin] = times(s, o, ETHD_TAP_FIELD(v_rmin));
  out[ETHD_PAPER_times_v_of] = times(s, o, ETHD_TAP_FIELD(v_of));
  out[ETHD_PAPER_with_finger] = at_least(o, ethd__cell_share(o, ETHD_TAP_FIELD(v_of), 1e-300, INFINITY));
  out[ETHD_PAPER_early] = early_from(o);
  out[ETHD_PAPER_under_20] = at_least(o, ethd__cell_share(o, ETHD_TAP_FIELD(delta_s), 0, TIME_MAX));
  out[ETHD_PAPER_under_3] = at_least(o, ethd__cell_share(o, ETHD_TAP_FIELD(eps), -INFINITY, DEPTH_MAX));
  out[ETHD_PAPER_vo_first] = vo_first_share(o, period);
  out[ETHD_PAPER_holds] = held_share(offset);
  out[ETHD_PAPER_smooth_ratio] = out[ETHD_PAPER_smooth_low] / size_of(s, ETHD_TAP_FIELD(v_of));
  out[ETHD_PAPER_turns] = turns_mean(smooth);
  out[ETHD_PAPER_turns_ratio] = turns_mean(offset) / turns_mean(smooth);
  out[ETHD_PAPER_attempts_high] = attempts(o, s);
}

static ethd_status take_taps(const ethd__study *study, uint64_t count, double *out, char *message) {
  static const char *const laws[] = {"offset", "smooth"};
  taps cells[2][2] = {0}; /* of a law, of a speed */
  ethd_status status = ETHD_OK;
  for (int i = 0; !status && i < 4; i++)
    status = run_taps(study, laws[i % 2], i / 2, i / 2 ? 2 * count : count, &cells[i % 2][i / 2], message);
  if (!status && !ethd__stop) {
    take_low(&cells[0][0].cell, &cells[1][0].cell, out);
    take_high(&cells[0][1], &cells[1][1], study->config->setup.period, out);
  }
  for (int i = 0; i < 4; i++) {
    free(cells[i % 2][i / 2].cell.results);
    free(cells[i % 2][i / 2].watched);
  }
  return status;
}

static void print(const double *value) {
  int missed = 0;
  printf("%-6s %-56s %9s  %s\n", "group", "line", "is", "must be");
  for (int i = 0; i < ETHD_PAPER_COUNT; i++) {
    bool met = value[i] >= lines[i].low && value[i] <= lines[i].high;
    char bounds[64];
    snprintf(bounds, sizeof bounds, isfinite(lines[i].high) ? "%.4g to %.4g" : "at least %.4g", lines[i].low,
             lines[i].high);
    printf("%-6s %-56s %9.4g  %-17s %-4s%s\n", lines[i].group, lines[i].brief, value[i], bounds, lines[i].unit,
           met ? "" : " MISSED");
    missed += !met;
  }
  printf("%d of %d lines missed\n", missed, ETHD_PAPER_COUNT);
}

ethd_status ethd__paper_print(const ethd__study *study, uint64_t count, char message[ETHD_MESSAGE_MAX]) {
  double value[ETHD_PAPER_COUNT];
  ethd_status status = take_taps(study, count, value, message);
  if (!status && !ethd__stop) status = ethd__paper_limits(study, value, message);
  if (status || ethd__stop) return status;
  printf("%llu taps of smooth and of offset at low speed, %llu at high speed\n", (unsigned long long)count,
         2 * (unsigned long long)count);
  print(value);
  return ETHD_OK;
}
