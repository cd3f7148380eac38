#include "explain/prior.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define EVEN false
#define LOG true

const ethd__explain_prior ethd__explain_priors[ETHD_EXPLAIN_NUMBERS] = {
#define ROW(name, low, high, scale, unit, origin) {#name, low, high, scale, unit, origin},
    ETHD_EXPLAIN_PRIORS(ROW)
#undef ROW
};

#define RING_RADIUS 0.012
#define COUNTS 4000

/* To four digits, so that files say all of a number. */
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
