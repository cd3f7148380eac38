/* A calibration's raw data: counts of the sensors in the empty ring and with a rod at known places. */
#ifndef ETHD__APPS_CALIBRATE_PLACES_H
#define ETHD__APPS_CALIBRATE_PLACES_H

#include <stdbool.h>

#include "proximity_ring/calibration_fit.h"

enum { ETHD__PLACES_MAX = 64, ETHD__PLACES_GUIDED = 1 + ETHD_RAYS };

typedef struct ethd__places {
  double ring_radius, rod; /* m */
  double dark[ETHD_RAYS];  /* counts */
  size_t count;
  ethd_vec at[ETHD__PLACES_MAX]; /* the rod's centre, relative to the ring's, m */
  ethd__place_reading readings[ETHD__PLACES_MAX];
} ethd__places;

/* Returns guided place i: 0 is the middle, i > 0 touches the ring at sensor i - 1. */
ethd_vec ethd__place_at(double ring_radius, double rod, int i);

/* Adds a place with mean counts, unless the table is full. */
bool ethd__places_add(ethd__places *places, ethd_vec at, const double counts[ETHD_RAYS]);

/* Makes a calibration: the default one with the places' darks, fitted to `level`. */
ETHD_MUST_CHECK ethd_status ethd__places_fit(const ethd__places *places, ethd__level level, ethd__calibration *out,
                                             char message[ETHD_MESSAGE_MAX]);

/* Returns the rms error, m, at places that were left out of the fit one by one; NaN: a fit failed. */
double ethd__places_left_out(const ethd__places *places, ethd__level level);

/* Save and load a CSV: x_m,y_m,rod_m,ring_m,c0..c15; the first row, with rod_m 0, is the empty ring. */
ETHD_MUST_CHECK ethd_status ethd__places_save(const ethd__places *places, const char *path,
                                              char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__places_load(const char *path, ethd__places *out, char message[ETHD_MESSAGE_MAX]);

#endif
