#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "report/report.h"
#include "text/csv.h"

#define POINTS_MAX 60 /* taps of a cell that are shown one by one */

typedef struct files {
  ethd_csv_out *boxes, *points;
} files;

/* Speeds stand apart. */
static double place(const ethd__data *data, size_t group) {
  double x = 0;
  for (size_t i = 0; i <= group; i++)
    x += 1 + (i && data->group[i].speed.centre != data->group[i - 1].speed.centre ? 0.5 : 0);
  return x;
}

static void write_box(const files *f, const ethd__data *data, size_t index, const ethd__quantity *quantity) {
  const ethd__group *group = &data->group[index];
  double *values = malloc((group->cell.count + 1) * sizeof *values), x = place(data, index);
  ethd__summary5 s;
  size_t n = values ? ethd__group_values(group, quantity, values, NULL) : 0;
  ethd__summarise(values, n, &s);
  ethd_csv_word(f->boxes, quantity->key);
  ethd_csv_number(f->boxes, x);
  ethd_csv_word(f->boxes, group->cell.law);
  ethd_csv_word(f->boxes, group->speed.word);
  ethd_csv_integer(f->boxes, (int64_t)n);
  const double figures[] = {s.min, s.q1, s.median, s.q3, s.max};
  for (int i = 0; i < 5; i++) ethd_csv_number(f->boxes, figures[i]);
  ethd_csv_row(f->boxes);
  for (size_t i = 0; i < n && n <= POINTS_MAX; i++) {
    ethd_csv_word(f->points, quantity->key);
    ethd_csv_number(f->points, x);
    ethd_csv_number(f->points, values[i]);
    ethd_csv_row(f->points);
  }
  free(values);
}

/* NAME-boxes.csv, NAME-points.csv */
static ethd_status write_boxes(const ethd__report *r, const ethd__data *data, const char *boxes, const char *points) {
  files f = {ethd_csv_create(boxes, "metric,x,transition,speed,n,min,q1,median,q3,max", r->message), NULL};
  if (f.boxes) f.points = ethd_csv_create(points, "metric,x,value", r->message);
  if (!f.points) {
    ethd_csv_abandon(f.boxes);
    return ETHD_E_FILE;
  }
  for (int q = 0; q < ETHD_QUANTITIES; q++)
    for (size_t i = 0; i < data->group_count; i++) write_box(&f, data, i, &ethd__quantities[q]);
  ethd_status status = ethd_csv_close(f.boxes, r->message);
  ethd_status other = ethd_csv_close(f.points, r->message);
  return status ? status : other;
}

static bool braked(const ethd__data *data) {
  ethd__summary5 s;
  for (size_t i = 0; i < data->group_count; i++) {
    ethd__group_summary(&data->group[i], &ethd__quantities[ETHD_Q_DELTA_S], &s);
    if (s.n) return true;
  }
  return false;
}

static ethd_status draw(ethd__report *r, const char *prefix, const char *picture, const char *metrics,
                        const char *heading, const char *caption) {
  char name[64], boxes[64], points[64];
  const char *note = ethd__report_measured(r)
                         ? "measured. Valid taps: medians (red), quartiles, extremes"
                         : "simulated: plausible, fitted, not measured. Valid taps: medians (red), quartiles, extremes";
  snprintf(name, sizeof name, "%s%s.png", prefix, picture);
  snprintf(boxes, sizeof boxes, "%sboxes.csv", prefix);
  snprintf(points, sizeof points, "%spoints.csv", prefix);
  const ethd__picture_value values[] = {{"in", boxes, true},         {"points", points, true},
                                        {"metrics", metrics, false}, {"heading", heading, false},
                                        {"note", note, false},       {NULL, NULL, false}};
  return ethd__report_picture(r, "report-boxes.gp", name, caption, values);
}

static ethd_status pictures(ethd__report *r, const ethd__data *data, const char *prefix, const char *whose) {
  char name[64], caption[256], heading[96];
  snprintf(name, sizeof name, "%sboxes.csv", prefix);
  char *boxes = ethd__report_path(r, name);
  snprintf(name, sizeof name, "%spoints.csv", prefix);
  char *points = ethd__report_path(r, name);
  ethd_status status = write_boxes(r, data, boxes, points);
  snprintf(heading, sizeof heading, "Taps on a virtual wall: %s", whose);
  snprintf(caption, sizeof caption, "As figures 14 to 17 of the paper, %s. Dots are single taps, where they are few.",
           whose);
  if (!status) status = draw(r, prefix, "boxes", "v_rvo v_of d_max v_rmin", heading, caption);
  if (!status && braked(data)) {
    snprintf(heading, sizeof heading, "Braking: %s", whose);
    snprintf(caption, sizeof caption, "Time of braking and offset of the wall, %s: what Table 1 sums up.", whose);
    status = draw(r, prefix, "braking", "delta_s eps", heading, caption);
  }
  free(boxes);
  free(points);
  return status;
}

/* ---- medians ---- */

static void print_median(ethd__report *r, const ethd__group *group, const ethd__quantity *quantity, ethd_csv_out *csv) {
  double *values = malloc((group->cell.count + 1) * sizeof *values);
  uint32_t *person = malloc((group->cell.count + 1) * sizeof *person);
  size_t n = values && person ? ethd__group_values(group, quantity, values, person) : 0;
  ethd__interval interval = ethd__bootstrap_median(values, person, n, r->data.people_count, r->seed);
  ethd__summary5 s;
  ethd__summarise(values, n, &s);
  char label[80], taps[24], mean[48], median[32], q[72], i[72];
  int d = quantity->digits;
  snprintf(taps, sizeof taps, "%zu", n);
  snprintf(q, sizeof q, "%.*f to %.*f", d, s.q1, d, s.q3);
  snprintf(i, sizeof i, "%.*f to %.*f", d, interval.low, d, interval.high);
  const char *cells[] = {quantity->title,
                         quantity->unit,
                         ethd__group_label(group, label),
                         taps,
                         ethd__mean_text(&s, d, mean),
                         ethd__number_text(s.median, d, median),
                         n ? q : "-",
                         isnan(interval.low) ? "-" : i,
                         NULL};
  if (n) ethd__html_row(&r->page, cells, 3);
  const double figures[] = {s.mean, s.sd, s.min, s.q1, s.median, s.q3, s.max, interval.low, interval.high};
  ethd_csv_word(csv, quantity->key);
  ethd_csv_word(csv, quantity->unit);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)n);
  ethd_csv_integer(csv, (int64_t)interval.people);
  for (size_t k = 0; k < sizeof figures / sizeof *figures; k++) ethd_csv_number(csv, figures[k]);
  ethd_csv_row(csv);
  free(values);
  free(person);
}

static ethd_status medians(ethd__report *r) {
  static const char *const header[] = {"figure", "unit",      "cell",         "n", "mean (sd)",
                                       "median", "quartiles", "median, 95 %", NULL};
  char *path = ethd__report_path(r, "summary.csv");
  ethd_csv_out *csv = ethd_csv_create(
      path, "metric,unit,transition,speed,n,participants,mean,sd,min,q1,median,q3,max,median_low,median_high",
      r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_table(&r->page, "Every figure by cell: valid test taps", header, 3);
  for (int q = 0; q < ETHD_QUANTITIES; q++)
    for (size_t i = 0; i < r->data.group_count; i++) print_median(r, &r->data.group[i], &ethd__quantities[q], csv);
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}

ethd_status ethd__report_boxes(ethd__report *r) {
  ethd__html_heading(&r->page, "figures", "Speeds, rebounds, braking");
  ethd_status status = pictures(r, &r->data, "", "this study");
  if (!status && r->beside.group_count) status = pictures(r, &r->beside, "beside-", r->beside_name);
  if (!status) status = medians(r);
  if (status) return status;
  ethd__html_heading(&r->page, "delay", "Visual and haptic delay");
  ethd__html_markup(
      &r->page,
      "<p>When the touch is felt, less when it is seen: positive, felt late; negative, felt early. A delay under 45 "
      "ms is "
      "not noticed (Vogels 2004); in a tap, touch before sight is noticed from about 15 ms, touch after sight from "
      "about 50 ms "
      "(Di Luca and Mahnan 2019). A screen's own delay comes on top of what is seen, and makes these figures "
      "smaller.</p>\n");
  return draw(r, "", "delay", "delay", "Touch felt after it is seen", "Signed delay between sight and touch, by cell.");
}
