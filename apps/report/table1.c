#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/judged.h"
#include "text/csv.h"

#define NINE 9    /* taps behind each figure of the paper */
#define FEWEST 30 /* taps to draw nine from */

typedef struct table1_line {
  const ethd__mean *mean; /* of the judged sample */
  const ethd__quantity *quantity;
  bool high;
  double share[2]; /* of samples of nine taps whose mean, whose sd lies as far off as the paper's */
} table1_line;

static const ethd__group *offset_at(const ethd__data *data, bool high) {
  for (size_t i = 0; i < data->group_count; i++)
    if (!strcmp(data->group[i].cell.law, "offset") && !strcmp(data->group[i].speed.word, high ? "high" : "low"))
      return &data->group[i];
  return NULL;
}

static void resample(const ethd__report *r, table1_line *row) {
  const ethd__group *group = offset_at(ethd__judged_data(r), row->high);
  double *values = malloc(((group ? group->cell.count : 0) + 1) * sizeof *values);
  if (!values) ethd__fail_memory();
  size_t n = group ? ethd__group_values(group, row->quantity, values) : 0;
  row->share[0] = row->share[1] = NAN;
  if (n >= FEWEST) ethd__resample(values, n, NINE, row->mean->paper, row->mean->paper_sd, r->seed, row->share);
  free(values);
}

static void summary_of(const ethd__data *data, const table1_line *row, ethd__summary5 *out) {
  const ethd__group *group = offset_at(data, row->high);
  *out = (ethd__summary5){.n = 0, .mean = NAN, .sd = NAN};
  if (group) ethd__group_summary(group, row->quantity, out);
}

static void percent(double share, char out[32]) {
  if (isnan(share))
    strcpy(out, "-");
  else
    snprintf(out, 32, "%.1f %%", 100 * share);
}

/* Leaves out the two columns of taps beside the study where there are none. */
static void leave_out_beside(const ethd__report *r, const char *cells[12]) {
  if (!r->beside.group_count) memmove(cells + 4, cells + 6, 6 * sizeof *cells);
}

static void print_row(ethd__report *r, const table1_line *row, ethd_csv_out *csv) {
  const ethd__mean *m = row->mean;
  char name[64], paper[48], here[48], beside[48], n[24], besides[24], average[120], interval[72], p[32], share[2][32];
  ethd__summary5 study, other;
  summary_of(&r->data, row, &study);
  summary_of(&r->beside, row, &other);
  int d = row->quantity->digits;
  snprintf(name, sizeof name, "%s (%s)", m->name, m->unit);
  snprintf(paper, sizeof paper, "%.3f (%.3f)", m->paper, m->paper_sd);
  snprintf(n, sizeof n, "%zu", study.n);
  snprintf(besides, sizeof besides, "%zu", other.n);
  bool known = m->verdict != ETHD_TAP_UNKNOWN;
  ethd__interval_text((ethd__interval){known ? m->low : NAN, m->high, 0, 0}, d, interval);
  snprintf(average, sizeof average, "%.*f (%s)", d, m->average, interval);
  ethd__mean_text(&other, d, beside);
  percent(row->share[0], share[0]);
  percent(row->share[1], share[1]);
  const char *cells[] = {name,
                         paper,
                         ethd__mean_text(&study, d, here),
                         n,
                         beside,
                         besides,
                         average,
                         ethd__verdict_words[m->verdict],
                         ethd__p_text(known ? m->p : NAN, p),
                         share[0],
                         share[1],
                         NULL};
  leave_out_beside(r, cells);
  ethd__html_row(&r->page, cells, 1);
  ethd_csv_word(csv, row->quantity->key);
  ethd_csv_word(csv, row->quantity->unit);
  ethd_csv_word(csv, row->high ? "high" : "low");
  const double figures[] = {m->paper,   m->paper_sd, study.mean,         study.sd,      (double)study.n,
                            other.mean, other.sd,    (double)other.n,    m->average,    (double)m->people,
                            m->low,     m->high,     known ? m->p : NAN, row->share[0], row->share[1]};
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_word(csv, ethd__verdict_words[m->verdict]);
  ethd_csv_row(csv);
}

static ethd_status print_table(ethd__report *r) {
  const char *header[] = {
      "offset", "paper, n = 9",    "this study",    "n", "beside", "n", "people's mean, 90 %", "agreement",
      "p",      "mean as far off", "sd as far off", NULL};
  static const int quantity[ETHD_TAP_MEANS] = {ETHD_Q_DELTA_S, ETHD_Q_EPS, ETHD_Q_DELTA_S, ETHD_Q_EPS};
  ethd__mean means[ETHD_TAP_MEANS];
  ethd__cell cells[ETHD_REPORT_CELLS];
  ethd__sample sample = ethd__judged_sample(r, cells);
  char *path = ethd__report_path(r, "table1.csv");
  ethd_csv_out *csv = ethd_csv_create(
      path,
      "metric,unit,speed,paper_mean,paper_sd,study_mean,study_sd,study_n,beside_mean,beside_sd,beside_n,people_mean,"
      "people,people_low_90,people_high_90,p_equivalent,mean_as_far_off,sd_as_far_off,verdict",
      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__means(&sample, means);
  leave_out_beside(r, header);
  ethd__html_table(&r->page,
                   "Table 1: mean (sample standard deviation) of all valid taps, n; then the mean of people's means",
                   header, 1);
  for (int i = 0; i < ETHD_TAP_MEANS; i++) {
    table1_line row = {&means[i], &ethd__quantities[quantity[i]], i >= 2, {NAN, NAN}};
    resample(r, &row);
    print_row(r, &row, csv);
  }
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}

ethd_status ethd__report_table1(ethd__report *r) {
  if (!offset_at(&r->data, false) && !offset_at(&r->data, true)) return ETHD_OK;
  ethd__html_heading(&r->page, "table1", "Table 1 of the paper");
  if (!ethd__judged_measured(r))
    ethd__html_markup(&r->page,
                      "<p>The simulated device and finger were <b>fitted to the four means of this table</b>, not "
                      "measured: that they agree is no evidence.</p>\n");
  ethd__html_print(
      &r->page,
      "<p>Agreement is shown when the mean of %s's means lies within one published standard deviation of "
      "the published mean (two one-sided t tests, p under 0.05); too few people can't show it. The last "
      "columns say how many samples of nine single taps, as many as the paper has, would have a mean and a "
      "standard deviation at least as far off as the paper's; small shares speak against agreement.</p>\n",
      ethd__judged_name(r));
  return print_table(r);
}
