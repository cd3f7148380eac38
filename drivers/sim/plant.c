#include "sim/plant.h"

#include <stdio.h>
#include <string.h>

#include "finger/zones.h"
#include "sim/sensors.h"
#include "text/text.h"

#define AT(member) offsetof(ethd_plant, member)
#define ROW(section, key, unit, min, max, member, brief) \
  {{key, unit, min, max, (double)NAN, brief}, AT(member), section}

const ethd__key_row ethd__plant_rows[] = {
    ROW("device", "mass_x", "kg", 1e-3, 1e3, mass[0], "effective mass at the ring in x: joint 1"),
    ROW("device", "mass_y", "kg", 1e-3, 1e3, mass[1], "effective mass at the ring in y: joint 2"),
    ROW("device", "coupling", "kg m^2", -1e3, 1e3, coupling, "factor H of the inertia coupling H cos(th2 - th1)"),
    ROW("device", "force_limit", "N", 0, 1e6, force_limit, "torque limit of each joint / L"),
    ROW("device", "friction", "N", 0, 1e3, friction,
        "Coulomb friction f_c at the ring, in f_c tanh(v / 3 mm/s) + b_v v"),
    ROW("device", "viscous", "Ns/m", 0, 1e3, viscous, "viscous friction b_v at the ring"),
    ROW("device", "delay", "s", 0, 1, delay, "time from measurement to torque, at most eight periods"),
    ROW("device", "count", "rad", 0, 1, count, "joint angle of one encoder count; 0: no quantisation"),
    ROW("device", "count_phase", "zero|drawn", 0, 1, count_phase,
        "encoder phase: zero, or random for each tap and joint"),
    ROW("transmission", "motor_mass", "kg", 0, 1e3, motor_mass, "part of the mass on the motor's side"),
    ROW("transmission", "stiffness", "N/m", 1, INFINITY, stiffness,
        "stiffness of the transmission at the ring; inf: rigid"),
    ROW("transmission", "damping", "Ns/m", 0, 1e6, damping, "damping of the transmission at the ring"),
    ROW("finger", "mass", "kg", 1e-3, 1e3, finger_mass, "moving mass of the finger"),
    ROW("finger", "hand_stiffness", "N/m", 0, 1e6, hand_stiffness,
        "stiffness of the hand about its voluntary path, in x and y"),
    ROW("finger", "hand_damping", "Ns/m", 0, 1e6, hand_damping,
        "damping of the hand about its voluntary path, in x and y"),
    ROW("finger", "pad_stiffness", "N/m", 0, 1e7, pad_stiffness, "stiffness K of the pad, in K p (1 + c p_dot)"),
    ROW("finger", "pad_damping", "s/m", 0, 1e3, pad_damping, "damping c of the pad, in K p (1 + c p_dot)"),
    ROW("finger", "radius", "m", 1e-4, 1, finger_radius, "mean radius of the finger over the taps"),
    ROW("finger", "radius_sd", "m", 0, 1, finger_radius_sd, "cut at 2 sd"),
    ROW("proximity", "reading", "centre|rays", 0, 1, reading,
        "content of a reading: the finger's centre, or 16 distances"),
    ROW("proximity", "rate", "Hz", 1, 1e5, rate, "rate of the readings"),
    ROW("proximity", "latency", "s", 0, 1, latency, "time from a reading's last sample to its delivery"),
    ROW("proximity", "noise", "m", 0, 0.1, noise, "sd of a centre, in x and in y"),
    ROW("proximity", "reference", "ring|motor", 0, 1, reference,
        "reference of a reading: the ring's true position or the encoders'"),
    ROW("proximity", "ray_noise", "m", 0, 0.1, ray_noise, "sd of a distance"),
    ROW("proximity", "ray_skew", "s", 0, 0.1, ray_skew, "time from the first distance of a frame to the last"),
    ROW("movement", "start", "m", 0, 10, start,
        "distance from the start to the place where the ring would meet the wall"),
    ROW("movement", "start_sd", "m", 0, 10, start_sd, "cut at 2 sd"),
    ROW("movement", "overshoot", "m", 0, 10, overshoot, "factor O of the target's depth O exp(s g) behind the wall"),
    ROW("movement", "overshoot_spread", "1", 0, 2, overshoot_spread,
        "spread s of the target's depth; g is normal, cut at 2"),
    ROW("movement", "profile", "constant|minimum-jerk", 0, 1, profile, "profile of the hand's speed"),
    ROW("movement", "ramp_up", "s", 0, 10, ramp_up,
        "duration of the rise to speed V, by V (1 - cos)/2, with profile constant"),
    ROW("movement", "ramp_down", "s", 0, 10, ramp_down, "duration of the fall from V to 0, with profile constant"),
    ROW("movement", "lateral_sd", "m", 0, 1, lateral_sd, "sd of the path's y, cut at 2 sd"),
    ROW("movement", "speed_low", "m/s", 1e-3, 100, speed_low,
        "low speed of the path where the ring would meet the wall"),
    ROW("movement", "speed_high", "m/s", 1e-3, 100, speed_high,
        "high speed of the path where the ring would meet the wall"),
    ROW("movement", "speed_spread", "1", 0, 0.39, speed_spread, "coefficient of variation, cut at 2.5 sd"),
    ROW("study", "side", "ring|motor", 0, 1, metrics_side, "where speeds are measured: at the ring or at the encoders"),
    ROW("study", "band_low", "m/s", 0, 10, band_low,
        "half width of the band about 0.2 m/s in which a low tap is valid"),
    ROW("study", "band_high", "m/s", 0, 10, band_high,
        "half width of the band about 0.4 m/s in which a high tap is valid"),
};
const size_t ethd__plant_row_count = sizeof ethd__plant_rows / sizeof *ethd__plant_rows;

ethd_status ethd__sim_refuse(ethd_error *error, ethd_status status, const char *name, double found, double min,
                             double max) {
  if (!error) return status;
  memset(error, 0, sizeof *error);
  error->status = status;
  snprintf(error->name, sizeof error->name, "%s", name);
  error->found = found;
  error->min = min;
  error->max = max;
  return status;
}

/* ---- checks ---- */

static double value_of(const ethd__key_row *row, const ethd_plant *plant) {
  const char *at = (const char *)plant + row->offset;
  int32_t choice;
  double number;
  memcpy(&choice, at, sizeof choice);
  memcpy(&number, at, sizeof number);
  return strchr(row->param.unit, '|') ? choice : number;
}

static ethd_status check_row(const ethd__key_row *row, const ethd_plant *plant, ethd_error *error) {
  const ethd_param *p = &row->param;
  double value = value_of(row, plant);
  char name[sizeof error->name];
  if (ethd__is_within(value, p->min, p->max)) return ETHD_OK;
  snprintf(name, sizeof name, "%s.%s", row->section, p->name);
  return ethd__sim_refuse(error, isnan(value) ? ETHD_E_NOT_FINITE : ETHD_E_RANGE, name, value, p->min, p->max);
}

/* Refuses a value of `name` outside [min, max]. */
static ethd_status within(ethd_error *error, const char *name, double found, double min, double max) {
  return ethd__is_within(found, min, max) ? ETHD_OK : ethd__sim_refuse(error, ETHD_E_RANGE, name, found, min, max);
}

static ethd_status check_finger(const ethd_plant *p, ethd_error *error) {
  ethd_status status = within(error, "finger", p->reading, 0, ETHD_READING_COUNT - 1);
  if (!status && p->reading == ETHD_READING_ZONES) {
    status = within(error, "zones", p->zones, ETHD__ZONES_MIN, ETHD__ZONES_MAX);
    if (!status) status = within(error, "zone_reach", p->zone_reach, 1e-5, 0.1);
    if (!status) status = within(error, "zone_hysteresis", p->zone_hysteresis, 0, 1);
  }
  if (!status && p->reading == ETHD_READING_NAIL) {
    status = within(error, "nail_angle", p->nail_angle, -7, 7);
    if (!status) status = within(error, "nail_step", p->nail_step, 0, 1e-3);
  }
  return status;
}

ethd_status ethd__plant_check(const ethd_plant *p, ethd_error *error) {
  ethd_status status = ETHD_OK;
  ethd_plant filed = *p;
  if (p->reading > ETHD_READING_RAYS) filed.reading = ETHD_READING_CENTRE; /* no plant file describes the others */
  for (size_t i = 0; i < ethd__plant_row_count && !status; i++) status = check_row(&ethd__plant_rows[i], &filed, error);
  if (!status) status = check_finger(p, error);
  if (status) return status;
  double least = fmin(p->mass[0], p->mass[1]), frame = p->reading == ETHD_READING_RAYS ? p->ray_skew : 0;
  if (p->stiffness < INFINITY) {
    status = within(error, "transmission.motor_mass", p->motor_mass, 1e-3 * least, (1 - 1e-3) * least);
    if (status) return status;
  }
  status = within(error, "finger.radius_sd", p->finger_radius_sd, 0, (1 - 1e-3) * p->finger_radius / 2);
  if (status) return status;
  status = within(error, "proximity.ray_skew", frame, 0, (1 - 1e-6) / p->rate);
  if (status) return status;
  return within(error, "proximity.latency", p->latency, 0, (ETHD__READINGS_MAX - 2) / p->rate - frame);
}

/* The inertia matrix of the links' side must be positive definite. */
static ethd_status check_inertia(const ethd_sim_def *def, ethd_error *error) {
  const ethd_plant *p = &def->plant;
  double own = p->stiffness < INFINITY ? p->motor_mass : 0, l = def->arm.link1 * def->arm.link2;
  double most = 0.999 * l * sqrt((p->mass[0] - own) * (p->mass[1] - own));
  return within(error, "device.coupling", p->coupling, -most, most);
}

ethd_status ethd__sim_check(const ethd_sim_def *def, ethd_error *error) {
  const ethd_plant *p = &def->plant;
  ethd_status status = ethd__plant_check(p, error);
  if (!status) status = ethd_arm_check(&def->arm, error);
  if (!status) status = check_inertia(def, error);
  if (!status) status = within(error, "period", def->period, 1e-6, 1);
  if (!status) status = within(error, "step", def->step, 1e-7, 1);
  if (!status) status = within(error, "tolerance", def->tolerance, 1e-14, INFINITY);
  if (!status) status = within(error, "device.delay", p->delay, 0, ETHD_SIM_DELAY_PERIODS * def->period);
  if (!status) status = within(error, "ring.radius", def->ring_radius, p->finger_radius + 2 * p->finger_radius_sd, 10);
  return status;
}

/* An effective mass along a wall's normal leaves out a coupling, which few fitted plants have. */
ethd_dynamics ethd_plant_dynamics(const ethd_plant *plant) {
  return (ethd_dynamics){{plant->mass[0], plant->mass[1]}, plant->friction, plant->viscous, plant->delay};
}
