/* Judges from which speed on the finger touches before the ring meets the wall. [main] */
#ifndef ETHD__APPS_TAP_EARLY_H
#define ETHD__APPS_TAP_EARLY_H

#include "tap/claims.h"

/* The paper says from 0.5 m/s on; 0.4 to 0.6 counts as that. The threshold is the commanded speed that misjudges the
   fewest taps when all above it are called early. People are drawn, then their taps; p is the share of draws on the
   worse side of the bounds. */
void ethd__early_claim(const ethd__sample *sample, ethd__tap_claim *out);

#endif
