#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "text/csv.h"

/* Medians by participant, NaN without a valid tap; freed by the caller. */
static double *by_person(const ethd__report *r, const ethd__group *group, const ethd__quantity *quantity) {
  size_t people = r->data.people_count, n = 0;
  double *values = malloc((group->cell.count + 1) * sizeof *values),
         *own = malloc((group->cell.count + 1) * sizeof *own);
  double *medians = malloc((people + 1) * sizeof *medians);
  uint32_t *person = malloc((group->cell.count + 1) * sizeof *person);
  if (values && own && medians && person) {
    n = ethd__group_values(group, quantity, values, person);
    size_t at = 0; /* a participant's taps stand together */
    for (size_t p = 0; p < people; p++) medians[p] = NAN;
    while (at < n) {
      uint32_t who = person[at];
      size_t count = 0;
      ethd__summary5 s;
      while (at < n && person[at] == who) own[count++] = values[at++];
      ethd__summarise(own, count, &s);
      medians[who] = s.median;
    }
  }
  free(values);
  free(own);
  free(person);
  return medians;
}

static void compare(ethd__report *r, const ethd__group *a, const ethd__group *b, const ethd__quantity *quantity,
                    ethd_csv_out *csv) {
  double *first = by_person(r, a, quantity), *second = by_person(r, b, quantity);
  size_t n = 0;
  for (size_t p = 0; first && second && p < r->data.people_count; p++)
    if (!isnan(first[p]) && !isnan(second[p])) first[n++] = second[p] - first[p];
  ethd__paired c;
  ethd__compare(first, n, r->seed, &c);
  char what[96], pairs[24], positive[24], mean[32], median[32], interval[72], p[40];
  int d = quantity->digits;
  snprintf(what, sizeof what, "%s - %s, %s", b->cell.law, a->cell.law, a->speed.word);
  snprintf(pairs, sizeof pairs, "%zu", n);
  snprintf(positive, sizeof positive, "%zu", c.positive);
  snprintf(interval, sizeof interval, "%.*f to %.*f", d, c.interval.low, d, c.interval.high);
  if (isnan(c.p))
    snprintf(p, sizeof p, "none: n = %zu", n);
  else
    snprintf(p, sizeof p, c.p < 1e-4 ? "< 0.0001" : "%.4f", c.p);
  const char *cells[] = {quantity->title,
                         quantity->unit,
                         what,
                         pairs,
                         ethd__number_text(c.mean, d, mean),
                         isnan(c.interval.low) ? "-" : interval,
                         ethd__number_text(c.median, d, median),
                         positive,
                         p,
                         NULL};
  if (n) {
    ethd__html_row(&r->page, cells, 3);
    ethd_csv_word(csv, quantity->key);
    ethd_csv_word(csv, quantity->unit);
    ethd_csv_word(csv, a->cell.law);
    ethd_csv_word(csv, b->cell.law);
    ethd_csv_word(csv, a->speed.word);
    ethd_csv_integer(csv, (int64_t)n);
    ethd_csv_integer(csv, (int64_t)c.positive);
    const double figures[] = {c.mean, c.interval.low, c.interval.high, c.median, c.p};
    for (int i = 0; i < 5; i++) ethd_csv_number(csv, figures[i]);
    ethd_csv_row(csv);
  }
  free(first);
  free(second);
}

ethd_status ethd__report_pairs(ethd__report *r) {
  static const char *const header[] = {"figure",     "unit",   "difference", "n", "mean",
                                       "mean, 95 %", "median", "> 0",        "p", NULL};
  char *path = ethd__report_path(r, "pairs.csv");
  ethd_csv_out *csv = ethd_csv_create(
      path,
      "metric,unit,transition_a,transition_b,speed,participants,positive,mean_b_minus_a,mean_low,mean_high,median,p",
      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_heading(&r->page, "pairs", "Strategies compared within participants");
  if (r->data.people_count < ETHD_STATS_PAIRS)
    ethd__html_print(
        &r->page,
        "<p class=\"note\">%zu participants: <b>no significance is claimed</b>. The smallest two-sided p that %zu "
        "pairs can have is %.3g.</p>\n",
        r->data.people_count, r->data.people_count, 2 / exp2((double)r->data.people_count));
  ethd__html_table(&r->page, "Differences of participants' medians", header, 3);
  for (int q = 0; q < ETHD_QUANTITIES; q++)
    for (size_t a = 0; a < r->data.group_count; a++)
      for (size_t b = a + 1; b < r->data.group_count; b++)
        if (!strcmp(r->data.group[a].speed.word, r->data.group[b].speed.word))
          compare(r, &r->data.group[a], &r->data.group[b], &ethd__quantities[q], csv);
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}
