/* A simulated ring with known true laws, to judge the result of a calibration. */
#ifndef ETHD__APPS_CALIBRATE_MADE_H
#define ETHD__APPS_CALIBRATE_MADE_H

#include "calibrate/places.h"

#define ETHD__MADE_FROM 0.5e-3 /* m: laws are compared from here */
#define ETHD__MADE_TO 9e-3

/* Makes a ring with gains within 15 %, exponents 3 %, offsets 12 % and darks 25 % of the typical sensor's, drawn by the
   seed. */
ethd__calibration ethd__made_ring(uint64_t seed);

/* Makes the guided places, each the mean of frames whose counts have `noise` (sd). */
void ethd__made_places(const ethd__calibration *truth, uint64_t seed, double noise, int frames, double ring_radius,
                       double rod, ethd__places *out);

/* Returns the rms difference, m, between a calibration and the truth, over all sensors and distances. */
double ethd__made_error(const ethd__calibration *truth, const ethd__calibration *found);

#endif
