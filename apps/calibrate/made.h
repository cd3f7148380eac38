/* A ring that was made up: its true laws are known, so that what a calibration finds can be judged. */
#ifndef ETHD_CALIBRATE_MADE_H
#define ETHD_CALIBRATE_MADE_H

#include "calibrate/places.h"

#define ETHD__MADE_FROM 0.5e-3 /* m: laws are compared from here */
#define ETHD__MADE_TO 9e-3

/* Gains within 15 %, exponents 3 %, offsets 12 %, darks 25 % of the typical sensor's, drawn by the seed. */
ethd__calibration ethd__made_ring(uint64_t seed);

/* The guided places, each the mean of frames whose counts have `noise` (sd). */
void ethd__made_places(const ethd__calibration *truth, uint64_t seed, double noise, int frames, double ring_radius,
                       double rod, ethd__places *out);

/* rms over all sensors and distances between a calibration and the truth, m. */
double ethd__made_error(const ethd__calibration *truth, const ethd__calibration *found);

#endif
