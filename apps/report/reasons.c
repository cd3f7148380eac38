#include <inttypes.h>
#include <stdlib.h>

#include "report/report.h"
#include "text/csv.h"

/* In the order of the picture's bars. */
static const ethd__reason order[] = {ETHD_TAP_OK,         ETHD_TAP_EARLY_CONTACT, ETHD_TAP_TOO_SLOW, ETHD_TAP_TOO_FAST,
                                     ETHD_TAP_NO_CONTACT, ETHD_TAP_GRAZING,       ETHD_TAP_DOUBLE,   ETHD_TAP_FAULT};
enum { REASONS = sizeof order / sizeof *order };
_Static_assert(REASONS == (int)ETHD_TAP_REASON_COUNT, "every reason has its bar");

static size_t count_of(const ethd__group *group, ethd__reason reason) {
  size_t n = 0;
  for (size_t i = 0; i < group->cell.count; i++) n += group->cell.results[i].metrics.reason == reason;
  return n;
}

static void write_row(ethd__report *r, size_t index, ethd_csv_out *csv) {
  const ethd__group *group = &r->data.group[index];
  char label[80], taps[24], share[32], each[32], n[REASONS][24];
  const char *cells[REASONS + 5] = {ethd__group_label(group, label), taps, share, each};
  size_t valid = ethd__cell_valid(&group->cell);
  snprintf(taps, sizeof taps, "%zu", group->cell.count);
  snprintf(share, sizeof share, "%.0f %%", 100 * (double)valid / (double)group->cell.count);
  snprintf(each, sizeof each, valid ? "%.1f" : "-", 3 * (double)group->cell.count / (double)valid);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)index + 1);
  ethd_csv_integer(csv, (int64_t)group->cell.count);
  for (int i = 0; i < REASONS; i++) {
    size_t count = count_of(group, order[i]);
    snprintf(n[i], sizeof n[i], "%zu", count);
    cells[4 + i] = n[i];
    ethd_csv_integer(csv, (int64_t)count);
  }
  ethd_csv_row(csv);
  ethd__html_row(&r->page, cells, 1);
}

ethd_status ethd__report_reasons(ethd__report *r) {
  const char *header[REASONS + 5] = {"cell", "taps", "valid", "for 3 valid"};
  for (int i = 0; i < REASONS; i++) header[4 + i] = ethd__reason_words[order[i]];
  char *path = ethd__report_path(r, "reasons.csv");
  ethd_csv_out *csv = ethd_csv_create(
      path, "transition,speed,row,taps,ok,early-contact,too-slow,too-fast,no-contact,grazing,double,fault", r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_heading(&r->page, "valid", "Valid taps");
  ethd__html_markup(
      &r->page, r->folder->protocol.validity == ETHD_TAP_BY_FINGER
                    ? "<p>A tap is valid when the hand's own speed was within the band, the finger didn't touch before "
                      "the ring was "
                      "there, and it pressed once. The paper judges by the ring's speed.</p>\n"
                    : "<p>A tap is valid when the ring met the wall before the finger touched it, at a speed within "
                      "the band, and the "
                      "finger pressed once. The paper's participants needed 10 to 15 taps for three valid ones.</p>\n");
  ethd__html_table(&r->page, "Taps by reason", header, 1);
  for (size_t i = 0; i < r->data.group_count; i++) write_row(r, i, csv);
  ethd__html_table_end(&r->page);
  ethd_status status = ethd_csv_close(csv, r->message);
  if (status) return status;
  static const ethd__picture_value values[] = {
      {"in", "reasons.csv", true}, {"note", "test taps of this study", false}, {NULL, NULL, false}};
  return ethd__report_picture(r, "report-reasons.gp", "reasons.png", "Why taps count or don't, by cell.", values);
}
