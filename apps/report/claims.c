#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/judged.h"
#include "text/csv.h"
#include "text/text.h"

const ethd__data *ethd__judged_data(const ethd__report *r) { return r->beside.group_count ? &r->beside : &r->data; }

const char *ethd__judged_name(const ethd__report *r) { return r->beside.group_count ? r->beside_name : "this study"; }

bool ethd__judged_measured(const ethd__report *r) { return ethd__report_measured(r) && !r->beside.group_count; }

ethd__sample ethd__judged_sample(const ethd__report *r, ethd__cell cells[ETHD_REPORT_CELLS]) {
  const ethd__data *data = ethd__judged_data(r);
  const ethd__protocol *p = &r->folder->protocol;
  return (ethd__sample){cells,
                        ethd__data_cells(data, cells),
                        data->people_count,
                        {p->margin_d_max, p->margin_v_of, p->margin_v_rmin},
                        r->seed};
}

static void print_part(ethd__report *r, const ethd__claim_part *part) {
  char bounds[64], n[80], mean[32], interval[72], p[32], d_z[32];
  if (isinf(part->to))
    snprintf(bounds, sizeof bounds, "above %g %s", part->from, part->unit);
  else if (isinf(part->from))
    snprintf(bounds, sizeof bounds, "below %g %s", part->to, part->unit);
  else
    snprintf(bounds, sizeof bounds, "%g to %g %s", part->from, part->to, part->unit);
  size_t both = part->at[0] + part->at[1] - part->people;
  snprintf(n, sizeof n, part->at[0] ? "%zu (low %zu, high %zu, both %zu)" : "%zu", part->people, part->at[0],
           part->at[1], both);
  const char *cells[] = {part->what,
                         bounds,
                         *part->test ? part->test : "-",
                         n,
                         ethd__number_text(part->mean, 3, mean),
                         ethd__interval_text((ethd__interval){part->low, part->high, 0, 0}, 3, interval),
                         ethd__number_text(part->d_z, 2, d_z),
                         ethd__p_text(part->p, p),
                         NULL};
  ethd__html_row(&r->page, cells, 3);
}

static void print_claim(ethd__report *r, const ethd__tap_claim *c) {
  char text[320], p[32];
  bool without_p =
      isnan(c->holm) || c->verdict == ETHD_TAP_CONTRARY; /* p belongs to the sentence, not to its contrary */
  snprintf(text, sizeof text, "%s: %s%s%s", c->text, ethd__verdict_words[c->verdict],
           without_p        ? ""
           : c->holm < 1e-4 ? "; by Holm p "
                            : "; by Holm p = ",
           without_p ? "" : ethd__p_text(c->holm, p));
  ethd__html_span(&r->page, text, 8);
  for (size_t k = 0; k < c->parts; k++) print_part(r, &c->part[k]);
}

static void write_part(const ethd__tap_claim *c, int index, size_t k, ethd_csv_out *csv) {
  const ethd__claim_part *part = &c->part[k];
  ethd_csv_integer(csv, index + 1);
  ethd_csv_text(csv, c->text);
  ethd_csv_text(csv, part->what);
  ethd_csv_text(csv, part->unit);
  ethd_csv_number(csv, isinf(part->from) ? NAN : part->from);
  ethd_csv_number(csv, isinf(part->to) ? NAN : part->to);
  ethd_csv_integer(csv, (int64_t)part->people);
  const double figures[] = {part->mean, part->low, part->high, part->d_z, part->p, c->p, c->holm};
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_text(csv, ethd__verdict_words[c->verdict]);
  ethd_csv_text(csv, part->test);
  for (int i = 0; i < 2; i++) ethd_csv_number(csv, part->at[i] ? (double)part->at[i] : NAN);
  ethd_csv_row(csv);
}

/* Prints how many sentences are shown, contradicted and open. */
static void print_outcome(ethd__report *r, const ethd__tap_claim *claims) {
  size_t *count = r->counts.verdict;
  const char *between = "";
  for (int i = 0; i < ETHD_TAP_CLAIMS; i++) count[claims[i].verdict]++;
  ethd__html_print(&r->page, "<p>Of %d sentences: ", ETHD_TAP_CLAIMS);
  static const ethd__verdict order[] = {ETHD_TAP_SHOWN, ETHD_TAP_CONTRARY, ETHD_TAP_OPEN, ETHD_TAP_UNKNOWN};
  for (size_t i = 0; i < ETHD_TAP_VERDICTS; i++) {
    if (!count[order[i]]) continue;
    ethd__html_print(&r->page, order[i] == ETHD_TAP_CONTRARY ? "%sof %zu %s" : "%s%zu %s", between, count[order[i]],
                     ethd__verdict_words[order[i]]);
    between = ", ";
  }
  ethd__html_markup(&r->page, ".</p>\n");
}

static void print_rules(ethd__report *r) {
  const ethd__data *data = ethd__judged_data(r);
  const ethd__protocol *p = &r->folder->protocol;
  ethd__html_print(
      &r->page,
      "<p>Judged by the taps of %s, %zu participant%s. A sentence is shown when all its parts are: its p is the "
      "largest of theirs, and is corrected by Holm for all the sentences of this table, the family. "
      "&quot;Not shown&quot; doesn't mean that the contrary holds. Smooth and offset are alike when their difference "
      "lies within &#177;%g mm (d_max) and &#177;%g and &#177;%g m/s (v_of, v_rmin): margins of the study file.</p>\n",
      ethd__judged_name(r), data->people_count, ethd__s(data->people_count), 1e3 * p->margin_d_max, p->margin_v_of,
      p->margin_v_rmin);
  ethd__html_markup(
      &r->page,
      "<p>Tests: <em>sign flip</em>, the exact permutation test of people's contrasts; <em>TOST</em>, two "
      "one-sided t tests; <em>bootstrap</em> of people and their taps, for the threshold; "
      "<em>overlap</em>, where fewer than six people have a valid tap in all four cells: the strategies' "
      "differences of all people who have one at high speed are compared with those of all who have one at "
      "low speed, by a t test that takes into account who is in both (Derrick and others 2017). It assumes "
      "that who lacks a valid tap doesn't depend on the difference.</p>\n"
      "<p>The threshold is the voluntary speed of the hand that parts the taps which touch early from the others "
      "with the fewest mistakes, under all strategies together; a hand is seldom as fast as it was asked to be. "
      "Limits of braking time and offset are held against each person's largest valid value, so that a single "
      "tap may exceed a limit that is shown. The share of valid taps is the mean of the people's shares; the "
      "table of valid taps pools all taps, so that those who needed many weigh more there.</p>\n");
  ethd__html_print(
      &r->page, "<p class=\"note\">%s</p>\n",
      r->beside.group_count
          ? "These participants are simulated: a p value says how sure the simulation's own answer is. More "
            "participants cost nothing and make any p small; none of them is evidence about people."
          : ethd__report_caveat(r));
}

ethd_status ethd__report_claims(ethd__report *r) {
  static const char *const header[] = {
      "tested within people", "must be", "test", "n", "mean", "95 %", "d_z", "p", NULL};
  ethd__tap_claim claims[ETHD_TAP_CLAIMS];
  ethd__cell cells[ETHD_REPORT_CELLS];
  ethd__sample sample = ethd__judged_sample(r, cells);
  if (!ethd__cell_find(cells, sample.count, "offset", "low") && !ethd__cell_find(cells, sample.count, "offset", "high"))
    return ETHD_OK;
  char *path = ethd__report_path(r, "claims.csv");
  ethd_csv_out *csv = ethd_csv_create(path,
                                      "claim,text,contrast,unit,from,to,participants,mean,low,high,d_z,p,p_claim,p_"
                                      "holm,verdict,test,people_low,people_high",
                                      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__claims(&sample, claims);
  ethd__html_heading(&r->page, "claims", "The paper's sentences");
  print_rules(r);
  print_outcome(r, claims);
  ethd__html_table(&r->page, "Sentences of the paper; n, mean and interval of people's contrasts", header, 3);
  for (int i = 0; i < ETHD_TAP_CLAIMS; i++) {
    print_claim(r, &claims[i]);
    for (size_t k = 0; k < claims[i].parts; k++) write_part(&claims[i], i, k, csv);
  }
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}
