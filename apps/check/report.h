/* Prints ethd-check's page, section by section. All [main]. */
#ifndef ETHD__APPS_CHECK_REPORT_H
#define ETHD__APPS_CHECK_REPORT_H

#include <stdbool.h>

#include "bounds/loops.h"
#include "ethd/config.h"
#include "ethd/driver.h"

/* Prints the setup as a configuration that gives the same setup again. */
void ethd__report_setup(const ethd_config *config);

/* Data of the device; NaN: not known. */
typedef struct ethd__figures {
  ethd__bounds_device loop; /* the device in its loops; only stability includes an elastic transmission */
  double force[2];          /* N: torque limit / L, along x and y */
  double latency;           /* s, of the readings of the finger */
  char delay_is[160];       /* source of the delay if it was not given; empty: given */
} ethd__figures;

typedef struct ethd__subject {
  const ethd_config *config;
  ethd__figures device;
  ethd__bounds_felt felt; /* of tracking at the ring; NaN: unknown law or out of reach */
} ethd__subject;

/* Prints the drivers' remarks and the effective limits, of an arm in space its figures. is_open: the device itself was
   read. */
void ethd__report_drivers(const ethd_config *config, ethd_device *device, bool is_open);

/* Sets the delay if no option, driver or plant gives it. With an open device it measures the longest spacing of
   samples. Otherwise, or if too few samples come, it uses the longest spacing that the limits allow. `figures` says
   which. Nothing is enabled. */
void ethd__find_delay(const ethd_setup *setup, ethd_device *device, bool is_open, ethd__figures *figures);

/* Fills `felt`, and prints what is known. */
void ethd__report_device(ethd__subject *subject);

/* Prints the margins of every loop of a setup on a device, a row a number; returns how many loops are unstable.
   ethd-tune prints its choice by it, too. */
int ethd__report_stability(const ethd_setup *setup, const ethd__bounds_device *device);

/* Prints the margin of the guard's stop, and the time that it takes; returns how many bounds are exceeded. */
int ethd__report_guard(const ethd_setup *setup, const ethd__bounds_device *device);

/* Prints a line for each loop whose law's gains aren't known, so that a missing row isn't read as stable. */
void ethd__report_unjudged(const ethd_setup *setup);

/* Each prints its section and returns how many bounds are exceeded. */
int ethd__report_passivity(const ethd__subject *subject);
int ethd__report_stop(const ethd__subject *subject);
int ethd__report_threshold(const ethd__subject *subject);
int ethd__report_tick(const ethd__subject *subject);

/* Prints the distance before a wall at which the device has to react, and whether the gap is enough; returns how many
   bounds are exceeded. `device` says what it can do before the setup's [ability] does; NULL: there is none. */
int ethd__report_space(const ethd_space_setup *setup, const ethd_device *device);

/* Writes the velocity estimator as "lowpass, cutoff 133.4 Hz". */
void ethd__velocity_text(const ethd_setup *setup, char *out, size_t room);

#endif
