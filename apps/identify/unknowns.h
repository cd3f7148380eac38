/* The arm's parameters in a plant, which a fit may change. Each has a coordinate that is scaled so that equal steps
   have equal effect. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_UNKNOWNS_H
#define ETHD__APPS_IDENTIFY_UNKNOWNS_H

#include <stddef.h>

#include "ethd/sim.h"

typedef enum ethd__unknown {
  ETHD__MASS_X,
  ETHD__MASS_Y,
  ETHD__COUPLING,
  ETHD__FORCE_LIMIT,
  ETHD__FRICTION,
  ETHD__VISCOUS,
  ETHD__DELAY,
  ETHD__MOTOR_MASS, /* these three only with an elastic transmission */
  ETHD__STIFFNESS,
  ETHD__DAMPING,
  ETHD__UNKNOWNS
} ethd__unknown;

/* The unknowns that a fit changes, in the order of the table. */
typedef struct ethd__chosen {
  ethd__unknown at[ETHD__UNKNOWNS];
  int count;
} ethd__chosen;

typedef struct ethd__unknown_row {
  const char *section, *key, *unit;
  size_t offset;
  double scale; /* the coordinate is value / scale; 0: it is the logarithm */
} ethd__unknown_row;

extern const ethd__unknown_row ethd__unknown_rows[ETHD__UNKNOWNS];

double ethd__unknown_value(const ethd_plant *plant, ethd__unknown which);
void ethd__unknown_set(ethd_plant *plant, ethd__unknown which, double value);

/* A value as a coordinate, and back; an infinite value has no coordinate. */
double ethd__unknown_to(ethd__unknown which, double value);
double ethd__unknown_from(ethd__unknown which, double coordinate);

/* Fills the coordinates of a plant; fills a plant with these coordinates. */
void ethd__chosen_get(const ethd__chosen *chosen, const ethd_plant *plant, double *out);
void ethd__chosen_set(const ethd__chosen *chosen, const double *coordinates, ethd_plant *plant);

/* Removes an unknown from the chosen ones; its number then stays as it is. */
void ethd__chosen_drop(ethd__chosen *chosen, ethd__unknown which);

#endif
