/* Measures step by step, guided on the terminal, with a ring on its port. */
#ifndef ETHD__APPS_CALIBRATE_GUIDED_H
#define ETHD__APPS_CALIBRATE_GUIDED_H

#include "calibrate/places.h"

typedef struct ethd__guided_options {
  const char *port;
  uint32_t baud;
  int frames;              /* of one place */
  double ring_radius, rod; /* m */
  const char *record;      /* CSV file, written after every step; NULL: none */
} ethd__guided_options;

/* Asks on stdout and reads answers from stdin: Enter measures, s skips the place, b goes back one, q ends. Fails with a
   message when the line is lost or the input ends early. */
ETHD_MUST_CHECK ethd_status ethd__guided_run(const ethd__guided_options *options, ethd__places *out,
                                             char message[ETHD_MESSAGE_MAX]);

#endif
