#include "explain/judge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "tap/summary.h"
#include "text/csv.h"

#define FEWEST 6   /* valid taps that make a statistic */
#define MISSED 4.0 /* the largest miss of a line, and that of a line without a value */
#define INNER 0.1  /* the share of a line's range by which the inner bounds are narrower on either side */

typedef enum line_kind { MEAN, RATIO } line_kind; /* a miss is a difference, or a difference of logarithms */

static const struct {
  ethd__explain_group group;
  double low, high;
  line_kind kind;
  const char *unit, *brief;
} lines[ETHD_EXPLAIN_LINE_COUNT] = {
#define ROW(name, group, low, high, kind, unit, brief) {ETHD_EXPLAIN_##group, low, high, kind, unit, brief},
    ETHD_EXPLAIN_LINES(ROW)
#undef ROW
};

const char *const ethd__explain_group_names[ETHD_EXPLAIN_GROUPS] = {"table", "claims", "limits"};

/* ---- misses ---- */

static double outside(double value, double low, double high, double unit) {
  return value < low ? (low - value) / unit : value > high ? (value - high) / unit : 0;
}

double ethd__explain_miss(int line, double value, bool inner) {
  double low = lines[line].low, high = lines[line].high, share = inner ? INNER : 0;
  if (isnan(value)) return MISSED;
  if (lines[line].kind == MEAN) {
    double half = (high - low) / 2;
    return fmin(MISSED, outside(value, low + share * half, high - share * half, half));
  }
  return fmin(MISSED, outside(log(fmax(value, 1e-3)), log(low) + share / 2, log(high) - share / 2, log(2)));
}

static double total_of(const ethd__explain_question *question, const ethd__explain_figures *figures) {
  double total = 0;
  for (int i = 0; i < ETHD_EXPLAIN_LINE_COUNT; i++)
    if (question->asked[lines[i].group] && figures->known[i]) total += ethd__explain_miss(i, figures->value[i], true);
  return total;
}

double ethd__explain_place(int line, double value) {
  double low = lines[line].low, high = lines[line].high;
  if (lines[line].kind == MEAN) return (value - low) / (high - low);
  if (isfinite(high)) return log(fmax(value, 1e-3) / low) / log(high / low);
  return value < low ? log(fmax(value, 1e-3) / low) / log(2) : 1 - low / value;
}

ethd_status ethd__explain_csv(const char *path, const char *const *names, const ethd__explain_figures *figures,
                              size_t count, char message[ETHD_MESSAGE_MAX]) {
  ethd_csv_out *csv = ethd_csv_create(path, "plant,line,group,unit,low,high,value,place,met,what", message);
  if (!csv) return ETHD_E_FILE;
  for (size_t n = 0; n < count; n++)
    for (int i = 0; i < ETHD_EXPLAIN_LINE_COUNT; i++) {
      const double value = figures[n].value[i];
      char what[80];
      ethd_csv_text(csv, names[n]);
      ethd_csv_integer(csv, i + 1);
      ethd_csv_word(csv, ethd__explain_group_names[lines[i].group]);
      ethd_csv_word(csv, lines[i].unit);
      ethd_csv_number(csv, lines[i].low);
      ethd_csv_number(csv, isfinite(lines[i].high) ? lines[i].high : (double)NAN);
      ethd_csv_number(csv, value);
      ethd_csv_number(csv, isnan(value) ? value : ethd__explain_place(i, value));
      ethd_csv_integer(csv, !(ethd__explain_miss(i, value, false) > 0));
      snprintf(what, sizeof what, strcmp(lines[i].unit, "1") ? "%s, %s" : "%s", lines[i].brief, lines[i].unit);
      ethd_csv_text(csv, what);
      ethd_csv_row(csv);
    }
  return ethd_csv_close(csv, message);
}

int ethd__explain_print(const ethd__explain_figures *figures) {
  int missed = 0;
  printf("  %-8s %-46s %10s   %-22s\n", "", "", "is", "must be");
  for (int i = 0; i < ETHD_EXPLAIN_LINE_COUNT; i++) {
    bool met = !(ethd__explain_miss(i, figures->value[i], false) > 0);
    char bounds[64];
    if (isfinite(lines[i].high))
      snprintf(bounds, sizeof bounds, "%.4g to %.4g", lines[i].low, lines[i].high);
    else
      snprintf(bounds, sizeof bounds, "at least %.4g", lines[i].low);
    printf("  %-8s %-46s %10.4g   %-18s %-4s%s\n", ethd__explain_group_names[lines[i].group], lines[i].brief,
           figures->value[i], bounds, strcmp(lines[i].unit, "1") ? lines[i].unit : "", met ? "" : " MISSED");
    missed += !met;
  }
  return missed;
}

/* ---- taps ---- */

static ethd__cell run_cell(const ethd__study *study, const char *law, const ethd__speed *speed, uint32_t taps,
                           ethd_status *status, char *message) {
  ethd__stage stage;
  ethd__cell cell = {.law = law, .speed = speed, .results = calloc(taps, sizeof(ethd__result))};
  if (!cell.results) ethd__fail_memory();
  *status = ethd__stage_open(study, law, &stage, message);
  if (*status) return cell;
  for (uint32_t tap = 0; !*status && tap < taps; tap++) {
    *status = ethd__stage_run(&stage, speed, tap, &cell.results[tap], message);
    cell.count += !*status;
  }
  ethd__stage_close(&stage);
  return cell;
}

static double at_least(const ethd__cell *cell, double value) {
  return ethd__cell_valid(cell) < FEWEST ? (double)NAN : value;
}

static void take_table(const ethd__cell *cell, int first, ethd__explain_figures *out) {
  ethd__figure time = ethd__cell_figure(cell, ETHD_TAP_FIELD(delta_s));
  ethd__figure depth = ethd__cell_figure(cell, ETHD_TAP_FIELD(eps));
  const double values[] = {time.mean, time.sd, 1e3 * depth.mean, 1e3 * depth.sd};
  for (int i = 0; i < 4; i++) ethd__explain_set(out, first + i, at_least(cell, values[i]));
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

static void take_high(const ethd__cell *offset, ethd__explain_figures *out) {
  take_table(offset, ETHD_EXPLAIN_ds_high, out);
  ethd__explain_set(out, ETHD_EXPLAIN_with_finger,
                    at_least(offset, ethd__cell_share(offset, ETHD_TAP_FIELD(v_of), 1e-300, INFINITY)));
  ethd__explain_set(out, ETHD_EXPLAIN_under_20,
                    at_least(offset, ethd__cell_share(offset, ETHD_TAP_FIELD(delta_s), 0, 20)));
  ethd__explain_set(out, ETHD_EXPLAIN_under_3,
                    at_least(offset, ethd__cell_share(offset, ETHD_TAP_FIELD(eps), -INFINITY, 3e-3)));
  ethd__explain_set(out, ETHD_EXPLAIN_valid, (double)ethd__cell_valid(offset) / (double)offset->count);
  ethd__explain_set(out, ETHD_EXPLAIN_early, early_from(offset));
}

static void compare_high(const ethd__cell *offset, const ethd__cell *smooth, ethd__explain_figures *out) {
  static const size_t fields[] = {ETHD_TAP_FIELD(d_max), ETHD_TAP_FIELD(v_rmin), ETHD_TAP_FIELD(v_of)};
  double both = (double)(ethd__cell_valid(offset) + ethd__cell_valid(smooth));
  for (int i = 0; i < 3; i++)
    ethd__explain_set(out, ETHD_EXPLAIN_times_d_max + i,
                      size_of(smooth, fields[i]) / fmax(1e-9, size_of(offset, fields[i])));
  ethd__explain_set(out, ETHD_EXPLAIN_valid, both / (double)(offset->count + smooth->count));
}

static void compare_low(const ethd__cell *offset, const ethd__cell *smooth, ethd__explain_figures *out) {
  ethd__explain_set(out, ETHD_EXPLAIN_alike_d_max, 1e3 * difference(offset, smooth, ETHD_TAP_FIELD(d_max)));
  ethd__explain_set(out, ETHD_EXPLAIN_alike_v_of, difference(offset, smooth, ETHD_TAP_FIELD(v_of)));
  ethd__explain_set(out, ETHD_EXPLAIN_alike_v_rmin, difference(offset, smooth, ETHD_TAP_FIELD(v_rmin)));
}

/* ---- the whole ---- */

/* Runs the next of four cells, and fills the figures that it gives together with those before it. */
static ethd_status take_cell(const ethd__study *study, int number, uint32_t taps, ethd__cell cells[4],
                             ethd__explain_figures *out, char *message) {
  static const char *const laws[4] = {"offset", "offset", "smooth", "smooth"};
  ethd_status status;
  bool high = number % 2 == 0;
  cells[number] = run_cell(study, laws[number], &study->speeds[high], high ? 2 * taps : taps, &status, message);
  if (status) return status;
  switch (number) {
  case 0: take_high(&cells[0], out); break;
  case 1: take_table(&cells[1], ETHD_EXPLAIN_ds_low, out); break;
  case 2: compare_high(&cells[0], &cells[2], out); break;
  default: compare_low(&cells[1], &cells[3], out);
  }
  return ETHD_OK;
}

ethd_status ethd__explain_judge(const ethd__explain_question *q, const ethd__explain_twin *twin, double enough,
                                ethd__explain_figures *out, double *total, char message[ETHD_MESSAGE_MAX]) {
  ethd__cell cells[4] = {{0}};
  ethd__speed speeds[2];
  *out = (ethd__explain_figures){{0}, {false}};
  if (!ethd__speed_parse("low", &twin->plant, &speeds[0]) || !ethd__speed_parse("high", &twin->plant, &speeds[1]))
    return ETHD_E_RANGE;
  ethd__study study = {.config = q->config,
                       .plant = twin->plant,
                       .seed = q->seed,
                       .speeds = speeds,
                       .speed_count = 2,
                       .gains = twin->gains,
                       .gain_count = twin->gain_count};
  ethd_status status = ethd__study_prepare(&study, message);
  if (!status && q->asked[ETHD_EXPLAIN_LIMITS]) status = ethd__explain_limits(&study, out, message);
  *total = total_of(q, out);
  for (int i = 0; !status && i < 4 && *total <= enough; i++) {
    status = take_cell(&study, i, q->taps, cells, out, message);
    *total = total_of(q, out);
  }
  for (int i = 0; i < 4; i++) free(cells[i].results);
  return status;
}
