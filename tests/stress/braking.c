/* B_max: the largest stable damping of a free ring, B_d of the braking state with each estimator.

   A push makes the ring creep, so that its estimated speed never falls below v_th and it goes on braking. The push
   begins with the braking, which bears it from the first tick on. */
#include <math.h>

#include "stress/curve.h"
#include "stress/rig.h"
#include "stress/stress.h"

#define MASS 0.1173
#define PERIOD 0.001
#define CREEP 2e-3 /* m/s */
#define SWING 1e-6 /* m a tick: at most half of the creep */

/* Coasts into the wall, long enough for the estimator; the tick at which braking begins is done. */
static void enter(ethd__stress_rig *rig, double damping) {
  ethd__stress_rig_start(rig, CREEP);
  while (ethd__stress_rig_step(rig)->state != ETHD_BRAKING) ethd__stress_rig_move(rig);
  ethd__stress_rig_push(rig, (ethd_vec){-CREEP * damping, 0});
  ethd__stress_rig_move(rig);
  rig->w[0] += SWING / 10 / PERIOD / rig->setup.arm.link1;
}

static double growth(const ethd__curve *c, double damping) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, MASS, 0.2 * CREEP);
  ethd__stress_rig_velocity(&rig, c->method, c->value);
  ethd__stress_rig_brakes(&rig, damping, 1e-6);
  rig.delay = c->delay;
  enter(&rig, damping);
  ethd__swing swing = {.order = 2, .settle = 100, .span = 400, .floor = 1e-6 * SWING, .ceiling = SWING};
  double rate = ethd__stress_rig_growth(&rig, &swing);
  ethd__stress_rig_close(&rig);
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

static void run(ethd__stress_log *log) {
  static const struct {
    const char *name;
    ethd_velocity_method method;
    double value;
  } estimators[] = {{"difference", ETHD_VELOCITY_DIFFERENCE, 0},
                    {"lowpass 130 Hz", ETHD_VELOCITY_LOWPASS, 130},
                    {"lowpass 20 Hz", ETHD_VELOCITY_LOWPASS, 20},
                    {"lsq of 8", ETHD_VELOCITY_LSQ, 8}};
  for (size_t i = 0; i < sizeof estimators / sizeof *estimators; i++)
    for (int n = 0; n <= 2; n++) {
      ethd__curve c = {MASS, PERIOD, n, estimators[i].method, estimators[i].value};
      double k, largest;
      ethd__curve_at(&c, ethd__curve_end(&c), &k, &largest);
      ethd__stress_near(log, "Ns/m", found(&c, largest), largest, 5e-3, "%s, n = %d: largest B_d", estimators[i].name,
                        n);
      if (c.method == ETHD_VELOCITY_DIFFERENCE)
        ethd__stress_near(log, "Ns/m", found(&c, largest), 2 * MASS / PERIOD * tan(M_PI / (4 * (n + 1))), 5e-3,
                          "the same by (2m/T) tan(pi/(4(n+1))), n = %d", n);
      if (c.method == ETHD_VELOCITY_LOWPASS && n == 0)
        ethd__stress_near(log, "Ns/m", found(&c, largest), 2 * MASS / PERIOD, 5e-3,
                          "a low-pass doesn't lower it: 2m/T");
      ethd__stress_bound(log, "1", growth(&c, 0.98 * largest), 0, "2 %% under: growth a tick");
      ethd__stress_bound(log, "1", -growth(&c, 1.02 * largest), 0, "2 %% over: decay a tick");
    }
}

const ethd__stress ethd__stress_braking = {"braking", "the largest B_d of a free ring", run};
