/* A hand that is led while the simulation runs: a recorded path whose samples are written shortly before they
   are reached. Between the pointer and the hand lie HAND_LEAD samples, 18 ms; a low-pass takes out the
   pointer's whole pixels. One thread. */
#ifndef ETHD_SCREEN_HAND_H
#define ETHD_SCREEN_HAND_H

#include "ethd/sim.h"

#define ETHD_HAND_STEP 0.006 /* s between samples */
#define ETHD_HAND_LEAD 3     /* samples: what the path's slopes look at, and one */

typedef struct ethd__hand {
  ethd_path_sample *samples;
  size_t count, written; /* written: from here on all are the last one */
  ethd_vec smooth;
} ethd__hand;

/* Stands at x for `seconds` unless it is led. ETHD_E_MEMORY. */
ETHD_MUST_CHECK ethd_status ethd__hand_create(ethd__hand *hand, ethd_vec x, double seconds);
void ethd__hand_free(ethd__hand *hand);

ethd_path ethd__hand_path(const ethd__hand *hand);

/* Before the step that begins at t: the pointer is at x now. */
void ethd__hand_lead(ethd__hand *hand, double t, ethd_vec x);

#endif
