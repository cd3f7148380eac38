#include "trace_in/trace_in.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SECONDS_MAX 9e9 /* the largest time, s: dates as seconds since 1970 fit, and int64 nanoseconds hold them */

static const char *const columns[] = {"t_s",     "q1_rad",  "q2_rad",   "dq1_radps", "dq2_radps", "xf_m", "yf_m",
                                      "vxf_mps", "vyf_mps", "t_ring_s", "r0_m",      "r1_m",      "r2_m", "r3_m",
                                      "r4_m",    "r5_m",    "r6_m",     "r7_m",      "r8_m",      "r9_m", "r10_m",
                                      "r11_m",   "r12_m",   "r13_m",    "r14_m",     "r15_m",     NULL};
enum { Q = 1, DQ = 3, FINGER = 5, T_RING = 9, RAYS = 10 };

static double cell(const ethd__trace_in *in, size_t row, int column) {
  return in->csv.values[row * in->csv.columns + (size_t)column];
}

static ethd_status refuse(const ethd__trace_in *in, size_t row, int column, const char *what,
                          char message[ETHD_MESSAGE_MAX]) {
  snprintf(message, ETHD_MESSAGE_MAX, "%s:%zu: %s: %s", in->csv.path, ethd_csv_line(row), in->csv.names[column], what);
  return ETHD_E_RANGE;
}

/* Fills the columns of `count` names from `first` on; returns how many of them the file has. */
static int find(const ethd__trace_in *in, int first, int count, int *out) {
  int found = 0;
  for (int i = 0; i < count; i++) {
    out[i] = ethd_csv_column(&in->csv, columns[first + i]);
    found += out[i] >= 0;
  }
  return found;
}

static const char *missing(const ethd__trace_in *in, int first, int count) {
  for (int i = 0; i < count; i++)
    if (ethd_csv_column(&in->csv, columns[first + i]) < 0) return columns[first + i];
  return NULL;
}

static ethd_status no_column(const ethd__trace_in *in, const char *name, char message[ETHD_MESSAGE_MAX]) {
  snprintf(message, ETHD_MESSAGE_MAX,
           "%s:1: no column %s; needed are t_s,q1_rad,q2_rad and either xf_m,yf_m,vxf_mps,vyf_mps or "
           "t_ring_s,r0_m..r15_m; dq1_radps,dq2_radps come together",
           in->csv.path, name);
  return ETHD_E_UNKNOWN;
}

static ethd_status find_columns(ethd__trace_in *in, char message[ETHD_MESSAGE_MAX]) {
  in->t = ethd_csv_column(&in->csv, "t_s");
  if (in->t < 0) return no_column(in, "t_s", message);
  if (find(in, Q, 2, in->q) < 2) return no_column(in, missing(in, Q, 2), message);
  if (find(in, DQ, 2, in->dq) == 1) return no_column(in, missing(in, DQ, 2), message);
  int finger = find(in, FINGER, 4, in->finger);
  int ring = find(in, RAYS, ETHD_RAYS, in->rays);
  ring += find(in, T_RING, 1, &in->t_ring);
  in->ring = finger == 0 && ring > 0;
  if (in->ring && ring < ETHD_RAYS + 1) return no_column(in, missing(in, T_RING, ETHD_RAYS + 1), message);
  if (!in->ring && finger < 4) return no_column(in, missing(in, FINGER, 4), message);
  return ETHD_OK;
}

static ethd_status check_finite(const ethd__trace_in *in, size_t row, const int *column, int count,
                                char message[ETHD_MESSAGE_MAX]) {
  for (int i = 0; i < count; i++) {
    if (ethd_csv_empty(&in->csv, row, column[i]))
      return refuse(in, row, column[i], "empty; a number is needed", message);
    if (!isfinite(cell(in, row, column[i])))
      return refuse(in, row, column[i], "not a number; a finite one is needed", message);
  }
  return ETHD_OK;
}

/* Checks that a row has a frame or none; single rays may be missing. */
static ethd_status check_frame(const ethd__trace_in *in, size_t row, char message[ETHD_MESSAGE_MAX]) {
  bool none = ethd_csv_empty(&in->csv, row, in->t_ring);
  if (!none && !(fabs(cell(in, row, in->t_ring)) <= SECONDS_MAX))
    return refuse(in, row, in->t_ring, "not a time within 9e9 s", message);
  for (int i = 0; i < ETHD_RAYS; i++)
    if (none && !ethd_csv_empty(&in->csv, row, in->rays[i]))
      return refuse(in, row, in->rays[i], "a distance without t_ring_s", message);
  return ETHD_OK;
}

/* Returns true if the device measured joint speeds in this row: both, or one of them and the other is missing. */
static bool has_speeds(const ethd__trace_in *in, size_t row) {
  return in->dq[0] >= 0 && !(ethd_csv_empty(&in->csv, row, in->dq[0]) && ethd_csv_empty(&in->csv, row, in->dq[1]));
}

static ethd_status check_row(const ethd__trace_in *in, size_t row, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = check_finite(in, row, &in->t, 1, message);
  if (status == ETHD_OK) status = check_finite(in, row, in->q, 2, message);
  if (status == ETHD_OK && has_speeds(in, row)) status = check_finite(in, row, in->dq, 2, message);
  if (status == ETHD_OK)
    status = in->ring ? check_frame(in, row, message) : check_finite(in, row, in->finger, 4, message);
  if (status != ETHD_OK) return status;
  if (!(fabs(cell(in, row, in->t)) <= SECONDS_MAX)) return refuse(in, row, in->t, "not a time within 9e9 s", message);
  if (row > 0 && !(cell(in, row, in->t) > cell(in, row - 1, in->t)))
    return refuse(in, row, in->t, "time must rise from row to row", message);
  return ETHD_OK;
}

ethd_status ethd__trace_in_read(const char *path, ethd__trace_in *out, char message[ETHD_MESSAGE_MAX]) {
  memset(out, 0, sizeof *out);
  ethd_status status = ethd_csv_read_columns(path, columns, &out->csv, message);
  if (status != ETHD_OK) return status;
  status = find_columns(out, message);
  if (status == ETHD_OK && out->csv.rows == 0) {
    snprintf(message, ETHD_MESSAGE_MAX, "%s: no rows; a trace needs at least one", path);
    status = ETHD_E_SYNTAX;
  }
  for (size_t row = 0; status == ETHD_OK && row < out->csv.rows; row++) status = check_row(out, row, message);
  if (status != ETHD_OK) ethd__trace_in_free(out);
  return status;
}

static int64_t to_ns(double t) { return (int64_t)llround(t * 1e9); }

static void take_frame(const ethd__trace_in *in, size_t row, ethd_sense *s) {
  if (ethd_csv_empty(&in->csv, row, in->t_ring)) return;
  s->have |= ETHD_HAVE_RAYS;
  s->sample_ns = to_ns(cell(in, row, in->t_ring));
  for (int i = 0; i < ETHD_RAYS; i++) s->rays[i] = cell(in, row, in->rays[i]);
}

static void take_finger(const ethd__trace_in *in, size_t row, ethd_sense *s) {
  s->have |= ETHD_HAVE_FINGER;
  for (int i = 0; i < 2; i++) {
    s->finger[i] = cell(in, row, in->finger[i]);
    s->finger_v[i] = cell(in, row, in->finger[2 + i]);
  }
}

ethd_sense ethd__trace_in_sense(const ethd__trace_in *in, size_t row) {
  ethd_sense s;
  memset(&s, 0, sizeof s);
  s.time_ns = to_ns(cell(in, row, in->t));
  for (int i = 0; i < 2; i++) s.q[i] = cell(in, row, in->q[i]);
  if (has_speeds(in, row)) {
    s.have |= ETHD_HAVE_DQ;
    for (int i = 0; i < 2; i++) s.dq[i] = cell(in, row, in->dq[i]);
  }
  if (in->ring)
    take_frame(in, row, &s);
  else
    take_finger(in, row, &s);
  return s;
}

void ethd__trace_in_free(ethd__trace_in *in) { ethd_csv_free(&in->csv); }
