/* The free viscous ring: braking with B_d and nothing else, tick for tick, b = B_d T/m.

     speeds measured     v_k+1 = (1 - b) v_k
     lowpass of gain a   z^2 - (2 - a - a b/2) z + 1 - a + a b/2 = 0, v_k a sum of its modes;
                         a = 1 is the backward difference */
#include <complex.h>
#include <math.h>

#include "stress/mass.h"

#define MASS 0.1173
#define PERIOD 0.001
#define SPEED 0.2
#define STILL 0.001 /* v_th */

static void open_braking(mass_rig *r, double damping) {
  mass_open(r, MASS, -1e-12);
  r->on.setup.arm.link1 = MASS_STRAIGHT;
  mass_brakes(r, damping, STILL);
}

/* Ticks of braking, and eps, when speeds are measured. */
static void measured(double damping) {
  mass_rig r;
  double b = damping * PERIOD / MASS;
  open_braking(&r, damping);
  r.measured = 1;
  mass_start(&r, SPEED);
  while (mass_tick(&r)->state != ETHD_VO && r.tick < 100000) continue;
  double ticks = ceil(log1p(STILL / SPEED - 1) / log1p(-b)), left = exp(ticks * log1p(-b));
  double eps = PERIOD * SPEED * (1 - left) / b * (1 - b / 2);
  within((double)r.on.trace.tick, ticks, 0, "ticks of braking = ceil(ln(v_th/v0) / ln(1 - b))");
  near(r.on.trace.eps, eps, 1e-6, "eps = T v0 (1 - (1 - b)^N) (1/b - 1/2)");
  mass_close(&r);
}

/* v_k = p z^k + r y^k, from its first two. */
typedef struct modes {
  double complex z, y, p, r;
} modes;

static modes modes_of(double a, double b, double v0, double v1) {
  double half = (2 - a - a * b / 2) / 2, product = 1 - a + a * b / 2;
  double complex root = csqrt(half * half - product);
  modes m = {.z = half + root, .y = half - root};
  m.p = (v1 - v0 * m.y) / (m.z - m.y);
  m.r = v0 - m.p;
  return m;
}

static double speed_at(const modes *m, int k) { return creal(m->p * cpow(m->z, k) + m->r * cpow(m->y, k)); }

/* The largest distance from the modes while it brakes, as a share of the first speed. */
static double off_modes(double cutoff, double damping) {
  mass_rig r;
  double v0, v1, worst = 0, a = cutoff > 0 ? 1 - exp(-2 * M_PI * cutoff * PERIOD) : 1;
  open_braking(&r, damping);
  mass_velocity(&r, cutoff > 0 ? ETHD_VELOCITY_LOWPASS : ETHD_VELOCITY_DIFFERENCE, cutoff);
  mass_start(&r, SPEED);
  mass_tick(&r); /* nothing is known of the speed yet */
  v0 = mass_speed(&r);
  mass_tick(&r);
  v1 = mass_speed(&r);
  modes m = modes_of(a, damping * PERIOD / MASS, v0, v1);
  for (int k = 2; r.on.trace.state == ETHD_BRAKING; k++) {
    mass_tick(&r);
    if (r.on.trace.state == ETHD_BRAKING) worst = fmax(worst, fabs(mass_speed(&r) - speed_at(&m, k)) / v0);
  }
  mass_close(&r);
  return worst;
}

TEST(test_viscous) {
  static const double share[] = {1e-3, 0.01, 0.05, 0.2, 0.5, 0.9};
  const double unit = MASS / PERIOD;
  for (size_t i = 0; i < 6; i++) measured(share[i] * unit);
  for (size_t i = 0; i < 6; i++) bound(off_modes(0, share[i] * unit), 1e-5, "difference: speeds off its two modes");
  for (size_t i = 0; i < 6; i++)
    bound(off_modes(130, share[i] * unit), 1e-5, "lowpass 130 Hz: speeds off its two modes");
}
