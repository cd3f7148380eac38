#include "calibrate/places.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "ethd/maths.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

#define RADIUS_MAX 1.0 /* m */

ethd_vec ethd__place_at(double ring_radius, double rod, int i) {
  double sine, cosine, r = i ? ring_radius - rod : 0;
  ethd_sincos(6.28318530717958648 * (i - 1) / ETHD_RAYS, &sine, &cosine);
  return (ethd_vec){r * cosine, r * sine};
}

bool ethd__places_add(ethd__places *p, ethd_vec at, const double counts[ETHD_RAYS]) {
  if (p->count == ETHD__PLACES_MAX) return false;
  p->at[p->count] = at;
  p->readings[p->count] = ethd__place_expected(p->ring_radius, p->rod, at);
  memcpy(p->readings[p->count].counts, counts, ETHD_RAYS * sizeof *counts);
  p->count++;
  return true;
}

/* ---- fits ---- */

static ethd__calibration with_darks(const ethd__places *p) {
  ethd__calibration c = ethd__calibration_default();
  for (int k = 0; k < ETHD_RAYS; k++) c.sensors[k].dark = p->dark[k];
  return c;
}

ethd_status ethd__places_fit(const ethd__places *p, ethd__level level, ethd__calibration *out,
                             char message[ETHD_MESSAGE_MAX]) {
  *out = with_darks(p);
  return ethd__calibration_fit(level, (ethd__place_readings){p->readings, p->count}, out, message);
}

double ethd__places_left_out(const ethd__places *p, ethd__level level) {
  char message[ETHD_MESSAGE_MAX];
  ethd__place_reading others[ETHD__PLACES_MAX];
  double sum = 0;
  size_t counted = 0;
  for (size_t i = 0; i < p->count; i++) {
    ethd__calibration c = with_darks(p);
    memcpy(others, p->readings, i * sizeof *others);
    memcpy(others + i, p->readings + i + 1, (p->count - i - 1) * sizeof *others);
    if (ethd__calibration_fit(level, (ethd__place_readings){others, p->count - 1}, &c, message)) return (double)NAN;
    double e = ethd__calibration_error(&c, (ethd__place_readings){p->readings + i, 1}, -1);
    if (isnan(e)) continue;
    sum += e * e;
    counted++;
  }
  return counted ? sqrt(sum / (double)counted) : (double)NAN;
}

/* ---- files ---- */

static const char header[] = "x_m,y_m,rod_m,ring_m,c0,c1,c2,c3,c4,c5,c6,c7,c8,c9,c10,c11,c12,c13,c14,c15";

static void put_row(ethd_csv_out *out, const ethd__places *p, ethd_vec at, double rod, const double counts[ETHD_RAYS]) {
  ethd_csv_number(out, at.x);
  ethd_csv_number(out, at.y);
  ethd_csv_number(out, rod);
  ethd_csv_number(out, p->ring_radius);
  for (int k = 0; k < ETHD_RAYS; k++) ethd_csv_number(out, counts[k]);
  ethd_csv_row(out);
}

ethd_status ethd__places_save(const ethd__places *p, const char *path, char message[ETHD_MESSAGE_MAX]) {
  ethd_csv_out *out = ethd_csv_create(path, header, message);
  if (!out) return ETHD_E_FILE;
  put_row(out, p, (ethd_vec){0, 0}, 0, p->dark);
  for (size_t i = 0; i < p->count; i++) put_row(out, p, p->at[i], p->rod, p->readings[i].counts);
  return ethd_csv_close(out, message);
}

enum { X, Y, ROD, RING, C0, COLUMNS = C0 + ETHD_RAYS };

static ethd_status columns(const ethd_csv *csv, const char *const *names, int out[COLUMNS], char *message) {
  for (int i = 0; i < COLUMNS; i++)
    if ((out[i] = ethd_csv_column(csv, names[i])) < 0)
      return ethd__say(message, ETHD_E_ARGUMENT, "%s:1: the column %s is missing; %s are needed", csv->path, names[i],
                       header);
  return ETHD_OK;
}

static ethd_status take_row(const ethd_csv *csv, size_t row, const int at[COLUMNS], ethd__places *p, char *message) {
  double v[COLUMNS];
  for (int i = 0; i < COLUMNS; i++) v[i] = csv->values[row * csv->columns + (size_t)at[i]];
  bool lengths = fabs(v[X]) < RADIUS_MAX && fabs(v[Y]) < RADIUS_MAX && v[RING] > 0 && v[RING] < RADIUS_MAX &&
                 v[ROD] >= 0 && v[ROD] < v[RING];
  if (!lengths || (row == 0) != (v[ROD] == 0) || (row > 0 && v[RING] != p->ring_radius) ||
      (row > 1 && v[ROD] != p->rod))
    return ethd__say(
        message, ETHD_E_RANGE,
        "%s:%zu: the empty ring, rod_m 0, comes first, then one rod in the same ring, each shorter than 1 m", csv->path,
        ethd_csv_line(row));
  for (int k = 0; k < ETHD_RAYS; k++) {
    bool absent = row == 0 && isnan(v[C0 + k]);
    if (!absent && !(v[C0 + k] >= 0 && v[C0 + k] <= ETHD__FRAME_SATURATED))
      return ethd__say(message, ETHD_E_RANGE, "%s:%zu: c%d: found %g, 0 to 65535 is allowed", csv->path,
                       ethd_csv_line(row), k, v[C0 + k]);
  }
  p->ring_radius = v[RING];
  p->rod = v[ROD];
  if (row == 0)
    memcpy(p->dark, v + C0, sizeof p->dark);
  else if (!ethd__places_add(p, (ethd_vec){v[X], v[Y]}, v + C0))
    return ethd__say(message, ETHD_E_FULL, "%s:%zu: over %d places", csv->path, ethd_csv_line(row), ETHD__PLACES_MAX);
  return ETHD_OK;
}

ethd_status ethd__places_load(const char *path, ethd__places *out, char message[ETHD_MESSAGE_MAX]) {
  static const char *const names[] = {"x_m", "y_m", "rod_m", "ring_m", "c0",  "c1",  "c2",  "c3",  "c4",  "c5", "c6",
                                      "c7",  "c8",  "c9",    "c10",    "c11", "c12", "c13", "c14", "c15", NULL};
  int at[COLUMNS];
  ethd_csv csv;
  memset(out, 0, sizeof *out);
  ethd_status status = ethd_csv_read_columns(path, names, &csv, message);
  if (status) return status;
  status = columns(&csv, names, at, message);
  for (size_t row = 0; row < csv.rows && !status; row++) status = take_row(&csv, row, at, out, message);
  if (!status && csv.rows < 2)
    status = ethd__say(message, ETHD_E_ARGUMENT, "%s: %zu row%s; the empty ring and places are needed", path, csv.rows,
                       ethd__s(csv.rows));
  ethd_csv_free(&csv);
  return status;
}
