/* B_max: the largest stable damping of a free ring, B_d of the braking state with each estimator.

   A push makes the ring creep, so that its estimated speed never falls below v_th and it goes on braking. The push
   begins with the braking, which bears it from the first tick on. */
#include <math.h>

#include "stress/curve.h"
#include "stress/mass.h"

#define MASS 0.1173
#define PERIOD 0.001
#define CREEP 2e-3 /* m/s */
#define SWING 1e-6 /* m a tick: at most half of the creep */

/* Coasts into the wall, long enough for the estimator; the tick at which braking begins is done. */
static void enter(mass_rig *r, double damping) {
  mass_start(r, CREEP);
  while (mass_step(r)->state != ETHD_BRAKING) mass_move(r);
  mass_push(r, (ethd_vec){-CREEP * damping, 0});
  mass_move(r);
  r->w[0] += SWING / 10 / PERIOD / r->on.setup.arm.link1;
}

static double growth(const ethd__curve *c, double damping) {
  mass_rig r;
  mass_open(&r, MASS, 0.2 * CREEP);
  mass_velocity(&r, c->method, c->value);
  mass_brakes(&r, damping, 1e-6);
  r.delay = c->delay;
  enter(&r, damping);
  swing_span swing = {.order = 2, .settle = 100, .span = 400, .floor = 1e-6 * SWING, .ceiling = SWING};
  double rate = mass_growth(&r, &swing);
  mass_close(&r);
  return rate;
}

static double found(const ethd__curve *c, double about) {
  double low = 0.8 * about, high = 1.2 * about;
  while (high / low > 1 + 2e-4) {
    double middle = (low + high) / 2;
    if (growth(c, middle) > 0)
      high = middle;
    else
      low = middle;
  }
  return (low + high) / 2;
}

TEST(test_braking) {
  for (int i = 0; i < CURVE_ESTIMATORS; i++)
    for (int n = 0; n <= 2; n++) {
      ethd__curve c = {MASS, PERIOD, n, curve_estimators[i].method, curve_estimators[i].value};
      double k, largest;
      ethd__curve_at(&c, ethd__curve_end(&c), &k, &largest);
      near(found(&c, largest), largest, 5e-3, "%s, n = %d: largest B_d", curve_estimators[i].name, n);
      if (c.method == ETHD_VELOCITY_DIFFERENCE)
        near(found(&c, largest), 2 * MASS / PERIOD * tan(M_PI / (4 * (n + 1))), 5e-3,
             "the same by (2m/T) tan(pi/(4(n+1))), n = %d", n);
      if (c.method == ETHD_VELOCITY_LOWPASS && n == 0)
        near(found(&c, largest), 2 * MASS / PERIOD, 5e-3, "a low-pass doesn't lower it: 2m/T");
      bound(growth(&c, 0.98 * largest), 0, "2 %% under: growth a tick");
      bound(-growth(&c, 1.02 * largest), 0, "2 %% over: decay a tick");
    }
}
