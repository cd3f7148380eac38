#include "report/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/html.h"
#include "report/picture.h"
#include "text/error_text.h"

char *ethd__report_path(const ethd__report *report, const char *name) { return ethd__folder_path(report->out, name); }

#define VALUES_MAX 8

ethd_status ethd__report_picture(ethd__report *r, const char *script, const char *name, const char *caption,
                                 const ethd__picture_value *values) {
  ethd__picture_value all[VALUES_MAX] = {{"out", name, true}};
  for (int i = 1; values->name && i < VALUES_MAX - 1; i++) all[i] = *values++;
  char *png = ethd__report_path(r, name);
  ethd_status status = ethd__picture_draw(script, r->out, all, r->message);
  if (!status && !ethd__html_picture(&r->page, png, caption))
    status = ethd__say(r->message, ETHD_E_FILE, "%s: can't be read", png);
  free(png);
  return status;
}

const char *ethd__group_label(const ethd__group *group, char out[80]) {
  snprintf(out, 80, "%s, %s", group->cell.law, group->speed.word);
  return out;
}

const char *ethd__number_text(double value, int digits, char out[32]) {
  if (isnan(value))
    strcpy(out, "-");
  else
    snprintf(out, 32, "%.*f", digits, value);
  return out;
}

const char *ethd__mean_text(const ethd__summary5 *s, int digits, char out[48]) {
  if (!s->n)
    strcpy(out, "-");
  else if (s->n == 1)
    snprintf(out, 48, "%.*f", digits, s->mean);
  else
    snprintf(out, 48, "%.*f (%.*f)", digits, s->mean, digits, s->sd);
  return out;
}

void ethd__group_summary(const ethd__group *group, const ethd__quantity *quantity, ethd__summary5 *out) {
  double *values = malloc((group->cell.count + 1) * sizeof *values);
  size_t n = values ? ethd__group_values(group, quantity, values, NULL) : 0;
  ethd__summarise(values, n, out);
  free(values);
}

bool ethd__report_measured(const ethd__report *r) {
  const ethd__folder *f = r->folder;
  return f->protocol.hands == ETHD_HANDS_PEOPLE && strcmp(f->loaded.config->device, ethd_driver_sim.id) != 0;
}

void ethd__report_methods(ethd__report *report) {
  static const char *const methods[] = {
      "Means and sample standard deviations (n - 1) as in the paper; medians and quartiles by linear interpolation "
      "between order statistics (Hyndman and Fan, type 7); bars of the box plots are extremes.",
      "Intervals are 95 % percentile bootstrap intervals (Efron 1979). Participants are drawn with replacement, each "
      "with all of their valid taps: taps of one person are no independent sample. With three participants such an "
      "interval is crude.",
      "Pairs: the median of each participant's valid taps under the one and the other strategy, at the same speed. "
      "The p is that of Fisher's sign-flip test, exact up to 16 participants; none is made for fewer than six, whose "
      "smallest possible p is over 0.05. Nothing is corrected for the number of comparisons.",
      "Fitted: the simulated device's parameters were chosen so that this figure comes out; that it does shows "
      "nothing about the strategy. Reproduced: none of the four means that were fitted, and within what the table "
      "states. Not: outside.",
      "n points into the wall: speeds are positive toward it, negative away. t(seen) is the instant at which the "
      "finger's front reaches the wall that a screen without delay would show.",
  };
  ethd__html_heading(&report->page, "methods", "Methods");
  ethd__html_markup(&report->page, "<ul>\n");
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    ethd__html_print(&report->page, "<li>%s</li>\n", methods[i]);
  }
  ethd__html_print(&report->page,
                   "<li>Bootstrap and tests draw their random numbers under seed %llu: %u draws, %u for medians of "
                   "over 4000 taps.</li>\n</ul>\n",
                   (unsigned long long)report->seed, ETHD_STATS_DRAWS, ETHD_STATS_FEW_DRAWS);
}
