/* What a fit may change of a plant: the numbers of arm and finger, each with a coordinate in which steps are alike.
   All [main]. */
#ifndef ETHD_APPS_IDENTIFY_UNKNOWNS_H
#define ETHD_APPS_IDENTIFY_UNKNOWNS_H

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
  ETHD__MOTOR_MASS, /* these three only with a transmission that gives way */
  ETHD__STIFFNESS,
  ETHD__DAMPING,
  ETHD__FINGER_MASS, /* from here on of the finger: touches show them */
  ETHD__HAND_STIFFNESS,
  ETHD__HAND_DAMPING,
  ETHD__PAD_STIFFNESS,
  ETHD__PAD_DAMPING,
  ETHD__UNKNOWNS
} ethd__unknown;

/* Those that a fit changes, in the order of the table. */
typedef struct ethd__chosen {
  ethd__unknown at[ETHD__UNKNOWNS];
  int count;
} ethd__chosen;

typedef struct ethd__unknown_row {
  const char *section, *key, *unit;
  size_t offset;
  double scale; /* of the coordinate value / scale; 0: the coordinate is the logarithm */
} ethd__unknown_row;

extern const ethd__unknown_row ethd__unknown_rows[ETHD__UNKNOWNS];

double ethd__unknown_value(const ethd_plant *plant, ethd__unknown which);
void ethd__unknown_set(ethd_plant *plant, ethd__unknown which, double value);

/* The value as a coordinate, and back; infinite ones have none. */
double ethd__unknown_to(ethd__unknown which, double value);
double ethd__unknown_from(ethd__unknown which, double coordinate);

/* A plant's coordinates, and a plant with these. */
void ethd__chosen_get(const ethd__chosen *chosen, const ethd_plant *plant, double *out);
void ethd__chosen_set(const ethd__chosen *chosen, const double *coordinates, ethd_plant *plant);

/* Takes one out; what isn't chosen stays as it is. */
void ethd__chosen_drop(ethd__chosen *chosen, ethd__unknown which);

#endif
