/* Finds where a sampled loop becomes unstable: one of its numbers is searched on a grid and bisected. */
#include <math.h>

#include "bounds/stability.h"

#define STEPS_PER_DECADE 16

/* Bisects between a stable and an unstable value, to 1e-6 of it. */
static double bisect(ethd__sampled_loop *loop, double *value, double stable, double unstable) {
  while (fabs(unstable / stable - 1) > 1e-6) {
    *value = sqrt(stable * unstable);
    if (ethd__sampled_stable(loop))
      stable = *value;
    else
      unstable = *value;
  }
  return stable;
}

static double grid(int i) { return exp(i * log(10) / STEPS_PER_DECADE); }

/* With a large mass all motion is slow, and then hold and delay reduce the damping by K (T (n + 1/2) + late), for any
   estimator. */
double ethd__sampled_damping_needed(const ethd__sampled_loop *l) {
  return l->stiffness * (l->period * (l->delay + 0.5) + l->late);
}

double ethd__sampled_mass_min(const ethd__sampled_loop *loop) {
  ethd__sampled_loop l = *loop;
  if (l.damping < ethd__sampled_damping_needed(&l)) return (double)INFINITY;
  for (int i = 4 * STEPS_PER_DECADE; i >= -7 * STEPS_PER_DECADE; i--) {
    l.mass = grid(i);
    if (ethd__sampled_stable(&l)) continue;
    return i == 4 * STEPS_PER_DECADE ? (double)INFINITY : bisect(&l, &l.mass, grid(i + 1), grid(i));
  }
  return 0;
}

/* Walks from a stable value up to the first unstable one, at most to `most`. */
static double band_end(ethd__sampled_loop *l, double *gain, double most) {
  const double step = exp(log(10) / (4 * STEPS_PER_DECADE));
  for (double stable = *gain; stable < most; stable *= step) {
    *gain = stable * step;
    if (!ethd__sampled_stable(l)) return bisect(l, gain, stable, *gain);
  }
  return *gain;
}

/* Mass and period set the units of the grid. A stable band may be narrower than the grid, so the loop's own value is
   tried too. */
static double gain_max(ethd__sampled_loop *l, double *gain, double unit) {
  double own = ethd__sampled_stable(l) ? *gain : 0;
  if (own > 0 && ethd__sampled_gives_way(l)) return band_end(l, gain, 10 * unit);
  for (int i = STEPS_PER_DECADE; i >= -6 * STEPS_PER_DECADE; i--) {
    *gain = unit * grid(i);
    if (ethd__sampled_stable(l)) return fmax(own, bisect(l, gain, *gain, unit * grid(i + 1)));
  }
  return own;
}

double ethd__sampled_stiffness_max(const ethd__sampled_loop *loop) {
  ethd__sampled_loop l = *loop;
  return gain_max(&l, &l.stiffness, l.mass / (l.period * l.period));
}

double ethd__sampled_damping_max(const ethd__sampled_loop *loop) {
  ethd__sampled_loop l = *loop;
  return gain_max(&l, &l.damping, l.mass / l.period);
}

/* Walks from the loop's gains to the requested ones, by the steps of a band's search. The stable gains of a rigid
   device are one band, so only the end of the walk is tested. */
bool ethd__sampled_stable_up_to(const ethd__sampled_loop *loop, double stiffness_times, double damping_times) {
  const double decades = log10(fmax(stiffness_times, damping_times));
  const int steps = ethd__sampled_gives_way(loop) ? (int)ceil(4 * STEPS_PER_DECADE * decades) : 1;
  if (!ethd__sampled_stable(loop)) return false;
  for (int i = 1; i <= steps; i++) {
    ethd__sampled_loop l = *loop;
    l.stiffness *= pow(stiffness_times, (double)i / steps);
    l.damping *= pow(damping_times, (double)i / steps);
    if (!ethd__sampled_stable(&l)) return false;
  }
  return true;
}

/* ---- delay ---- */

static double delay_of(const ethd__sampled_loop *l) { return l->delay * l->period + l->late; }

/* A delay that differs from whole ticks only by rounding counts as whole. */
void ethd__sampled_set_delay(ethd__sampled_loop *l, double delay) {
  l->delay = (int)floor(delay / l->period * (1 + 1e-12));
  l->late = fmax(0, delay - l->delay * l->period);
  if (l->late < 1e-9 * l->period) l->late = 0;
}

static bool stable_with(ethd__sampled_loop *l, double delay) {
  ethd__sampled_set_delay(l, delay);
  return ethd__sampled_stable(l);
}

/* Walks from a stable delay up by quarters of a tick and returns the last stable one; *beyond becomes the first
   unstable one, or `most`. */
static double walk_delay(ethd__sampled_loop *l, double from, double most, double *beyond) {
  double low = from;
  for (*beyond = fmin(from + l->period / 4, most); stable_with(l, *beyond);
       *beyond = fmin(*beyond + l->period / 4, most)) {
    low = *beyond;
    if (low >= most) break;
  }
  return low;
}

bool ethd__sampled_stable_later(const ethd__sampled_loop *loop, double more) {
  ethd__sampled_loop l = *loop;
  double own = delay_of(loop), most = own + more, beyond;
  if (most > ETHD_LOOP_DELAY_MAX * l.period || !ethd__sampled_stable(loop)) return false;
  return walk_delay(&l, own, most, &beyond) >= most;
}

double ethd__sampled_delay_max(const ethd__sampled_loop *loop) {
  ethd__sampled_loop l = *loop;
  double most = ETHD_LOOP_DELAY_MAX * l.period, own = ethd__sampled_stable(loop) ? delay_of(loop) : 0, high;
  if (!stable_with(&l, own)) return -1;
  double low = walk_delay(&l, own, most, &high);
  if (low >= most) return most;
  for (int i = 0; i < 20; i++) {
    double middle = (low + high) / 2;
    if (stable_with(&l, middle))
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* ---- friction ---- */

double ethd__sampled_viscous_needed(const ethd__sampled_loop *loop) {
  ethd__sampled_loop l = *loop;
  double unit = (ethd__sampled_gives_way(&l) ? l.motor_mass : l.mass) / l.period;
  l.viscous = 0;
  if (ethd__sampled_stable(&l)) return 0;
  for (int i = -7 * STEPS_PER_DECADE; i <= 2 * STEPS_PER_DECADE; i++) {
    l.viscous = unit * grid(i);
    if (ethd__sampled_stable(&l)) return bisect(&l, &l.viscous, unit * grid(i), unit * grid(i - 1));
  }
  return (double)INFINITY;
}

double ethd__sampled_held(double needed, double coulomb, double viscous) {
  return needed <= viscous ? (double)INFINITY : 4 * coulomb / (M_PI * (needed - viscous));
}

/* ---- estimator ---- */

static double cutoff_min(ethd__sampled_loop *l) {
  const double step = exp(log(10) / STEPS_PER_DECADE);
  double high = l->p[0];
  for (l->p[0] = high / step; l->p[0] > 1; l->p[0] = high / step) {
    if (!ethd__sampled_stable(l)) return bisect(l, &l->p[0], high, high / step);
    high /= step;
  }
  return 1;
}

static double window_max(ethd__sampled_loop *l) {
  while (l->p[0] < ETHD_VELOCITY_WINDOW_MAX) {
    l->p[0]++;
    if (!ethd__sampled_stable(l)) return l->p[0] - 1;
  }
  return l->p[0];
}

double ethd__sampled_velocity_end(const ethd__sampled_loop *loop) {
  ethd__sampled_loop l = *loop;
  if (!ethd__sampled_stable(&l)) return NAN;
  if (l.method == ETHD_VELOCITY_LOWPASS) return cutoff_min(&l);
  if (l.method == ETHD_VELOCITY_LSQ || l.method == ETHD_VELOCITY_FOAW) return window_max(&l);
  return NAN;
}
