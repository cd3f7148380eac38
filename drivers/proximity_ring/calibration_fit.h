/* A calibration from readings of a rod at known places in the ring. */
#ifndef ETHD_PROXIMITY_RING_CALIBRATION_FIT_H
#define ETHD_PROXIMITY_RING_CALIBRATION_FIT_H

#include "proximity_ring/calibration.h"

/* The mean counts of many frames, and the distances that rod and place give: NaN where a ray meets nothing. */
typedef struct ethd__place_reading {
  double counts[ETHD_RAYS]; /* 0: missing; at the ceiling: left out */
  double distance[ETHD_RAYS];
} ethd__place_reading;

typedef struct ethd__place_readings {
  const ethd__place_reading *at;
  size_t count;
} ethd__place_readings;

/* Where the rod of radius `rod` stands: its centre, relative to the ring's. [any] */
ethd__place_reading ethd__place_expected(double ring_radius, double rod, ethd_vec centre);

/* Fits `level` to readings above the darks in *calibration, by least squares of the distance, and fills laws and
   residuals. Refuses, in a sentence, sensors with too few readings: under 4 that are neither missing nor
   saturated, 2 for gain and table. [main] */
ETHD_MUST_CHECK ethd_status ethd__calibration_fit(ethd__level level, ethd__place_readings readings,
                                                  ethd__calibration *calibration, char message[ETHD_MESSAGE_MAX]);

/* rms of distance error over one sensor's readings, or all of them (sensor -1), m; NaN without any. [any] */
double ethd__calibration_error(const ethd__calibration *calibration, ethd__place_readings readings, int sensor);

#endif
