/* Fits a calibration to readings of a rod at known positions in the ring. */
#ifndef ETHD__PROXIMITY_RING_CALIBRATION_FIT_H
#define ETHD__PROXIMITY_RING_CALIBRATION_FIT_H

#include "proximity_ring/calibration.h"

/* The mean counts of many frames, and the distances that follow from the rod's position; NaN if a ray meets no
   object. */
typedef struct ethd__place_reading {
  double counts[ETHD_RAYS]; /* 0: missing; at the ceiling: left out */
  double distance[ETHD_RAYS];
} ethd__place_reading;

typedef struct ethd__place_readings {
  const ethd__place_reading *at;
  size_t count;
} ethd__place_readings;

/* Returns the distances to a rod of radius `rod` whose centre is at `centre` from the ring's. [any] */
ethd__place_reading ethd__place_expected(double ring_radius, double rod, ethd_vec centre);

/* Fits `level` to readings above the darks in *calibration, by least squares of the distance, and fills laws and
   residuals. Refuses, in a sentence, sensors with too few readings: under 4 that are neither missing nor
   saturated, 2 for gain and table. [main] */
ETHD_MUST_CHECK ethd_status ethd__calibration_fit(ethd__level level, ethd__place_readings readings,
                                                  ethd__calibration *calibration, char message[ETHD_MESSAGE_MAX]);

/* Returns the rms of the distance errors over one sensor's readings, or all (sensor -1), m; NaN if there are none.
   [any] */
double ethd__calibration_error(const ethd__calibration *calibration, ethd__place_readings readings, int sensor);

#endif
