/* What ethd-check says, section by section. All [main]. */
#ifndef ETHD_APPS_CHECK_REPORT_H
#define ETHD_APPS_CHECK_REPORT_H

#include <stdbool.h>

#include "ethd/config.h"

/* The setup as it was understood, as a configuration that gives the same setup again. */
void ethd__report_setup(const ethd_config *config);

/* What is known of the device; NaN: not known. Index 0: along x, 1: along y. */
typedef struct ethd__figures {
  double mass[2];           /* kg at the ring */
  double force[2];          /* N: torque limit / L */
  double friction, viscous; /* N, Ns/m at the ring */
  double delay;             /* s, from measurement to torque */
  double count;             /* rad per encoder count at the joint; 0: ideal */
  double latency;           /* s, of the readings of the finger */
  bool compliant;           /* 1: between motors and ring something gives way, which only stability counts: */
  double motor_mass;        /* kg on the motor's side; */
  double spring, damper;    /* N/m, Ns/m at the ring */
} ethd__figures;

typedef struct ethd__subject {
  const ethd_config *config;
  ethd__figures device;
  double k[2], d[2]; /* N/m, Ns/m: tracking as it is felt at the ring; NaN: unknown law or out of reach */
} ethd__subject;

/* What the device's drivers say: their remarks, and the limits that rule. is_open: the device itself was asked. */
void ethd__report_drivers(const ethd_config *config, const ethd_driver *driver, void *device, bool is_open);

/* Fills k and d, and prints what is known. */
void ethd__report_device(ethd__subject *subject);

/* Each prints its section and returns how many bounds are exceeded. */
int ethd__report_stability(const ethd__subject *subject);
int ethd__report_passivity(const ethd__subject *subject);
int ethd__report_stop(const ethd__subject *subject);
int ethd__report_threshold(const ethd__subject *subject);
int ethd__report_tick(const ethd__subject *subject);

/* "lowpass, cutoff 133.4 Hz" */
void ethd__velocity_text(const ethd_setup *setup, char *out, size_t room);

#endif
