#include "explain/prior.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/text.h"

#define EVEN false
#define LOG true

ethd__explain_prior ethd__explain_priors[ETHD_EXPLAIN_NUMBERS] = {
#define ROW(name, low, high, scale, unit, origin) {#name, low, high, scale, unit, origin},
    ETHD_EXPLAIN_PRIORS(ROW)
#undef ROW
};

static const char *const own_bounds = "bounds of the command line";

bool ethd__explain_bound(const char *text) {
  const char *equals = strchr(text, '='), *colon = equals ? strchr(equals, ':') : NULL;
  double low, high;
  if (!colon || !ethd__number(equals + 1, (size_t)(colon - equals - 1), &low) ||
      !ethd__number(colon + 1, strlen(colon + 1), &high) || !(low > 0 && high > low && isfinite(high)))
    return false;
  for (int n = 0; n < ETHD_EXPLAIN_NUMBERS; n++) {
    ethd__explain_prior *p = &ethd__explain_priors[n];
    if (strlen(p->name) != (size_t)(equals - text) || strncmp(text, p->name, (size_t)(equals - text)) != 0) continue;
    p->low = low;
    p->high = high;
    p->origin = own_bounds;
    return true;
  }
  return false;
}

#define RING_RADIUS 0.012
#define COUNTS 4000

/* Rounds to four digits, so that a file can hold the whole number. */
static double rounded(double value) {
  char text[32];
  snprintf(text, sizeof text, "%.4g", value);
  return strtod(text, NULL);
}

double ethd__explain_value(const ethd__explain_point *p, int n) {
  const ethd__explain_prior *prior = &ethd__explain_priors[n];
  double low = prior->low, high = prior->high, share = p->share[n];
  return rounded(prior->logarithmic ? low * pow(high / low, share) : low + (high - low) * share);
}

#define AT(name) [ETHD_EXPLAIN_##name]

/* Plants n and p with their controllers, as numbers of this search. */
static const double known[2][ETHD_EXPLAIN_NUMBERS] = {
    {AT(mass) = 0.1173,       AT(deceleration) = 45.67,  AT(friction) = 0.398,     AT(viscous) = 1.267,
     AT(delay) = 0.071e-3,    AT(ratio) = 9.8,           AT(finger_mass) = 0.0675, AT(hand_stiffness) = 284.7,
     AT(hand_damping) = 4.27, AT(pad_stiffness) = 27436, AT(pad_damping) = 1.06,   AT(finger_radius) = 7.32e-3,
     AT(latency) = 1.93e-3,   AT(start) = 31.6e-3,       AT(overshoot) = 55.5e-3,  AT(overshoot_spread) = 0.35,
     AT(speed_low) = 0.197,   AT(speed_high) = 0.521,    AT(speed_spread) = 0.19,  AT(band_low) = 0.06,
     AT(band_high) = 0.08,    AT(cutoff) = 133.4,        AT(acceleration) = 9.07,  AT(d_beta) = 1.454e-3,
     AT(motor_share) = 0.1,   AT(resonance) = 300,       AT(damping_ratio) = 0.5},
    {AT(mass) = 0.09475,       AT(deceleration) = 27.77, AT(friction) = 0.18266,    AT(viscous) = 0.03008,
     AT(delay) = 0.1213e-3,    AT(ratio) = 9.945,        AT(finger_mass) = 0.041,   AT(hand_stiffness) = 82.39,
     AT(hand_damping) = 2.568, AT(pad_stiffness) = 1e4,  AT(pad_damping) = 0.5,     AT(finger_radius) = 6.224e-3,
     AT(latency) = 1.001e-3,   AT(start) = 77.51e-3,     AT(overshoot) = 14.89e-3,  AT(overshoot_spread) = 0.5595,
     AT(speed_low) = 0.205,    AT(speed_high) = 0.4713,  AT(speed_spread) = 0.2726, AT(band_low) = 0.0339,
     AT(band_high) = 0.0577,   AT(cutoff) = 389.1,       AT(acceleration) = 22.87,  AT(d_beta) = 2.218e-3,
     AT(motor_share) = 0.1395, AT(resonance) = 88.1,     AT(damping_ratio) = 0.407}};

ethd__explain_point ethd__explain_known(const ethd__explain_structure *structure) {
  ethd__explain_point p;
  for (int n = 0; n < ETHD_EXPLAIN_NUMBERS; n++) {
    const ethd__explain_prior *prior = &ethd__explain_priors[n];
    double low = prior->low, high = prior->high, value = known[structure->compliant][n];
    double share = prior->logarithmic ? log(value / low) / log(high / low) : (value - low) / (high - low);
    p.share[n] = fmin(1, fmax(0, share));
  }
  return p;
}

#define VALUE(name) ethd__explain_value(p, ETHD_EXPLAIN_##name)

static void make_device(const ethd__explain_structure *structure, const ethd__explain_point *p, ethd_plant *out) {
  double mass = VALUE(mass), share = VALUE(motor_share), turn = 2 * M_PI * VALUE(resonance);
  double mu = mass * share * (1 - share);
  out->mass[0] = out->mass[1] = mass;
  out->force_limit = rounded(mass * VALUE(deceleration));
  out->friction = VALUE(friction);
  out->viscous = VALUE(viscous);
  out->delay = VALUE(delay);
  out->count = rounded(2 * M_PI / (COUNTS * VALUE(ratio)));
  out->count_phase = 1;
  out->motor_mass = rounded(structure->compliant ? mass * share : 0);
  out->stiffness = rounded(structure->compliant ? mu * turn * turn : (double)INFINITY);
  out->damping = rounded(structure->compliant ? 2 * VALUE(damping_ratio) * mu * turn : 0);
  out->reference = out->metrics_side = structure->compliant;
}

static void make_hand(const ethd__explain_point *p, ethd_plant *out) {
  out->finger_mass = VALUE(finger_mass);
  out->hand_stiffness = VALUE(hand_stiffness);
  out->hand_damping = VALUE(hand_damping);
  out->pad_stiffness = VALUE(pad_stiffness);
  out->pad_damping = VALUE(pad_damping);
  out->finger_radius = VALUE(finger_radius);
  out->latency = VALUE(latency);
  out->start = VALUE(start);
  out->overshoot = VALUE(overshoot);
  out->overshoot_spread = VALUE(overshoot_spread);
  out->speed_low = VALUE(speed_low);
  out->speed_high = VALUE(speed_high);
  out->speed_spread = VALUE(speed_spread);
  out->band_low = VALUE(band_low);
  out->band_high = VALUE(band_high);
}

void ethd__explain_make(const ethd_plant *base, const ethd__explain_structure *structure, const ethd__explain_point *p,
                        ethd__explain_twin *out) {
  static const char *const keys[ETHD_EXPLAIN_SETTINGS] = {
      "velocity.cutoff", "finger_filter.acceleration", "finger.radius", "finger.radius_max", "finger_filter.reference"};
  const double numbers[] = {VALUE(cutoff), VALUE(acceleration), VALUE(finger_radius), RING_RADIUS - VALUE(d_beta)};
  out->plant = *base;
  out->gain_count = ETHD_EXPLAIN_SETTINGS;
  make_device(structure, p, &out->plant);
  make_hand(p, &out->plant);
  for (int i = 0; i < ETHD_EXPLAIN_SETTINGS; i++) {
    if (i < 4)
      snprintf(out->text[i], sizeof out->text[i], "%.6g", numbers[i]);
    else
      snprintf(out->text[i], sizeof out->text[i], "%s", structure->tick ? "tick" : "sample");
    out->gains[i] = (ethd__gain){keys[i], out->text[i]};
  }
}
