#include "report/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/html.h"
#include "report/picture.h"
#include "text/error_text.h"

char *ethd__report_path(const ethd__report *report, const char *name) { return ethd__folder_path(report->out, name); }

#define VALUES_MAX 12

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

const char *ethd__interval_text(ethd__interval i, int digits, char out[72]) {
  if (isnan(i.low) || isnan(i.high))
    strcpy(out, "-");
  else
    snprintf(out, 72, "%.*f to %.*f", digits, i.low, digits, i.high);
  return out;
}

const char *ethd__p_text(double p, char out[32]) {
  if (isnan(p))
    strcpy(out, "-");
  else
    snprintf(out, 32, p < 1e-4 ? "< 0.0001" : "%.4f", p);
  return out;
}

void ethd__group_summary(const ethd__group *group, const ethd__quantity *quantity, ethd__summary5 *out) {
  double *values = malloc((group->cell.count + 1) * sizeof *values);
  if (!values) ethd__fail_memory();
  ethd__summarise(values, ethd__group_values(group, quantity, values), out);
  free(values);
}

size_t ethd__data_taps(const ethd__data *data, size_t *valid) {
  size_t taps = 0;
  *valid = 0;
  for (size_t i = 0; i < data->group_count; i++) {
    taps += data->group[i].cell.count;
    *valid += ethd__cell_valid(&data->group[i].cell);
  }
  return taps;
}

double ethd__report_margin(const ethd__report *r, int quantity) {
  const ethd__protocol *p = &r->folder->protocol;
  switch (quantity) {
  case ETHD_Q_D_MAX: return 1e3 * p->margin_d_max;
  case ETHD_Q_V_OF: return p->margin_v_of;
  case ETHD_Q_V_RMIN: return p->margin_v_rmin;
  default: return NAN;
  }
}
