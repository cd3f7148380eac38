#include <math.h>
#include <stdlib.h>

#include "report/forces.h"
#include "report/recordings.h"
#include "report/report.h"
#include "text/csv.h"

static double joints(const double tau[2]) { return fmax(fabs(tau[0]), fabs(tau[1])); }

static double at_ring(const ethd_pose *pose, const double tau[2]) {
  ethd_vec force = ethd_mat_mul_transposed(pose->j_inv, ethd_vec_of(tau));
  return sqrt(force.x * force.x + force.y * force.y);
}

ethd__strongest ethd__strongest_of(const ethd_arm *arm, const ethd__tap_rows *rows) {
  ethd__strongest s = {0, 0, 0, 0};
  for (size_t i = 0; i < rows->count; i++) {
    const ethd_trace *t = &rows->trace[i];
    ethd_pose pose;
    ethd_arm_pose(arm, t->sense.q, &pose);
    s.asked_nm = fmax(s.asked_nm, joints(t->tau_raw));
    s.let_nm = fmax(s.let_nm, joints(t->tau));
    s.asked_n = fmax(s.asked_n, at_ring(&pose, t->tau_raw));
    s.let_n = fmax(s.let_n, at_ring(&pose, t->tau));
  }
  return s;
}

/* Columns of the figures below. */
enum { ASKED_N, LET_N, ASKED_NM, LET_NM, KINDS };

typedef struct forces {
  double *value[KINDS];
  size_t n;
} forces;

static ethd_status read_group(ethd__report *r, const ethd__group *group, const ethd__recordings *recordings,
                              forces *out) {
  char name[ETHD_FILE_NAME_MAX];
  for (size_t i = 0; i < group->cell.count; i++) {
    ethd__tap_rows rows;
    if (group->cell.results[i].metrics.reason != ETHD_TAP_OK) continue;
    ethd__recording_name(&r->data.sheet, group->row[i], name);
    char *path = ethd__recording_path(recordings, name);
    if (!path) continue;
    ethd_status status = ethd__ticks_read(path, &rows, r->message);
    free(path);
    if (status) return status;
    ethd__strongest s = ethd__strongest_of(&r->folder->loaded.config->setup.arm, &rows);
    ethd__tap_rows_free(&rows);
    const double all[KINDS] = {s.asked_n, s.let_n, s.asked_nm, s.let_nm};
    for (int k = 0; k < KINDS; k++) out->value[k][out->n] = all[k];
    out->n++;
  }
  return ETHD_OK;
}

static void put_row(ethd__report *r, const ethd__group *group, forces *f, ethd_csv_out *csv) {
  static const int digits[KINDS] = {1, 2, 2, 3};
  char label[80], n[24], text[KINDS][72];
  const char *cells[KINDS + 3] = {ethd__group_label(group, label), n};
  snprintf(n, sizeof n, "%zu", f->n);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)f->n);
  for (int k = 0; k < KINDS; k++) {
    ethd__summary5 s;
    ethd__summarise(f->value[k], f->n, &s);
    snprintf(text[k], sizeof text[k], "%.*f (%.*f)", digits[k], s.median, digits[k], s.max);
    cells[2 + k] = text[k];
    ethd_csv_number(csv, s.median);
    ethd_csv_number(csv, s.max);
  }
  ethd_csv_row(csv);
  ethd__html_row(&r->page, cells, 1);
}

static ethd_status put_group(ethd__report *r, const ethd__group *group, const ethd__recordings *recordings,
                             ethd_csv_out *csv) {
  forces f = {.n = 0};
  ethd_status status = ETHD_OK;
  for (int k = 0; k < KINDS; k++)
    if (!(f.value[k] = malloc((group->cell.count + 1) * sizeof *f.value[k]))) status = ETHD_E_MEMORY;
  if (!status) status = read_group(r, group, recordings, &f);
  if (!status && f.n) put_row(r, group, &f, csv);
  for (int k = 0; k < KINDS; k++) free(f.value[k]);
  return status;
}

ethd_status ethd__report_forces(ethd__report *r) {
  static const char *const header[] = {
      "cell", "recorded taps", "asked for, N", "let through, N", "asked for, Nm", "let through, Nm", NULL};
  ethd__recordings recordings;
  ethd_status status = ETHD_OK;
  ethd__recordings_find(&r->stations, &recordings);
  if (!recordings.count) return ETHD_OK;
  char *path = ethd__report_path(r, "forces.csv");
  ethd_csv_out *csv = ethd_csv_create(path,
                                      "transition,speed,taps,asked_n_median,asked_n_max,let_n_median,let_n_max,"
                                      "asked_nm_median,asked_nm_max,let_nm_median,let_nm_max",
                                      r->message);
  free(path);
  if (!csv) status = ETHD_E_FILE;
  ethd__html_heading(&r->page, "forces", "What was asked of the motors, and what they gave");
  ethd__html_markup(
      &r->page,
      "<p>The laws ask for a torque; the guard lets through what the limits of device and configuration allow. Only "
      "the "
      "second reaches the motors, and what a finger feels. The largest of each tap, in Nm of a joint and as the force "
      "at "
      "the ring that these torques make (a device's friction and inertia not counted). The largest force that the wall "
      "asks for, in the table of all figures, is the law's wish too.</p>\n");
  ethd__html_table(&r->page, "Valid recorded test taps: median over taps (largest)", header, 1);
  for (size_t i = 0; !status && i < r->data.group_count; i++)
    status = put_group(r, &r->data.group[i], &recordings, csv);
  ethd__html_table_end(&r->page);
  ethd__recordings_free(&recordings);
  ethd_status closed = csv ? ethd_csv_close(csv, r->message) : ETHD_OK;
  return status ? status : closed;
}
