/* `ethd-conform --probe`: measures a bus with a drive. */
#ifndef ETHD__APPS_CONFORM_PROBE_H
#define ETHD__APPS_CONFORM_PROBE_H

#include <stdbool.h>

typedef struct ethd__probe_def {
  const char *map;  /* register map of the drive */
  const char *port; /* instead of the map's; NULL: the map's */
  double duration;  /* s, of the measurement */
  double period;    /* s, of the loop that uses the bus */
  double by_hand;   /* s, for turning the joints by hand; 0: not done */
  bool watchdog;    /* enable at zero torque, and see whether silence disables the drive */
} ethd__probe_def;

/* Connects, measures and prints; exits with one line on failure. [main] */
void ethd__probe(const ethd__probe_def *def);

#endif
