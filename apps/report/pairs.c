#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/report.h"
#include "statistics/paired.h"
#include "text/csv.h"
#include "text/text.h"

/* Two strategies at one speed, or their difference at one speed less that at another. */
typedef struct within {
  const ethd__group *a, *b;         /* b - a */
  const ethd__group *low_a, *low_b; /* less low_b - low_a; NULL: nothing is taken off */
  int quantity;
  ethd__paired paired;
  ethd__equivalence alike; /* p NaN: no margin is set, or too few people */
  double cliff, holm;
  ethd__interval cliff_interval;
} within;

typedef struct family {
  within *test;
  size_t count;
} family;

static size_t differences_of(const ethd__report *r, const within *w, double **out) {
  const ethd__quantity *q = &ethd__quantities[w->quantity];
  const ethd__group *const group[] = {w->b, w->a, w->low_b, w->low_a};
  double *own[4] = {NULL};
  size_t n = 0;
  for (int k = 0; k < 4; k++)
    if (group[k]) own[k] = ethd__group_medians(&r->data, group[k], q);
  for (size_t p = 0; p < r->data.people_count; p++) {
    double value = own[0][p] - own[1][p] - (own[2] ? own[2][p] - own[3][p] : 0);
    if (!isnan(value)) own[0][n++] = value;
  }
  for (int k = 1; k < 4; k++) free(own[k]);
  *out = own[0];
  return n;
}

static void measure_cliff(const ethd__report *r, within *w) {
  ethd__tapped *taps;
  ethd__clusters clusters;
  size_t n = ethd__group_taps(w->a, w->b, &ethd__quantities[w->quantity], &taps);
  if (!ethd__clusters_make(taps, n, r->data.people_count, &clusters)) ethd__fail_memory();
  w->cliff = ethd__clusters_here(&clusters, ethd__clusters_cliff);
  w->cliff_interval = ethd__clusters_bootstrap(&clusters, ethd__clusters_cliff, ETHD_STATISTICS_PEOPLE, r->seed);
  ethd__clusters_free(&clusters);
  free(taps);
}

static void test(const ethd__report *r, within *w) {
  double *values, margin = ethd__report_margin(r, w->quantity);
  size_t n = differences_of(r, w, &values);
  ethd__compare(values, n, r->seed, &w->paired);
  w->alike.p = NAN;
  if (n >= ETHD_STATISTICS_PEOPLE && !isnan(margin)) w->alike = ethd__equivalent(values, n, -margin, margin);
  if (!w->low_a) measure_cliff(r, w);
  free(values);
}

static void add(const ethd__report *r, within w, family *f) {
  within *longer = realloc(f->test, (f->count + 1) * sizeof *longer);
  if (!longer) ethd__fail_memory();
  f->test = longer;
  test(r, &w);
  if (w.paired.n) f->test[f->count++] = w;
}

static void correct(family *f) {
  double *p = malloc((f->count + 1) * sizeof *p);
  if (!p) ethd__fail_memory();
  for (size_t i = 0; i < f->count; i++) p[i] = f->test[i].paired.p;
  ethd__holm(p, f->count);
  for (size_t i = 0; i < f->count; i++) f->test[i].holm = p[i];
  free(p);
}

/* ---- rows ---- */

static const char *what_of(const within *w, char out[160]) {
  if (w->low_a)
    snprintf(out, 160, "(%s - %s): %s less %s", w->b->cell.law, w->a->cell.law, w->a->speed.word, w->low_a->speed.word);
  else
    snprintf(out, 160, "%s - %s, %s", w->b->cell.law, w->a->cell.law, w->a->speed.word);
  return out;
}

static void print_row(ethd__report *r, const within *w) {
  const ethd__quantity *q = &ethd__quantities[w->quantity];
  char what[160], n[48], mean[32], interval[72], p[32], holm[32], alike[32];
  snprintf(n, sizeof n, "%zu (%zu)", w->paired.n, w->paired.positive);
  const char *cells[] = {q->title,
                         what_of(w, what),
                         n,
                         ethd__number_text(w->paired.mean, q->digits, mean),
                         ethd__interval_text(w->paired.interval, q->digits, interval),
                         q->unit,
                         ethd__p_text(w->paired.p, p),
                         ethd__p_text(w->holm, holm),
                         w->low_a ? NULL : ethd__p_text(w->alike.p, alike),
                         NULL};
  ethd__html_row(&r->page, cells, 2);
}

static void print_effect(ethd__report *r, const within *w) {
  const ethd__quantity *q = &ethd__quantities[w->quantity];
  char what[160], d_z[32], effect[72], cliff[32], of_cliff[72];
  const char *cells[] = {q->title,
                         what_of(w, what),
                         ethd__number_text(w->paired.d_z, 2, d_z),
                         ethd__interval_text(w->paired.effect, 2, effect),
                         w->low_a ? NULL : ethd__number_text(w->cliff, 2, cliff),
                         ethd__interval_text(w->cliff_interval, 2, of_cliff),
                         NULL};
  ethd__html_row(&r->page, cells, 2);
}

static void write_row(const within *w, ethd_csv_out *csv) {
  const ethd__quantity *q = &ethd__quantities[w->quantity];
  const ethd__paired *c = &w->paired;
  ethd_csv_word(csv, q->key);
  ethd_csv_word(csv, q->unit);
  ethd_csv_word(csv, w->a->cell.law);
  ethd_csv_word(csv, w->b->cell.law);
  ethd_csv_word(csv, w->a->speed.word);
  if (w->low_a) ethd_csv_word(csv, w->low_a->speed.word);
  ethd_csv_integer(csv, (int64_t)c->n);
  ethd_csv_integer(csv, (int64_t)c->positive);
  const double figures[] = {c->mean, c->sd,   c->interval.low, c->interval.high, c->median,
                            c->p,    w->holm, c->d_z,          c->effect.low,    c->effect.high};
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) ethd_csv_number(csv, figures[i]);
  const double more[] = {w->cliff,     w->cliff_interval.low, w->cliff_interval.high,
                         w->alike.low, w->alike.high,         w->alike.p};
  for (size_t i = 0; !w->low_a && i < sizeof more / sizeof *more; i++)
    ethd_csv_number(csv, isnan(w->alike.p) && i > 2 ? NAN : more[i]);
  ethd_csv_row(csv);
}

static void print_effects(ethd__report *r, const family *f) {
  static const char *const header[] = {"figure", "difference", "d_z", "95 %", "Cliff's delta", "95 %", NULL};
  bool cliff = f->count && !f->test[0].low_a;
  const char *const fewer[] = {header[0], header[1], header[2], header[3], NULL};
  ethd__html_table(&r->page,
                   cliff ? "Effect sizes: d_z of people's differences; Cliff's delta of their taps, -1 to 1"
                         : "Effect sizes: d_z of people's differences of differences",
                   cliff ? header : fewer, 2);
  for (size_t i = 0; i < f->count; i++) print_effect(r, &f->test[i]);
  ethd__html_table_end(&r->page);
}

static ethd_status finish(ethd__report *r, family *f, const char *caption, const char *const *header,
                          ethd_csv_out *csv) {
  correct(f);
  for (size_t i = 0; i < f->count && !f->test[i].low_a; i++) {
    r->counts.differences++;
    r->counts.significant += f->test[i].holm < 0.05;
  }
  ethd__html_table(&r->page, caption, header, 2);
  for (size_t i = 0; i < f->count; i++) {
    print_row(r, &f->test[i]);
    write_row(&f->test[i], csv);
  }
  ethd__html_table_end(&r->page);
  print_effects(r, f);
  free(f->test);
  return ethd_csv_close(csv, r->message);
}

static void print_count(ethd__report *r) {
  ethd__html_print(&r->page, "<p class=\"note\">%s", ethd__report_caveat(r));
  if (r->data.people_count < ETHD_STATISTICS_PEOPLE)
    ethd__html_print(
        &r->page, " <b>No significance is claimed:</b> with %zu participant%s the smallest two-sided p is %.3g.",
        r->data.people_count, ethd__s(r->data.people_count), fmin(1, 2 / exp2((double)r->data.people_count)));
  ethd__html_markup(&r->page, "</p>\n");
}

/* ---- both tables ---- */

ethd_status ethd__report_pairs(ethd__report *r) {
  static const char *const header[] = {"figure", "difference", "n (> 0)", "mean",     "95 %",
                                       "unit",   "p",          "p, Holm", "p, alike", NULL};
  const ethd__data *data = &r->data;
  char *path = ethd__report_path(r, "pairs.csv");
  ethd_csv_out *csv = ethd_csv_create(
      path,
      "metric,unit,transition_a,transition_b,speed,participants,positive,mean_b_minus_a,sd,mean_low,mean_high,median,p,"
      "p_holm,d_z,d_z_low,d_z_high,cliff_delta,cliff_low,cliff_high,mean_low_90,mean_high_90,p_equivalent",
      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_heading(&r->page, "pairs", "Strategies compared within participants");
  print_count(r);
  family f = {NULL, 0};
  for (int q = 0; q < ETHD_QUANTITIES; q++)
    for (size_t a = 0; a < data->group_count; a++)
      for (size_t b = a + 1; b < data->group_count; b++)
        if (!strcmp(data->group[a].speed.word, data->group[b].speed.word))
          add(r, (within){.a = &data->group[a], .b = &data->group[b], .quantity = q}, &f);
  return finish(r, &f,
                "Differences of participants' medians. n: participants with both, in brackets those with a difference "
                "above 0. Family of Holm's correction: the p of this table. p, alike: equivalence within the study's "
                "margin, not corrected",
                header, csv);
}

static const ethd__group *group_at(const ethd__data *data, const char *law, const ethd__speed *speed) {
  for (size_t i = 0; i < data->group_count; i++)
    if (!strcmp(data->group[i].cell.law, law) && !strcmp(data->group[i].speed.word, speed->word))
      return &data->group[i];
  return NULL;
}

/* Compares strategies a and b at this speed with the same two at each lower speed. */
static void add_interactions(const ethd__report *r, const ethd__group *a, const ethd__group *b, int quantity,
                             family *f) {
  const ethd__data *data = &r->data;
  for (size_t i = 0; i < data->group_count; i++) {
    const ethd__group *low_a = &data->group[i];
    if (strcmp(low_a->cell.law, a->cell.law) || !(low_a->speed.centre < a->speed.centre)) continue;
    const ethd__group *low_b = group_at(data, b->cell.law, &low_a->speed);
    if (low_b) add(r, (within){.a = a, .b = b, .low_a = low_a, .low_b = low_b, .quantity = quantity}, f);
  }
}

ethd_status ethd__report_interaction(ethd__report *r) {
  static const char *const header[] = {
      "figure", "difference of differences", "n (> 0)", "mean", "95 %", "unit", "p", "p, Holm", NULL};
  const ethd__data *data = &r->data;
  char *path = ethd__report_path(r, "interaction.csv");
  ethd_csv_out *csv = ethd_csv_create(path,
                                      "metric,unit,transition_a,transition_b,speed,less_speed,participants,positive,"
                                      "mean,sd,mean_low,mean_high,median,p,p_holm,d_z,d_z_low,d_z_high",
                                      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_heading(&r->page, "interaction", "Does the strategy matter more at higher speed?");
  ethd__html_print(&r->page,
                   "<p>The interaction of strategy and speed: each participant's difference between two strategies at "
                   "one speed, less the same difference at a lower speed. It is zero where the speed makes no "
                   "difference to what the strategy does. %s</p>\n",
                   ethd__report_caveat(r));
  family f = {NULL, 0};
  for (int q = 0; q < ETHD_QUANTITIES; q++)
    for (size_t a = 0; a < data->group_count; a++)
      for (size_t b = a + 1; b < data->group_count; b++)
        if (!strcmp(data->group[a].speed.word, data->group[b].speed.word))
          add_interactions(r, &data->group[a], &data->group[b], q, &f);
  return finish(
      r, &f,
      "Differences of differences, tested by an exact sign-flip test. Family of Holm's correction: the p of this table",
      header, csv);
}
