/* Fingers for the filters: reaches and recorded movements, read at 300 Hz with noise and latency, in ticks of 1 kHz. */
#ifndef ETHD_TESTS_BENCH_TRACKS_H
#define ETHD_TESTS_BENCH_TRACKS_H

#include <stddef.h>

#define ETHD__TRACK_PERIOD 1e-3 /* s */
#define ETHD__TRACK_NOISE 1e-4  /* m, sd of a reading, each axis */

enum { ETHD__TRACK_MAX = 100000 }; /* ticks */

/* One movement, cut if it is longer. */
typedef struct ethd__track {
  size_t count;    /* ticks */
  double (*in)[3]; /* each tick's reading x y and its age, NaN if it has none */
  double (*truth)[2];
} ethd__track;

typedef struct ethd__tracks {
  ethd__track *at;
  size_t count;
} ethd__tracks;

/* Makes minimum-jerk reaches of 0.1 to 0.3 m with peak speeds of 0.5 to 1.1 m/s and 50 ms of rest before and after. */
ethd__tracks ethd__tracks_reaches(size_t count, double latency);

/* Reads the recorded movements of ethd__motion_folder, a set for each folder, at most `room`. Returns the number of
   sets. */
size_t ethd__tracks_recorded(double latency, ethd__tracks *out, size_t room);

void ethd__tracks_free(ethd__tracks *tracks);

#endif
