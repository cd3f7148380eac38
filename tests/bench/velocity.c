/* Joint speed from encoder counts: error at a constant speed and while braking, and ns a step. */
#include <math.h>
#include <string.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "ethd/ethd.h"
#include "unit/draw.h"

#define T 1e-3      /* s */
#define LINK 0.25   /* m */
#define STEADY 0.03 /* m/s */
#define V_END 0.020 /* m/s: braking counts until 3 ms after the ring is as slow */

/* Braking, as plant n does it: force saturated down to v1, then damped by B_d. */
#define MASS 0.1173 /* kg */
#define F_SAT 5.357 /* N */
#define F_C 0.398   /* N */
#define B_D 100.0   /* Ns/m */
#define V0 0.4      /* m/s */

enum { RUNS_MAX = 2000, BEFORE = 100, AFTER = 60, TICKS = BEFORE + AFTER, LONG = 2000 };

static const double count = 2 * M_PI / 48000; /* rad: 4000 counts a motor turn, ratio 12 */
static const double a = (F_SAT + F_C) / MASS, v1 = F_SAT / B_D, tau = MASS / B_D;

/* ---- braking from t = 0 on, at the ring ---- */

static double speed_at(double t) {
  double t1 = (V0 - v1) / a;
  return t <= 0 ? V0 : t <= t1 ? V0 - a * t : v1 * exp(-(t - t1) / tau);
}

static double position_at(double t) {
  double t1 = (V0 - v1) / a, x1 = (V0 + v1) / 2 * t1;
  return t <= 0 ? V0 * t : t <= t1 ? (V0 - a * t / 2) * t : x1 + tau * (v1 - speed_at(t));
}

static double still_from(void) { return (V0 - v1) / a + tau * log(v1 / V_END); }

static double torque_at(double t) { return t <= 0 ? 0 : -LINK * fmin(F_SAT, B_D * speed_at(t)); }

static double encoder(double x, double phase) { return count * rint(x / LINK / count + phase); }

/* ---- contenders ---- */

typedef struct contender {
  const char *family;
  ethd_velocity_method method;
  double p[3];
  int with_torque;
  ethd_velocity v;
  char name[32];
} contender;

static contender all[] = {
    {"difference", ETHD_VELOCITY_DIFFERENCE, {0}, 0, {0}, ""},
    {"lowpass", ETHD_VELOCITY_LOWPASS, {20}, 0, {0}, ""},
    {"lowpass", ETHD_VELOCITY_LOWPASS, {50}, 0, {0}, ""},
    {"lowpass", ETHD_VELOCITY_LOWPASS, {130}, 0, {0}, ""},
    {"lowpass", ETHD_VELOCITY_LOWPASS, {300}, 0, {0}, ""},
    {"lsq", ETHD_VELOCITY_LSQ, {4}, 0, {0}, ""},
    {"lsq", ETHD_VELOCITY_LSQ, {8}, 0, {0}, ""},
    {"lsq", ETHD_VELOCITY_LSQ, {16}, 0, {0}, ""},
    {"foaw", ETHD_VELOCITY_FOAW, {8, 132e-6}, 0, {0}, ""},
    {"foaw", ETHD_VELOCITY_FOAW, {16, 132e-6}, 0, {0}, ""},
    {"foaw", ETHD_VELOCITY_FOAW, {32, 132e-6}, 0, {0}, ""},
    {"kalman", ETHD_VELOCITY_KALMAN, {38e-6, 20, MASS *LINK *LINK}, 0, {0}, ""},
    {"kalman", ETHD_VELOCITY_KALMAN, {38e-6, 50, MASS *LINK *LINK}, 0, {0}, ""},
    {"kalman", ETHD_VELOCITY_KALMAN, {38e-6, 200, MASS *LINK *LINK}, 0, {0}, ""},
    {"kalman with torque", ETHD_VELOCITY_KALMAN, {38e-6, 5, MASS *LINK *LINK}, 1, {0}, ""},
    {"kalman with torque", ETHD_VELOCITY_KALMAN, {38e-6, 20, MASS *LINK *LINK}, 1, {0}, ""},
    {"kalman with torque", ETHD_VELOCITY_KALMAN, {38e-6, 50, MASS *LINK *LINK}, 1, {0}, ""},
};
enum { ESTIMATORS = sizeof all / sizeof *all };

static void prepare(contender *c) {
  ethd_error error;
  double p[ETHD_PARAMS_MAX] = {c->p[0], c->p[1], c->p[2]};
  if (ethd_velocity_prepare(c->method, p, T, &c->v, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  double shown = c->method == ETHD_VELOCITY_KALMAN ? c->p[1] : c->p[0];
  if (shown > 0)
    snprintf(c->name, sizeof c->name, "%s %g", c->family, shown);
  else
    snprintf(c->name, sizeof c->name, "%s", c->family);
}

/* ---- what is measured ---- */

static double steady(const contender *c, int runs) {
  double sum = 0;
  for (int run = 0; run < runs; run++) {
    ethd_velocity_state s;
    double phase = draw((uint64_t)run, 0, 1);
    memset(&s, 0, sizeof s);
    for (int k = 0; k < LONG; k++) {
      double v = LINK * ethd_velocity_step(&c->v, &s, encoder(STEADY * T * k, phase), 0, T);
      if (k >= BEFORE) sum += (v - STEADY) * (v - STEADY);
    }
  }
  return sqrt(sum / ((double)runs * (LONG - BEFORE)));
}

/* Measures braking, which starts anywhere between two ticks. The error counts from then until the ring has been still
   for 3 ms. */
static double braking(const contender *c, int runs) {
  double sum = 0, ticks = 0;
  for (int run = 0; run < runs; run++) {
    ethd_velocity_state s;
    double phase = draw(2 * (uint64_t)run, 0, 1), within = draw(2 * (uint64_t)run + 1, 0, 1);
    memset(&s, 0, sizeof s);
    for (int k = 0; k < TICKS; k++) {
      double t = (k - BEFORE - within) * T, torque = c->with_torque ? torque_at(t - T / 2) : 0;
      double v = LINK * ethd_velocity_step(&c->v, &s, encoder(position_at(t), phase), torque, T);
      if (t < 0 || t > still_from() + 3e-3) continue;
      sum += (v - speed_at(t)) * (v - speed_at(t));
      ticks += 1;
    }
  }
  return sqrt(sum / ticks);
}

static void work(void *data) {
  const contender *c = data;
  static double q[LONG];
  ethd_velocity_state s;
  if (q[LONG - 1] == 0)
    for (int k = 0; k < LONG; k++) q[k] = encoder(0.02 * sin(0.01 * k), 0.3);
  memset(&s, 0, sizeof s);
  double sum = 0;
  for (int k = 0; k < LONG; k++) sum += ethd_velocity_step(&c->v, &s, q[k], 0, T);
  bench_sink = sum;
}

void bench_velocity(const char *folder, int quick) {
  bench_entry entries[ESTIMATORS];
  for (int i = 0; i < ESTIMATORS; i++) {
    prepare(&all[i]);
    entries[i] = (bench_entry){all[i].name, work, &all[i], LONG, 0};
  }
  bench_race(entries, ESTIMATORS, quick ? 0.1 : 1);
  FILE *csv =
      bench_csv(folder, "velocity",
                "# encoder of 48000 counts a joint turn, read every ms; error: rms, m/s at the ring, 0.25 m from the\n"
                "# joint, at 30 mm/s and from 0.4 m/s to rest as plant n does it (49 m/s^2, then 1.17 ms)\n",
                BENCH_RACE);
  printf("velocity: encoder of 48000 counts a turn at 1 kHz, a count a tick is %.1f mm/s at the ring\n",
         1e3 * count * LINK / T);
  printf("  rms error, mm/s               ns   at 30 mm/s     braking     lag, ms\n");
  for (int i = 0; i < ESTIMATORS; i++) {
    const double at_30 = steady(&all[i], quick ? 20 : 200), while_braking = braking(&all[i], quick ? 300 : RUNS_MAX);
    bench_row(csv, "at 30 mm/s: error in m/s", all[i].family, entries[i].ns, at_30);
    bench_row(csv, "braking: error in m/s", all[i].family, entries[i].ns, while_braking);
    printf("  %-24s %6.1f %12.2f %12.1f %10.2f\n", all[i].name, entries[i].ns, 1e3 * at_30, 1e3 * while_braking,
           1e3 * ethd_velocity_lag(&all[i].v));
  }
  bench_close();
}
