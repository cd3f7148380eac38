#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/report.h"
#include "statistics/coverage.h"
#include "statistics/dip.h"
#include "text/csv.h"
#include "text/text.h"

typedef struct cell_summary {
  ethd__summary5 s;
  ethd__interval interval; /* of the median */
  size_t persons;
  double dip, heaps; /* the dip and its p; NaN of few */
} cell_summary;

static cell_summary sum_up(const ethd__report *r, const ethd__group *group, const ethd__quantity *quantity) {
  cell_summary out;
  ethd__tapped *taps;
  ethd__clusters clusters;
  size_t n = ethd__group_taps(group, NULL, quantity, &taps);
  double *values = malloc((n + 1) * sizeof *values);
  if (!values || !ethd__clusters_make(taps, n, r->data.people_count, &clusters)) ethd__fail_memory();
  for (size_t i = 0; i < n; i++) values[i] = taps[i].value;
  ethd__summarise(values, n, &out.s);
  if (quantity->grain > 0) ethd__dip_spread(values, n, quantity->grain);
  out.dip = n ? ethd__dip(values, n) : NAN;
  out.heaps = ethd__dip_share(out.dip, n, r->seed);
  out.interval = ethd__clusters_bootstrap(&clusters, ethd__clusters_median, ETHD_STATISTICS_PEOPLE, r->seed);
  out.persons = clusters.persons;
  ethd__clusters_free(&clusters);
  free(values);
  free(taps);
  return out;
}

static void print_row(ethd__report *r, const ethd__group *group, const ethd__quantity *quantity,
                      const cell_summary *m) {
  char label[80], taps[48], mean[48], median[32], q[72], extremes[72], i[72], p[32], heaps[64];
  int d = quantity->digits;
  snprintf(taps, sizeof taps, "%zu (%zu)", m->s.n, m->persons);
  ethd__p_text(m->heaps, p);
  snprintf(heaps, sizeof heaps, m->heaps < 0.05 ? "more than one, p %s%s" : "%s%s",
           m->heaps < 0.05 && *p != '<' ? "= " : "", p);
  const char *cells[] = {ethd__group_label(group, label),
                         taps,
                         ethd__mean_text(&m->s, d, mean),
                         ethd__number_text(m->s.median, d, median),
                         ethd__interval_text((ethd__interval){m->s.q1, m->s.q3, 0, 0}, d, q),
                         ethd__interval_text((ethd__interval){m->s.min, m->s.max, 0, 0}, d, extremes),
                         ethd__interval_text(m->interval, d, i),
                         heaps,
                         NULL};
  ethd__html_row(&r->page, cells, 1);
}

static void write_row(const ethd__group *group, const ethd__quantity *quantity, const cell_summary *m,
                      ethd_csv_out *csv) {
  const double figures[] = {m->s.mean, m->s.sd,         m->s.min,         m->s.q1, m->s.median, m->s.q3,
                            m->s.max,  m->interval.low, m->interval.high, m->dip,  m->heaps};
  ethd_csv_word(csv, quantity->key);
  ethd_csv_word(csv, quantity->unit);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)m->s.n);
  ethd_csv_integer(csv, (int64_t)m->persons);
  for (size_t k = 0; k < sizeof figures / sizeof *figures; k++) ethd_csv_number(csv, figures[k]);
  ethd_csv_row(csv);
}

ethd_status ethd__report_summary(ethd__report *r) {
  static const char *const header[] = {"cell",     "n (people)",   "mean (sd)",     "median", "quartiles",
                                       "extremes", "median, 95 %", "heaps (dip p)", NULL};
  char *path = ethd__report_path(r, "summary.csv");
  ethd_csv_out *csv = ethd_csv_create(path,
                                      "metric,unit,transition,speed,n,participants,mean,sd,min,q1,median,q3,max,"
                                      "median_low,median_high,dip,dip_p",
                                      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  if (r->data.people_count < ETHD_STATISTICS_PEOPLE)
    ethd__html_print(
        &r->page,
        "<p class=\"note\">The medians have no 95 %% interval: a bootstrap of %zu participant%s would give "
        "little more than the smallest and largest of them, and hold the truth in about %.0f %%, not 95 %%, "
        "of such studies.</p>\n",
        r->data.people_count, ethd__s(r->data.people_count), 100 * ethd__coverage_known(r->data.people_count)->median);
  ethd__html_table(&r->page, "Every figure by cell: valid test taps", header, 1);
  for (int q = 0; q < ETHD_QUANTITIES; q++) {
    char title[160];
    snprintf(title, sizeof title, "%s (%s), %s", ethd__quantities[q].title, ethd__quantities[q].key,
             ethd__quantities[q].unit);
    for (size_t i = 0, shown = 0; i < r->data.group_count; i++) {
      cell_summary m = sum_up(r, &r->data.group[i], &ethd__quantities[q]);
      if (!m.s.n) continue;
      if (!shown++) ethd__html_span(&r->page, title, 8);
      print_row(r, &r->data.group[i], &ethd__quantities[q], &m);
      write_row(&r->data.group[i], &ethd__quantities[q], &m, csv);
    }
  }
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}
