#include "identify/unknowns.h"

#include <math.h>
#include <string.h>

#define ROW(section, key, unit, member, scale) {section, key, unit, offsetof(ethd_plant, member), scale}

const ethd__unknown_row ethd__unknown_rows[ETHD__UNKNOWNS] = {
    [ETHD__MASS_X] = ROW("device", "mass_x", "kg", mass[0], 0),
    [ETHD__MASS_Y] = ROW("device", "mass_y", "kg", mass[1], 0),
    [ETHD__COUPLING] = ROW("device", "coupling", "kg m^2", coupling, 1e-2),
    [ETHD__FORCE_LIMIT] = ROW("device", "force_limit", "N", force_limit, 0),
    [ETHD__FRICTION] = ROW("device", "friction", "N", friction, 1),
    [ETHD__VISCOUS] = ROW("device", "viscous", "Ns/m", viscous, 1),
    [ETHD__DELAY] = ROW("device", "delay", "s", delay, 1e-3),
    [ETHD__MOTOR_MASS] = ROW("transmission", "motor_mass", "kg", motor_mass, 0),
    [ETHD__STIFFNESS] = ROW("transmission", "stiffness", "N/m", stiffness, 0),
    [ETHD__DAMPING] = ROW("transmission", "damping", "Ns/m", damping, 1),
};

double ethd__unknown_value(const ethd_plant *plant, ethd__unknown which) {
  double value;
  memcpy(&value, (const char *)plant + ethd__unknown_rows[which].offset, sizeof value);
  return value;
}

void ethd__unknown_set(ethd_plant *plant, ethd__unknown which, double value) {
  memcpy((char *)plant + ethd__unknown_rows[which].offset, &value, sizeof value);
}

double ethd__unknown_to(ethd__unknown which, double value) {
  double scale = ethd__unknown_rows[which].scale;
  return scale > 0 ? value / scale : log(value);
}

double ethd__unknown_from(ethd__unknown which, double coordinate) {
  double scale = ethd__unknown_rows[which].scale;
  return scale > 0 ? coordinate * scale : exp(coordinate);
}

void ethd__chosen_get(const ethd__chosen *chosen, const ethd_plant *plant, double *out) {
  for (int i = 0; i < chosen->count; i++)
    out[i] = ethd__unknown_to(chosen->at[i], ethd__unknown_value(plant, chosen->at[i]));
}

void ethd__chosen_set(const ethd__chosen *chosen, const double *coordinates, ethd_plant *plant) {
  for (int i = 0; i < chosen->count; i++)
    ethd__unknown_set(plant, chosen->at[i], ethd__unknown_from(chosen->at[i], coordinates[i]));
}

void ethd__chosen_drop(ethd__chosen *chosen, ethd__unknown which) {
  int kept = 0;
  for (int i = 0; i < chosen->count; i++)
    if (chosen->at[i] != which) chosen->at[kept++] = chosen->at[i];
  chosen->count = kept;
}
