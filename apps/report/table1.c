#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "tap/claims.h"
#include "text/csv.h"

#define NINE 9    /* taps behind each figure of the paper */
#define FEWEST 30 /* taps to draw nine from */

/* The larger sample: the taps beside the study where there are any, else the study's. */
static const ethd__data *largest(const ethd__report *r) { return r->beside.group_count ? &r->beside : &r->data; }

static const ethd__group *offset_at(const ethd__data *data, bool high) {
  for (size_t i = 0; i < data->group_count; i++)
    if (!strcmp(data->group[i].cell.law, "offset") && !strcmp(data->group[i].speed.word, high ? "high" : "low"))
      return &data->group[i];
  return NULL;
}

/* ---- Table 1 ---- */

/* The sample that is judged: taps beside the study are simulated. */
static bool was_measured(const ethd__report *r) { return ethd__report_measured(r) && !r->beside.group_count; }

typedef struct line {
  const ethd__mean *mean; /* of the larger sample */
  const ethd__quantity *quantity;
  bool high;
  double mean_share, sd_share; /* share of samples of nine taps that lie as far off as the paper's */
} line;

static void resample(const ethd__report *r, line *row) {
  const ethd__group *group = offset_at(largest(r), row->high);
  double *values = group ? malloc((group->cell.count + 1) * sizeof *values) : NULL;
  size_t n = values ? ethd__group_values(group, row->quantity, values, NULL) : 0;
  row->mean_share = row->sd_share = NAN;
  if (n >= FEWEST)
    ethd__resample(values, n, NINE, row->mean->paper, row->mean->paper_sd, r->seed, &row->mean_share, &row->sd_share);
  free(values);
}

static void summary_of(const ethd__data *data, const line *row, ethd__summary5 *out) {
  const ethd__group *group = offset_at(data, row->high);
  *out = (ethd__summary5){.n = 0};
  if (group) ethd__group_summary(group, row->quantity, out);
}

static const char *percent(double share, char out[32]) {
  if (isnan(share)) return strcpy(out, "-");
  snprintf(out, 32, "%.1f %%", 100 * share);
  return out;
}

static void print_row(ethd__report *r, const line *row, ethd_csv_out *csv) {
  char name[64], paper[48], here[48], beside[48], n[24], besides[24], m[32], s[32];
  ethd__summary5 study, other;
  summary_of(&r->data, row, &study);
  summary_of(&r->beside, row, &other);
  int digits = row->quantity->digits;
  snprintf(name, sizeof name, "%s %s", row->mean->name, row->mean->unit);
  snprintf(paper, sizeof paper, "%.3f (%.3f)", row->mean->paper, row->mean->paper_sd);
  snprintf(n, sizeof n, "%zu", study.n);
  snprintf(besides, sizeof besides, "%zu", other.n);
  const char *word = row->mean->verdict == ETHD_TAP_MET       ? was_measured(r) ? "reproduced" : "fitted"
                     : row->mean->verdict == ETHD_TAP_NOT_MET ? "not"
                                                              : "too few taps";
  const char *spread = isnan(row->sd_share) ? "too few taps" : row->sd_share >= 0.05 ? "reproduced" : "not";
  const char *cells[] = {name,
                         paper,
                         ethd__mean_text(&study, digits, here),
                         n,
                         r->beside.group_count ? ethd__mean_text(&other, digits, beside) : "-",
                         r->beside.group_count ? besides : "-",
                         word,
                         spread,
                         percent(row->mean_share, m),
                         percent(row->sd_share, s),
                         NULL};
  ethd__html_row(&r->page, cells, 1);
  for (int i = 0; cells[i]; i++) ethd_csv_text(csv, cells[i]);
  ethd_csv_row(csv);
}

static ethd_status print_table(ethd__report *r) {
  static const char *const header[] = {"offset",
                                       "paper, n = 9",
                                       "this study",
                                       "n",
                                       "beside",
                                       "n",
                                       "mean",
                                       "sd",
                                       "9 taps: mean as far off",
                                       "9 taps: sd as far off",
                                       NULL};
  static const int quantity[ETHD_TAP_MEANS] = {ETHD_Q_DELTA_S, ETHD_Q_EPS, ETHD_Q_DELTA_S, ETHD_Q_EPS};
  ethd__mean means[ETHD_TAP_MEANS];
  ethd__cell cells[ETHD_REPORT_CELLS];
  size_t count = ethd__data_cells(largest(r), cells);
  char *path = ethd__report_path(r, "table1.csv");
  ethd_csv_out *csv = ethd_csv_create(
      path, "what,paper,study,study_n,beside,beside_n,mean_verdict,sd_verdict,mean_as_far_off,sd_as_far_off",
      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__means(cells, count, means);
  ethd__html_table(&r->page, "Table 1: mean (sample standard deviation), n", header, 1);
  for (int i = 0; i < ETHD_TAP_MEANS; i++) {
    line row = {&means[i], &ethd__quantities[quantity[i]], i >= 2, NAN, NAN};
    resample(r, &row);
    print_row(r, &row, csv);
  }
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}

/* ---- claims ---- */

static void print_claims(ethd__report *r) {
  static const char *const header[] = {"what the paper says", "here", "", NULL};
  static const char *const words[] = {
      [ETHD_TAP_UNKNOWN] = "too few taps", [ETHD_TAP_MET] = "reproduced", [ETHD_TAP_NOT_MET] = "not"};
  ethd__tap_claim claims[ETHD_TAP_CLAIMS_MAX];
  ethd__cell cells[ETHD_REPORT_CELLS];
  size_t count = ethd__data_cells(largest(r), cells), n = ethd__claims(cells, count, claims);
  ethd__html_table(&r->page,
                   r->beside.group_count ? "Claims, judged by the taps beside the study, which are more"
                                         : "Claims, judged by this study's taps",
                   header, 3);
  for (size_t i = 0; i < n; i++) {
    const char *row[] = {claims[i].text, claims[i].verdict ? claims[i].here : "-", words[claims[i].verdict], NULL};
    ethd__html_row(&r->page, row, 3);
  }
  ethd__html_table_end(&r->page);
}

ethd_status ethd__report_table1(ethd__report *r) {
  if (!offset_at(&r->data, false) && !offset_at(&r->data, true)) return ETHD_OK;
  ethd__html_heading(&r->page, "table1", "Table 1 and the paper's claims");
  ethd__html_markup(
      &r->page,
      was_measured(r)
          ? "<p>A mean counts as reproduced "
          : "<p>The simulated device and finger were <b>fitted to the four means of Table 1</b>, not measured: "
            "that the means agree is no evidence. What was not fitted, the spreads and the claims, says "
            "more. A mean counts as fitted ");
  ethd__html_markup(
      &r->page,
      "when it is within one published standard deviation plus two standard errors of the paper's; a spread as "
      "reproduced when at least 5 % of samples of nine taps have one as far off as the paper's, two-sided.</p>\n");
  ethd_status status = print_table(r);
  print_claims(r);
  return status;
}
