#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "tap/felt.h"
#include "text/csv.h"

static const int shown[] = {ETHD_Q_V_RVO, ETHD_Q_V_HAND, ETHD_Q_V_OF, ETHD_Q_D_MAX, ETHD_Q_V_RMIN};
enum { SHOWN = sizeof shown / sizeof *shown };

enum { RING, FINGER, ALL, RULES };

static bool counts(const ethd__metrics *m, int rule) {
  return rule == ALL || (rule == RING ? m->by_ring : m->by_finger) == ETHD_TAP_OK;
}

/* Whether every tap was judged by both rules; tables of earlier versions have the study's alone. */
static bool has_both(const ethd__report *r) {
  for (size_t g = 0; g < r->data.group_count; g++)
    for (size_t i = 0; i < r->data.group[g].cell.count; i++) {
      const ethd__metrics *m = &r->data.group[g].cell.results[i].metrics;
      if (m->by_ring == ETHD_TAP_REASON_COUNT || m->by_finger == ETHD_TAP_REASON_COUNT) return false;
    }
  return true;
}

typedef struct rule_row {
  const char *word;
  size_t valid, both;
  double median[SHOWN];
} rule_row;

static rule_row row_of(const ethd__report *r, const ethd__group *group, int rule) {
  static const char *const words[2][RULES] = {{"ring, the study's rule", "hand and finger", "every tap"},
                                              {"ring", "hand and finger, the study's rule", "every tap"}};
  rule_row out = {.word = words[r->folder->protocol.validity == ETHD_TAP_BY_FINGER][rule]};
  double *values = malloc((group->cell.count + 1) * sizeof *values);
  for (int q = 0; q < SHOWN; q++) {
    size_t n = 0;
    out.valid = out.both = 0;
    for (size_t i = 0; values && i < group->cell.count; i++) {
      const ethd__metrics *m = &group->cell.results[i].metrics;
      if (!counts(m, rule)) continue;
      out.valid++, out.both += counts(m, RING) && counts(m, FINGER);
      values[n] = ethd__quantities[shown[q]].of(m);
      n += !isnan(values[n]);
    }
    ethd__sort(values, n);
    out.median[q] = ethd__quantile(values, n, 0.5);
  }
  free(values);
  return out;
}

static void put_row(ethd__report *r, const ethd__group *group, int rule, ethd_csv_out *csv) {
  rule_row row = row_of(r, group, rule);
  char label[80], valid[24], both[24], median[SHOWN][32];
  const char *cells[SHOWN + 5] = {rule ? "" : ethd__group_label(group, label), row.word, valid, both};
  snprintf(valid, sizeof valid, "%zu", row.valid);
  snprintf(both, sizeof both, "%zu", row.both);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_text(csv, row.word);
  ethd_csv_integer(csv, (int64_t)row.valid);
  ethd_csv_integer(csv, (int64_t)row.both);
  for (int q = 0; q < SHOWN; q++) {
    cells[4 + q] = ethd__number_text(row.median[q], ethd__quantities[shown[q]].digits, median[q]);
    ethd_csv_number(csv, row.median[q]);
  }
  ethd_csv_row(csv);
  ethd__html_row(&r->page, cells, 2);
}

ethd_status ethd__report_validity(ethd__report *r) {
  static const char *const header[] = {"cell",       "valid by", "taps",     "by both",    "v_rvo m/s",
                                       "v_hand m/s", "v_of m/s", "d_max mm", "v_rmin m/s", NULL};
  char *path = ethd__report_path(r, "validity.csv");
  ethd_csv_out *csv =
      ethd_csv_create(path, "transition,speed,rule,taps,by_both,v_rvo,v_hand,v_of,d_max,v_rmin", r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_heading(&r->page, "rules", "What validity does to the comparison");
  ethd__html_markup(
      &r->page,
      r->folder->protocol.validity == ETHD_TAP_BY_FINGER
          ? "<p>This study's taps are valid by the hand's own speed and by when the finger touched: no strategy can "
            "change by which taps it is judged.</p>\n"
          : "<p>This study's taps are valid, as the paper's, by the speed at which the <em>ring</em> meets the wall. A "
            "strategy that slows the ring down beforehand changes that speed, and so by which taps it is judged: see "
            "v_rvo of every tap.</p>\n");
  if (!has_both(r)) {
    ethd__html_markup(&r->page, "<p>These taps come from an earlier version, which didn't judge them by the other "
                                "rule.</p>\n");
    return ethd_csv_close(csv, r->message);
  }
  ethd__html_print(
      &r->page,
      "<p>By the ring, a tap counts when the ring meets the wall at the speed asked for, before the finger "
      "touches it. By hand and finger, it counts when the hand's own path crosses the wall at that speed "
      "and the finger doesn't touch before the ring is behind the wall, or within %g mm of it and slower "
      "than %g m/s. Either way the finger has to press for a while, once.</p>\n",
      1e3 * ETHD_TAP_NEAR, ETHD_TAP_STILL);
  ethd__html_table(&r->page, "Medians of the taps that each rule lets count", header, 2);
  for (size_t i = 0; i < r->data.group_count; i++)
    for (int rule = 0; rule < RULES; rule++) put_row(r, &r->data.group[i], rule, csv);
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}
