#include <stdlib.h>

#include "report/report.h"
#include "text/csv.h"

static const int shown[] = {ETHD_Q_V_RVO,   ETHD_Q_V_OF, ETHD_Q_D_MAX, ETHD_Q_V_RMIN,
                            ETHD_Q_DELTA_S, ETHD_Q_EPS,  ETHD_Q_DELAY};
enum { SHOWN = sizeof shown / sizeof *shown };

static ethd_status write_taps(ethd__report *r) {
  char *path = ethd__report_path(r, "tidy.csv");
  ethd_csv_out *csv =
      ethd_csv_create(path, "participant,strategy,speed,tap,v_rvo,v_of,d_max,v_rmin,delta_s,eps,delay", r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  for (size_t g = 0; g < r->data.group_count; g++) {
    const ethd__group *group = &r->data.group[g];
    for (size_t i = 0; i < group->cell.count; i++) {
      const ethd__metrics *m = &group->cell.results[i].metrics;
      if (m->reason != ETHD_TAP_OK) continue;
      ethd_csv_word(csv, r->data.people[group->cell.person[i]]);
      ethd_csv_word(csv, group->cell.law);
      ethd_csv_word(csv, group->speed.word);
      ethd_csv_integer(csv, (int64_t)group->row[i] + 1);
      for (int k = 0; k < SHOWN; k++) ethd_csv_number(csv, ethd__quantities[shown[k]].of(m));
      ethd_csv_row(csv);
    }
  }
  return ethd_csv_close(csv, r->message);
}

ethd_status ethd__report_tidy(ethd__report *r) {
  ethd_status status = write_taps(r);
  if (status) return status;
  ethd__html_heading(&r->page, "model", "The same as a mixed model, in R");
  ethd__html_markup(
      &r->page,
      "<p><code>tidy.csv</code> has a row for each valid test tap: participant, strategy, speed, the tap's row in "
      "taps.csv, and its figures in the units of the tables above. A linear mixed model of all taps, with what differs "
      "between participants as random effects, is</p>\n"
      "<pre>library(lmerTest)\n"
      "taps &lt;- read.csv(\"tidy.csv\", stringsAsFactors = TRUE)\n"
      "model &lt;- lmer(d_max ~ strategy * speed + (1 + strategy | participant), data = taps)\n"
      "anova(model)    # the row strategy:speed is the interaction\n"
      "emmeans::emmeans(model, pairwise ~ strategy | speed)</pre>\n"
      "<p>With few participants such a model often doesn't converge; then <code>(1 | participant)</code> is what is "
      "left, "
      "and the tables above, which assume less, are the safer reading.</p>\n");
  return ETHD_OK;
}
