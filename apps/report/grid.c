#include <math.h>
#include <stdlib.h>

#include "report/report.h"
#include "text/csv.h"

static const int shown[] = {ETHD_Q_DELTA_S, ETHD_Q_EPS, ETHD_Q_D_MAX, ETHD_Q_V_RMIN, ETHD_Q_V_OF};
enum { SHOWN = sizeof shown / sizeof *shown };
#define ROWS_MAX 400 /* of the page; grid.csv has all */

static void write_row(ethd__report *r, const ethd__protocol *p, size_t point, const ethd__group *group, bool page,
                      ethd_csv_out *csv) {
  char label[80], taps[24], share[32], text[SHOWN][48], gains[160] = "";
  const char *cells[SHOWN + 5] = {gains, ethd__group_label(group, label), taps, share};
  size_t valid = ethd__cell_valid(&group->cell), used = 0;
  ethd_csv_integer(csv, (int64_t)point);
  for (size_t i = 0; i < p->axis_count; i++) {
    const char *value = ethd__protocol_value(p, point, i);
    ethd_csv_text(csv, value);
    if (used < sizeof gains) used += (size_t)snprintf(gains + used, sizeof gains - used, "%s%s", i ? ", " : "", value);
  }
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)group->cell.count);
  ethd_csv_integer(csv, (int64_t)valid);
  snprintf(taps, sizeof taps, "%zu", valid);
  snprintf(share, sizeof share, "%.0f %%", 100 * (double)valid / (double)group->cell.count);
  for (int i = 0; i < SHOWN; i++) {
    const ethd__quantity *q = &ethd__quantities[shown[i]];
    ethd__summary5 s;
    ethd__group_summary(group, q, &s);
    ethd__number_text(s.median, q->digits, text[i]);
    cells[4 + i] = text[i];
    ethd_csv_number(csv, s.mean);
    ethd_csv_number(csv, s.sd);
    ethd_csv_number(csv, s.median);
  }
  ethd_csv_row(csv);
  if (page) ethd__html_row(&r->page, cells, 2);
}

static char *csv_header(const ethd__protocol *p) {
  char *text = NULL;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  if (!file) return NULL;
  fputs("point", file);
  for (size_t i = 0; i < p->axis_count; i++) fprintf(file, ",%s", p->axes[i].key);
  fputs(",transition,speed,taps,valid", file);
  for (int i = 0; i < SHOWN; i++) {
    const char *key = ethd__quantities[shown[i]].key;
    fprintf(file, ",%s_mean,%s_sd,%s_median", key, key, key);
  }
  return fclose(file) ? NULL : text;
}

static ethd_status points(ethd__report *r, const ethd__protocol *p, ethd_csv_out *csv) {
  size_t rows = 0;
  ethd_status status = ETHD_OK;
  for (size_t point = 0; !status && point < r->data.points; point++) {
    ethd__data data;
    status = ethd__data_at(&r->data, &r->folder->loaded.plant, point, &data, r->message);
    for (size_t i = 0; !status && i < data.group_count; i++)
      write_row(r, p, point, &data.group[i], rows++ < ROWS_MAX, csv);
    if (!status) ethd__data_free(&data);
  }
  return status;
}

ethd_status ethd__report_grid(ethd__report *r) {
  const ethd__protocol *p = &r->folder->protocol;
  const char *header[SHOWN + 5] = {"gains", "cell", "valid", ""};
  if (r->data.points < 2 || !p->axis_count) return ETHD_OK;
  char *names = csv_header(p), *path = ethd__report_path(r, "grid.csv");
  ethd_csv_out *csv = names ? ethd_csv_create(path, names, r->message) : NULL;
  free(names);
  free(path);
  if (!csv) return ETHD_E_FILE;
  for (int i = 0; i < SHOWN; i++) header[4 + i] = ethd__quantities[shown[i]].key;
  ethd__html_heading(&r->page, "grid", "The grid of gains");
  ethd__html_markup(&r->page, "<p>Medians of the valid taps; speeds in m/s, lengths in mm, times in ms. Gains: ");
  for (size_t i = 0; i < p->axis_count; i++) {
    ethd__html_markup(&r->page, i ? ", " : "");
    ethd__html_text(&r->page, p->axes[i].key);
  }
  ethd__html_print(&r->page, ". The other sections show point %zu of %zu.</p>\n", r->point, r->data.points);
  ethd__html_table(&r->page, "All points", header, 2);
  ethd_status status = points(r, p, csv);
  ethd__html_table_end(&r->page);
  ethd_status closed = ethd_csv_close(csv, r->message);
  return status ? status : closed;
}
