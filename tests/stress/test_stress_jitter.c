/* Ticks that come at odd instants, and ticks that never come.

     jitter       A position taken j late is off by w j, which is white noise of sd w sigma on it. Estimators make of
                  it, times w sigma / T: difference sqrt 2, lowpass sqrt(2 a^2 / (2 - a)), lsq of n samples
                  sqrt(12 / (n (n^2 - 1))).
     lost ticks   Fades keep to seconds, and a loop stays stable. */
#include <math.h>
#include <string.h>

#include "stress/mass.h"
#include "unit/draw.h"

#define PERIOD 0.001
#define SPEED 2.0 /* rad/s */

static void prepare(ethd_velocity_method method, double value, ethd_velocity *out) {
  double p[ETHD_PARAMS_MAX] = {0};
  ethd_error error;
  const ethd_method *m = &ethd_velocity_methods[method];
  ethd_params_default(m->params, m->param_count, p);
  if (value > 0) p[0] = value;
  ck_assert_int_eq(ethd_velocity_prepare(method, p, PERIOD, out, &error), ETHD_OK);
}

static void jitter(ethd_velocity_method method, double value, double gain) {
  ethd_velocity velocity;
  ethd_velocity_state state;
  const double most = 50e-6; /* s, uniform to both sides */
  int64_t ticks = pick(100000, 4000000);
  double sum = 0;
  prepare(method, value, &velocity);
  memset(&state, 0, sizeof state);
  for (int64_t k = 0; k < ticks; k++) {
    double t = (double)k * PERIOD + most * (2 * draw((uint64_t)k, 0, 1) - 1);
    double off = ethd_velocity_step(&velocity, &state, SPEED * t, 0, PERIOD) - SPEED;
    if (k > 200) sum += off * off;
  }
  near(sqrt(sum / (double)(ticks - 201)), SPEED * most / sqrt(3) * gain / PERIOD, 0.02,
       "%s: rms noise of a constant speed, 50 us of jitter", ethd_velocity_methods[method].id);
}

/* A swap's difference fades by seconds: tau = tau_new + delta (1 - t / swap_time). */
static void fade(void) {
  mass_rig r;
  ethd_error error;
  mass_open(&r, 0.3, -0.001);
  ethd_setup_transition(&r.on.setup, &ethd_transition_smooth);
  r.measured = 1;
  mass_start(&r, 0);
  mass_step(&r);
  double before = r.on.trace.tau[0], after = before * 2, most = 0;
  rig_set(&r.on.setup, "contact.k_e", 2 * ethd_setup_get(&r.on.setup, "contact.k_e"));
  if (ethd_control_post(r.on.control, &r.on.setup, &error) < 0) return;
  mass_step(&r);
  for (int t = 0, k = 0; t <= 30; k++) {
    int64_t skip = (int64_t)floor(3 * draw((uint64_t)k, 0, 1));
    r.missed = skip;
    t += 1 + (int)skip;
    double share = fmax(0, 1 - t * PERIOD / r.on.setup.swap_time);
    mass_step(&r);
    most = fmax(most, fabs(r.on.trace.tau[0] - (after + share * (before - after))));
  }
  bound(most, 1e-9, "a swap's fade with lost ticks: torque off the line");
  mass_close(&r);
}

/* A tenth of the ticks lost, gains at a third of the boundary of a loop that is three times as slow. */
static void closed(void) {
  const double mass = 0.3, slow = 3 * PERIOD, b = 2 * mass / slow / 6, k = b / slow / 3;
  mass_rig r;
  mass_open(&r, mass, -10 / k);
  ethd_setup_velocity(&r.on.setup, ETHD_VELOCITY_DIFFERENCE);
  ethd_setup_transition(&r.on.setup, &ethd_transition_smooth);
  rig_set(&r.on.setup, "contact.k_e", k);
  rig_set(&r.on.setup, "contact.b_e", b);
  rig_set(&r.on.setup, "transition.v_hysteresis", 1);
  r.push.x = -10;
  mass_start(&r, 1e-3);
  double first = 0, last = 0;
  for (uint64_t i = 0; i < 4000; i++) {
    if (i == 0 || draw(i, 0, 1) >= 0.1) mass_step(&r);
    mass_move(&r);
    double speed = fabs(mass_speed(&r));
    if (i < 50) first = fmax(first, speed);
    if (i >= 3950) last = fmax(last, speed);
  }
  bound(last, 1e-6 * first, "a tenth of the ticks lost: what is left of a swing of 1 mm/s");
  mass_close(&r);
}

TEST(test_jitter) {
  double a = 1 - exp(-2 * M_PI * 130 * PERIOD);
  jitter(ETHD_VELOCITY_DIFFERENCE, 0, sqrt(2));
  jitter(ETHD_VELOCITY_LOWPASS, 130, sqrt(2 * a * a / (2 - a)));
  jitter(ETHD_VELOCITY_LSQ, 8, sqrt(12 / (8.0 * 63)));
  fade();
  closed();
}
