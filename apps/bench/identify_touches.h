/* A whole fit of finger, hand and pad to taps. */
#ifndef ETHD__APPS_BENCH_IDENTIFY_TOUCHES_H
#define ETHD__APPS_BENCH_IDENTIFY_TOUCHES_H

#include <stddef.h>
#include <stdint.h>

/* Records so many taps at each of two speeds on this plant, below `folder` for as long as it takes, and fits them with
   the plant's arm. Returns the simulated seconds per CPU second; fills the latter, and how many touches there are. */
double ethd__bench_touches(const char *plant, uint64_t taps, const char *folder, double *seconds, size_t *touches);

#endif
