#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/report.h"
#include "text/csv.h"

#define DOTS_MAX 300   /* that are drawn for a cell; of more taps only each k-th is shown */
#define COLOURS_MAX 8u /* participants at most whom report-boxes.gp gives colours */
#define LINES_MAX 12u  /* participants at most for whom lines are drawn between the strategies */

typedef struct files {
  ethd_csv_out *boxes, *points, *lines;
} files;

/* Finds the place of each cell on the axis, with a gap between speeds; 0 for cells without the figure. */
static void place(const ethd__data *data, const ethd__quantity *quantity, double x[ETHD_REPORT_CELLS]) {
  double at = 0;
  const ethd__group *before = NULL;
  for (size_t i = 0; i < data->group_count; i++) {
    ethd__summary5 s;
    x[i] = 0;
    ethd__group_summary(&data->group[i], quantity, &s);
    if (!s.n) continue;
    at += before && data->group[i].speed.centre != before->speed.centre ? 1.5 : 1;
    before = &data->group[i];
    x[i] = at;
  }
}

static void write_box(const files *f, const ethd__group *group, const ethd__quantity *quantity, double x) {
  ethd__summary5 s;
  ethd__group_summary(group, quantity, &s);
  ethd_csv_word(f->boxes, quantity->key);
  ethd_csv_number(f->boxes, x);
  ethd_csv_word(f->boxes, group->cell.law);
  ethd_csv_word(f->boxes, group->speed.word);
  ethd_csv_integer(f->boxes, (int64_t)s.n);
  const double figures[] = {s.min, s.q1, s.median, s.q3, s.max};
  for (int i = 0; i < 5; i++) ethd_csv_number(f->boxes, figures[i]);
  ethd_csv_row(f->boxes);
}

/* Beside the box, moved a little so that equal values don't hide each other: by the golden ratio, which spreads any
   number of them evenly. */
static void write_dots(const files *f, const ethd__group *group, const ethd__quantity *quantity, double x) {
  ethd__tapped *taps;
  size_t n = ethd__group_taps(group, NULL, quantity, &taps), step = n / DOTS_MAX + 1;
  for (size_t i = 0; i < n; i += step) {
    ethd_csv_word(f->points, quantity->key);
    ethd_csv_number(f->points, x + 0.22 + 0.2 * fmod(0.618034 * (double)i, 1));
    ethd_csv_number(f->points, taps[i].value);
    ethd_csv_integer(f->points, (int64_t)taps[i].person);
    ethd_csv_row(f->points);
  }
  free(taps);
}

/* Writes the line from a participant's median under one strategy to the median under the next one. */
static void write_lines(const files *f, const ethd__data *data, size_t index, const ethd__quantity *quantity,
                        const double *x) {
  const ethd__group *a = &data->group[index], *b = a + 1;
  if (index + 1 == data->group_count || strcmp(a->speed.word, b->speed.word) || data->people_count > LINES_MAX) return;
  double *from = ethd__group_medians(data, a, quantity), *to = ethd__group_medians(data, b, quantity);
  for (size_t p = 0; p < data->people_count; p++) {
    if (isnan(from[p]) || isnan(to[p])) continue;
    const double figures[] = {x[index], from[p], x[index + 1] - x[index], to[p] - from[p]};
    ethd_csv_word(f->lines, quantity->key);
    for (int i = 0; i < 4; i++) ethd_csv_number(f->lines, figures[i]);
    ethd_csv_integer(f->lines, (int64_t)p);
    ethd_csv_row(f->lines);
  }
  free(from);
  free(to);
}

static void write_quantity(const files *f, const ethd__data *data, const ethd__quantity *quantity) {
  double x[ETHD_REPORT_CELLS];
  place(data, quantity, x);
  for (size_t i = 0; i < data->group_count; i++) {
    if (!(x[i] > 0)) continue;
    write_box(f, &data->group[i], quantity, x[i]);
    write_dots(f, &data->group[i], quantity, x[i]);
    write_lines(f, data, i, quantity, x);
  }
}

static ethd_csv_out *create(const ethd__report *r, const char *prefix, const char *name, const char *header) {
  char whole[64];
  snprintf(whole, sizeof whole, "%s%s", prefix, name);
  char *path = ethd__report_path(r, whole);
  ethd_csv_out *csv = ethd_csv_create(path, header, r->message);
  free(path);
  return csv;
}

static ethd_status write_boxes(const ethd__report *r, const ethd__data *data, const char *prefix) {
  files f = {.boxes = create(r, prefix, "boxes.csv", "metric,x,transition,speed,n,min,q1,median,q3,max")};
  if (f.boxes) f.points = create(r, prefix, "points.csv", "metric,x,value,person");
  if (f.points) f.lines = create(r, prefix, "lines.csv", "metric,x,y,dx,dy,person");
  if (!f.lines) {
    if (f.boxes) ethd_csv_abandon(f.boxes);
    if (f.points) ethd_csv_abandon(f.points);
    return ETHD_E_FILE;
  }
  for (int q = 0; q < ETHD_QUANTITIES; q++) write_quantity(&f, data, &ethd__quantities[q]);
  ethd_csv_out *const made[] = {f.boxes, f.points, f.lines};
  ethd_status failure = ETHD_OK;
  for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
    char unsaid[ETHD_MESSAGE_MAX];
    ethd_status status = ethd_csv_close(made[i], failure ? unsaid : r->message);
    if (!failure) failure = status;
  }
  return failure;
}

static bool braked(const ethd__data *data) {
  ethd__summary5 s;
  for (size_t i = 0; i < data->group_count; i++) {
    ethd__group_summary(&data->group[i], &ethd__quantities[ETHD_Q_DELTA_S], &s);
    if (s.n) return true;
  }
  return false;
}

static ethd_status draw(ethd__report *r, const ethd__data *data, const char *prefix, const char *const words[4]) {
  char name[64], boxes[64], points[64], lines[64], people[24], note[160];
  bool measured = ethd__report_measured(r) && !*prefix;
  snprintf(note, sizeof note, "%s Valid taps. Box: median (red), quartiles, extremes. Dots: taps%s",
           measured ? "Measured." : "Simulated, not measured.",
           data->people_count <= COLOURS_MAX ? "; colours and dashed lines (medians): participants"
           : data->people_count <= LINES_MAX ? "; dashed lines: participants' medians"
                                             : "");
  snprintf(name, sizeof name, "%s%s.png", prefix, words[0]);
  snprintf(boxes, sizeof boxes, "%sboxes.csv", prefix);
  snprintf(points, sizeof points, "%spoints.csv", prefix);
  snprintf(lines, sizeof lines, "%slines.csv", prefix);
  snprintf(people, sizeof people, "%zu", data->people_count);
  const ethd__picture_value values[] = {
      {"in", boxes, true},          {"points", points, true}, {"between", lines, true},  {"metrics", words[1], false},
      {"heading", words[2], false}, {"note", note, false},    {"people", people, false}, {NULL, NULL, false}};
  return ethd__report_picture(r, "report-boxes.gp", name, words[3], values);
}

static ethd_status pictures(ethd__report *r, const ethd__data *data, const char *prefix, const char *whose) {
  char caption[400], heading[128];
  ethd_status status = write_boxes(r, data, prefix);
  snprintf(heading, sizeof heading, "Taps on a virtual wall: %s", whose);
  snprintf(caption, sizeof caption,
           "As figures 14 to 17 of the paper, %s. Speeds are positive toward the wall. Of more than %d taps in a cell "
           "every second, third and so on is drawn.",
           whose, DOTS_MAX);
  const char *const speeds[] = {"boxes", "v_rvo v_of d_max v_rmin", heading, caption};
  if (!status) status = draw(r, data, prefix, speeds);
  if (status || !braked(data)) return status;
  snprintf(heading, sizeof heading, "Braking: %s", whose);
  snprintf(caption, sizeof caption,
           "Time of braking and offset of the wall, %s: what Table 1 sums up. Where the dots make two heaps, the mean "
           "between them describes no tap; the table of all figures marks such cells.",
           whose);
  const char *const braking[] = {"braking", "delta_s eps", heading, caption};
  return draw(r, data, prefix, braking);
}

ethd_status ethd__report_boxes(ethd__report *r) {
  ethd__html_heading(&r->page, "figures", "Speeds, rebounds, braking");
  ethd_status status = pictures(r, &r->data, "", "this study");
  if (!status && r->beside.group_count) status = pictures(r, &r->beside, "beside-", r->beside_name);
  if (!status) status = ethd__report_summary(r);
  if (status) return status;
  ethd__html_heading(&r->page, "delay", "Visual and haptic delay");
  ethd__html_markup(
      &r->page,
      "<p>When the touch is felt, less when it is seen: positive, felt late; negative, felt early. A delay under 45 "
      "ms is not noticed (Vogels 2004); in a tap, touch before sight is noticed from about 15 ms, touch after sight "
      "from about 50 ms (Di Luca and Mahnan 2019). A screen's own delay comes on top of what is seen, and makes these "
      "figures smaller.</p>\n");
  static const char *const words[] = {"delay", "delay", "Touch felt after it is seen",
                                      "Signed delay between sight and touch, by cell."};
  return draw(r, &r->data, "", words);
}
