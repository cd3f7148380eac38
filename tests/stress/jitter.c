/* Ticks that come at odd instants, and ticks that never come.

     jitter       A position taken j late is off by w j, which is white noise of sd w sigma on it. Estimators make of
                  it, times w sigma / T: difference sqrt 2, lowpass sqrt(2 a^2 / (2 - a)), lsq of n samples
                  sqrt(12 / (n (n^2 - 1))).
     lost ticks   A constant speed stays what it is; caps and fades keep to seconds. */
#include <math.h>
#include <string.h>

#include "cli/cli.h"
#include "sim/random.h"
#include "stress/rig.h"
#include "stress/stress.h"

#define PERIOD 0.001
#define SPEED 2.0 /* rad/s */
#define KEY ((ethd__sim_key){1, 1})

static double draw(uint64_t i) { return ethd__uniform(KEY, ETHD__STREAM_ENCODER, (uint32_t)i); }

static void prepare(ethd_velocity_method method, double value, ethd_velocity *out) {
  double p[ETHD_PARAMS_MAX] = {0};
  ethd_error error;
  const ethd_method *m = &ethd_velocity_methods[method];
  ethd_params_default(m->params, m->param_count, p);
  if (value > 0) p[0] = value;
  if (ethd_velocity_prepare(method, p, PERIOD, out, &error) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", error.name);
}

static void jitter(ethd__stress_log *log, ethd_velocity_method method, double value, double gain) {
  ethd_velocity velocity;
  ethd_velocity_state state;
  const double most = 50e-6; /* s, uniform to both sides */
  int64_t ticks = ethd__stress_pick(log, 100000, 400000, 4000000);
  double sum = 0;
  prepare(method, value, &velocity);
  memset(&state, 0, sizeof state);
  for (int64_t k = 0; k < ticks; k++) {
    double t = (double)k * PERIOD + most * (2 * draw((uint64_t)k) - 1);
    double off = ethd_velocity_step(&velocity, &state, SPEED * t, 0, PERIOD) - SPEED;
    if (k > 200) sum += off * off;
  }
  ethd__stress_near(log, "rad/s", sqrt(sum / (double)(ticks - 201)), SPEED * most / sqrt(3) * gain / PERIOD, 0.02,
                    "%s: rms noise of a constant speed, 50 us of jitter", ethd_velocity_methods[method].id);
}

/* 0 to 5 ticks lost again and again. */
static void lost(ethd__stress_log *log, ethd_velocity_method method) {
  ethd_velocity velocity;
  ethd_velocity_state state;
  double t = 0, most = 0;
  prepare(method, 0, &velocity);
  memset(&state, 0, sizeof state);
  for (uint64_t k = 0; k < 3000; k++) {
    double dt = (1 + floor(6 * draw(k))) * PERIOD;
    t += dt;
    double off = ethd_velocity_step(&velocity, &state, SPEED * t, 0, dt) - SPEED;
    if (k > 1000) most = fmax(most, fabs(off));
  }
  ethd__stress_bound(log, "rad/s", most, 1e-8, "%s: off a constant speed, 0 to 5 ticks lost each time",
                     ethd_velocity_methods[method].id);
}

/* Only t_max ends this braking, while ticks are lost at random: it ends with the first tick at or after t_max. */
static void cap(ethd__stress_log *log, uint64_t seed) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, 0.3, -1e-9);
  rig.setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  ethd__stress_set(&rig.setup, "transition.eps_max", (double)INFINITY);
  rig.measured = 1;
  rig.push.x = -10;
  ethd__stress_rig_start(&rig, 0.1);
  ethd__stress_rig_tick(&rig);
  int64_t due = 0;
  for (uint64_t i = 0; rig.trace.state == ETHD_BRAKING && i < 1000; i++) {
    int64_t skip = (int64_t)floor(4 * draw(1000 * seed + i));
    while (skip-- > 0) ethd__stress_rig_move(&rig);
    if (!due && rig.tick >= 50) due = rig.tick;
    ethd__stress_rig_tick(&rig);
  }
  ethd__stress_within(log, "ticks", (double)(rig.tick - 1), (double)due, 0,
                      "t_max = 50 ms with lost ticks: braking ends at");
  ethd__stress_rig_close(&rig);
}

/* A swap's difference fades by seconds: tau = tau_new + delta (1 - t / swap_time). */
static void fade(ethd__stress_log *log) {
  ethd__stress_rig rig;
  ethd_error error;
  ethd__stress_rig_open(&rig, 0.3, -0.001);
  ethd_setup_transition(&rig.setup, &ethd_transition_smooth);
  rig.measured = 1;
  ethd__stress_rig_start(&rig, 0);
  ethd__stress_rig_step(&rig);
  double before = rig.trace.tau[0], after = before * 2, most = 0;
  ethd__stress_set(&rig.setup, "contact.k_e", 2 * ethd_setup_get(&rig.setup, "contact.k_e"));
  if (ethd_control_post(rig.control, &rig.setup, &error) < 0) return;
  ethd__stress_rig_step(&rig);
  for (int t = 0, k = 0; t <= 30; k++) {
    int64_t skip = (int64_t)floor(3 * draw((uint64_t)k));
    rig.missed = skip;
    t += 1 + (int)skip;
    double share = fmax(0, 1 - t * PERIOD / rig.setup.swap_time);
    ethd__stress_rig_step(&rig);
    most = fmax(most, fabs(rig.trace.tau[0] - (after + share * (before - after))));
  }
  ethd__stress_bound(log, "Nm", most, 1e-9, "a swap's fade with lost ticks: torque off the line");
  ethd__stress_rig_close(&rig);
}

/* A tenth of the ticks lost, gains at a third of the boundary of a loop that is three times as slow. */
static void closed(ethd__stress_log *log) {
  const double mass = 0.3, slow = 3 * PERIOD, b = 2 * mass / slow / 6, k = b / slow / 3;
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, mass, -10 / k);
  ethd_setup_velocity(&rig.setup, ETHD_VELOCITY_DIFFERENCE);
  ethd_setup_transition(&rig.setup, &ethd_transition_smooth);
  ethd__stress_set(&rig.setup, "contact.k_e", k);
  ethd__stress_set(&rig.setup, "contact.b_e", b);
  ethd__stress_set(&rig.setup, "transition.v_hysteresis", 1);
  rig.push.x = -10;
  ethd__stress_rig_start(&rig, 1e-3);
  double first = 0, last = 0;
  for (uint64_t i = 0; i < 4000; i++) {
    if (i == 0 || draw(i) >= 0.1) ethd__stress_rig_step(&rig);
    ethd__stress_rig_move(&rig);
    double speed = fabs(ethd__stress_rig_speed(&rig));
    if (i < 50) first = fmax(first, speed);
    if (i >= 3950) last = fmax(last, speed);
  }
  ethd__stress_bound(log, "m/s", last, 1e-6 * first, "a tenth of the ticks lost: what is left of a swing of 1 mm/s");
  ethd__stress_rig_close(&rig);
}

static void run(ethd__stress_log *log) {
  double a = 1 - exp(-2 * M_PI * 130 * PERIOD);
  jitter(log, ETHD_VELOCITY_DIFFERENCE, 0, sqrt(2));
  jitter(log, ETHD_VELOCITY_LOWPASS, 130, sqrt(2 * a * a / (2 - a)));
  jitter(log, ETHD_VELOCITY_LSQ, 8, sqrt(12 / (8.0 * 63)));
  for (int m = 0; m < ETHD_VELOCITY_COUNT; m++) lost(log, (ethd_velocity_method)m);
  for (uint64_t seed = 0; seed < 20; seed++) cap(log, seed);
  fade(log);
  closed(log);
}

const ethd__stress ethd__stress_jitter = {"jitter", "jitter of the sample instants, and lost ticks", run};
