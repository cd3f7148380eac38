#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "tap/felt.h"
#include "text/csv.h"

static const int shown[] = {ETHD_Q_V_RVO, ETHD_Q_V_HAND, ETHD_Q_V_OF, ETHD_Q_D_MAX, ETHD_Q_V_RMIN};
enum { SHOWN = sizeof shown / sizeof *shown };

/* Of the study's own bands where it has some. */
static double band_of(const ethd__report *r, const ethd__speed *speed) {
  const ethd__protocol *p = &r->folder->protocol;
  double own = !strcmp(speed->word, "low") ? p->band_low : !strcmp(speed->word, "high") ? p->band_high : NAN;
  return isnan(own) ? speed->band : own;
}

/* By the finger, as far as a row tells: the hand's own speed is within the band, the ring was behind the wall or had
   met it as the finger touched, and nothing else was wrong. */
static bool by_finger(const ethd__report *r, const ethd__group *group, const ethd__metrics *m) {
  bool other = m->reason == ETHD_TAP_FAULT || m->reason == ETHD_TAP_GRAZING || m->reason == ETHD_TAP_DOUBLE;
  bool in_time = m->touch_depth >= 0 || (m->reason != ETHD_TAP_EARLY_CONTACT && m->t_rvo <= m->t_of);
  return !other && in_time && fabs(m->v_hand - group->speed.centre) <= band_of(r, &group->speed);
}

/* Whether the table knows how fast hands were at all. */
static bool has_hands(const ethd__report *r) { return ethd__sheet_column(&r->data.sheet, "v_hand_mps") >= 0; }

typedef struct rule_row {
  const char *word;
  size_t valid, both;
  double median[SHOWN];
} rule_row;

static rule_row row_of(const ethd__report *r, const ethd__group *group, int rule) {
  static const char *const words[] = {"ring, the study's rule", "hand and finger", "every tap"};
  rule_row out = {.word = words[rule]};
  double *values = malloc((group->cell.count + 1) * sizeof *values);
  for (int q = 0; q < SHOWN; q++) {
    size_t n = 0;
    out.valid = out.both = 0;
    for (size_t i = 0; values && i < group->cell.count; i++) {
      const ethd__metrics *m = &group->cell.results[i].metrics;
      bool ring = m->reason == ETHD_TAP_OK, hand = by_finger(r, group, m);
      if (rule == 0 ? !ring : rule == 1 ? !hand : 0) continue;
      out.valid++, out.both += ring && hand;
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
  snprintf(both, sizeof both, has_hands(r) ? "%zu" : "-", row.both);
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
  if (!has_hands(r))
    ethd__html_markup(&r->page, "<p>These taps have no speed of the hand (v_hand_mps), by which they could be judged "
                                "whatever the strategy: only the ring's rule is shown.</p>\n");
  ethd__html_table(&r->page, "Medians of the taps that each rule lets count", header, 2);
  for (size_t i = 0; i < r->data.group_count; i++)
    for (int rule = 0; rule < 3; rule++)
      if (rule != 1 || has_hands(r)) put_row(r, &r->data.group[i], rule, csv);
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}
