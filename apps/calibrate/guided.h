/* Step by step, on the terminal, with a ring on its port. */
#ifndef ETHD_CALIBRATE_GUIDED_H
#define ETHD_CALIBRATE_GUIDED_H

#include "calibrate/places.h"

typedef struct ethd__guided_options {
  const char *port;
  uint32_t baud;
  int frames;              /* of one place */
  double ring_radius, rod; /* m */
  const char *record;      /* kept after every step; NULL: nowhere */
} ethd__guided_options;

/* Asks on stdout, hears on stdin: Enter measures, s skips the place, b goes back one, q ends. Fails in a sentence
   when the line goes or the input ends early. */
ETHD_MUST_CHECK ethd_status ethd__guided_run(const ethd__guided_options *options, ethd__places *out,
                                             char message[ETHD_MESSAGE_MAX]);

#endif
