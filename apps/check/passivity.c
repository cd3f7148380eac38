/* Passivity of the wall, and the encoder's count against v_th. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bounds/stability.h"
#include "check/report.h"

/* These conditions are sufficient, not necessary: if they fail, no bound counts as exceeded. */
int ethd__report_passivity(const ethd__subject *s) {
  const ethd_setup *setup = &s->config->setup;
  ethd__bounds_gains wall;
  if (!ethd__bounds_gains_of(setup, ETHD_LOOP_WALL, &wall) || !*wall.stiffness_key) return 0;
  const double K = wall.stiffness, B = wall.damping;
  double T = setup->period, b = s->device.loop.viscous, fc = s->device.loop.friction;
  double count = s->device.loop.count * fmax(setup->arm.link1, setup->arm.link2);
  ethd__sampled_loop loop = {.period = T, .stiffness = K, .damping = B};
  double needed = ethd__sampled_passive_friction(&loop);
  printf("\npassivity    sufficient for any hand, not necessary: a stable wall may fail it\n");
  printf("  Colgate and Schenkel     b > K_e T/2 + B_e = %.4g Ns/m of friction", needed);
  if (isnan(b))
    printf("; give --viscous\n");
  else if (b > needed)
    printf("; the device has %.4g: passive\n", b);
  else
    printf("; the device has %.4g: not passive%s%s%s\n", b, B > 0 ? " (less " : "", B > 0 ? wall.damping_key : "",
           B > 0 ? " counts most)" : "");
  printf("  Abbott and Okamura       K_e <= min(2 b/T, 2 f_c/Delta)");
  if (isnan(b) || isnan(fc) || isnan(count)) {
    printf("; give --viscous, --friction and --counts\n");
    return 0;
  }
  double held = 2 * b / T, counted = count > 0 ? 2 * fc / count : INFINITY;
  printf(" = min(%.4g, %.4g) N/m; K_e is %.4g: %s\n", held, counted, K,
         K <= fmin(held, counted) ? "met"
         : held < counted         ? "not met; more viscous friction or a shorter loop.period"
                                  : "not met; a finer encoder or more friction");
  return 0;
}

/* Returns the largest speed that the estimator gives after a ring at rest moves by one encoder count. */
static double answer(const ethd_setup *setup, double count) {
  ethd_velocity velocity;
  ethd_velocity_state state;
  double most = 0;
  memset(&state, 0, sizeof state);
  if (ethd_velocity_prepare(setup->velocity, setup->velocity_p, setup->period, &velocity, NULL) < 0) return NAN;
  for (int k = 0; k < 4000; k++) {
    double speed = ethd_velocity_step(&velocity, &state, k < 3000 ? 0 : count, 0, setup->period);
    if (k >= 3000) most = fmax(most, fabs(speed));
  }
  return most;
}

static const char *smoother(const ethd_setup *setup) {
  switch (setup->velocity) {
  case ETHD_VELOCITY_LOWPASS: return "a lower velocity.cutoff";
  case ETHD_VELOCITY_KALMAN: return "a lower velocity.acceleration";
  case ETHD_VELOCITY_DIFFERENCE: return "a velocity.method that averages";
  default: return "a longer velocity.window";
  }
}

int ethd__report_threshold(const ethd__subject *s) {
  const ethd_setup *setup = &s->config->setup;
  double v_th = ethd_setup_get(setup, "transition.v_th");
  double link = fmax(setup->arm.link1, setup->arm.link2), count = s->device.loop.count;
  char velocity[96];
  if (isnan(v_th)) return 0;
  printf("\nquantisation transition.v_th = %.4g m/s against an encoder count\n", v_th);
  if (isnan(count)) {
    printf("  give --counts to compare\n");
    return 0;
  }
  double step = count * link / setup->period, heard = answer(setup, count) * link;
  ethd__velocity_text(setup, velocity, sizeof velocity);
  printf("  one count per tick       Delta/T = %.4g m/s at the ring\n", step);
  printf("  one count, ring still    %s makes %.4g m/s of it: %s\n", velocity, heard,
         heard < v_th ? "under v_th" : "over v_th, so each count puts off the end of braking");
  if (heard >= v_th) printf("  to change:               %s, or transition.v_th over %.4g\n", smoother(setup), heard);
  return heard >= v_th && setup->velocity == ETHD_VELOCITY_DIFFERENCE;
}
