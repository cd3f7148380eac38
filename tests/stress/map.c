/* The map of stable gains: contact law kelvin-voigt in the sampled loop over K_e and B_e, for delays and
   masses. Every cell over 2 % away from the closed form's curve must be on its side. */
#include <math.h>

#include "stress/curve.h"
#include "stress/rig.h"
#include "stress/stress.h"

#define PERIOD 0.001
#define SWING 1e-6 /* m a tick */
#define K_LOW 1e2
#define K_HIGH 1e6
#define B_LOW 1.0
#define B_HIGH 1e3

/* How much larger than (K, B) the gains on the curve are: over 1 inside, 0 where no gains are stable.
   Along the curve B/K rises from T (n + 1/2) on. */
static double margin(const ethd__curve *c, double end, double K, double B) {
  double low = 0, high = end, k, b;
  if (B / K <= c->period * (c->delay + 0.5)) return 0;
  for (int i = 0; i < 60; i++) {
    double middle = (low + high) / 2;
    ethd__curve_at(c, middle, &k, &b);
    if (k > 0 && b / k < B / K)
      low = middle;
    else
      high = middle;
  }
  ethd__curve_at(c, low, &k, &b);
  return k / K;
}

static double growth(const ethd__curve *c, double k, double b) {
  ethd__stress_rig rig;
  double most = 10 * SWING, push = 20 * most * (k + b / PERIOD);
  ethd__stress_rig_open(&rig, c->mass, -push / k);
  ethd__stress_rig_velocity(&rig, c->method, c->value);
  ethd_setup_transition(&rig.setup, &ethd_transition_smooth);
  ethd__stress_set(&rig.setup, "contact.k_e", k);
  ethd__stress_set(&rig.setup, "contact.b_e", b);
  ethd__stress_set(&rig.setup, "transition.v_hysteresis", 1);
  rig.delay = c->delay;
  rig.push.x = -push;
  ethd__stress_rig_start(&rig, SWING / PERIOD);
  ethd__swing swing = {.order = 1, .settle = 500, .span = 500, .floor = 1e-5 * SWING, .ceiling = most};
  double rate = ethd__stress_rig_growth(&rig, &swing);
  ethd__stress_rig_close(&rig);
  return rate;
}

typedef struct map_tally {
  int64_t cells, judged, wrong, stable;
} map_tally;

static void fill(FILE *data, const ethd__curve *c, const char *name, int cells, map_tally *t) {
  double end = ethd__curve_end(c);
  for (int i = 0; i < cells; i++)
    for (int j = 0; j < cells; j++) {
      double k = K_LOW * pow(K_HIGH / K_LOW, (i + 0.5) / cells), b = B_LOW * pow(B_HIGH / B_LOW, (j + 0.5) / cells);
      double rate = growth(c, k, b), m = margin(c, end, k, b);
      t->cells++;
      t->stable += rate < 0;
      if (m < 0.98 || m > 1.02) {
        t->judged++;
        t->wrong += (rate < 0) != (m > 1);
      }
      if (data)
        fprintf(data, "%s,%d,%.17g,%.17g,%.17g,%d,%.17g\n", name, c->delay, c->mass, k, b, rate < 0,
                fmax(-10, fmin(10, rate)));
    }
}

/* Densely at the end, where K falls to 0. */
static void draw_curve(FILE *data, const ethd__curve *c, const char *name) {
  double end = ethd__curve_end(c), k, b;
  for (int i = 1; data && i < 400; i++) {
    double left = 1 - i / 400.0, th = end * (1 - left * left);
    ethd__curve_at(c, th, &k, &b);
    fprintf(data, "%s,%d,%.17g,%.17g,%.17g,%.17g\n", name, c->delay, c->mass, th, k, b);
  }
}

static void run(ethd__stress_log *log) {
  static const double masses[] = {0.1, 0.3};
  static const struct {
    const char *name;
    ethd_velocity_method method;
    double value;
  } estimators[] = {{"difference", ETHD_VELOCITY_DIFFERENCE, 0}, {"lowpass", ETHD_VELOCITY_LOWPASS, 130}};
  int cells = (int)ethd__stress_pick(log, 10, 50, 50);
  FILE *map = ethd__stress_data(log, "map.csv", "velocity,delay_ticks,mass_kg,k_npm,b_nspm,stable,growth_per_tick");
  FILE *curve = ethd__stress_data(log, "map_curve.csv", "velocity,delay_ticks,mass_kg,th_rad,k_npm,b_nspm");
  for (int e = 0; e < 2; e++)
    for (int m = 0; m < 2; m++)
      for (int n = 0; n <= 2; n++) {
        ethd__curve c = {masses[m], PERIOD, n, estimators[e].method, estimators[e].value};
        map_tally t = {0};
        fill(map, &c, estimators[e].name, cells, &t);
        draw_curve(curve, &c, estimators[e].name);
        ethd__stress_within(log, "cells", (double)t.wrong, 0, 0, "%s, %g kg, n = %d: cells on the curve's wrong side",
                            estimators[e].name, c.mass, n);
      }
  ethd__stress_close(map);
  ethd__stress_close(curve);
}

const ethd__stress ethd__stress_map = {"map", "which K_e, B_e, delay and mass are stable", run};
