#include "proximity_ring/calibration_fit.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "ethd/maths.h"
#include "text/error_text.h"
#include "text/text.h"

#define CEILING (ETHD__FRAME_SATURATED - 1.0)
#define P_MIN 0.5
#define P_MAX 8
#define D0_MAX 0.05

enum { LN_A, D0, P, UNKNOWNS };

ethd__place_reading ethd__place_expected(double ring_radius, double rod, ethd_vec centre) {
  ethd__place_reading place;
  memset(&place, 0, sizeof place);
  ethd_fit_rays(ring_radius, rod, centre, place.distance);
  return place;
}

/* ---- one pair of counts above dark and distance ---- */

typedef struct measured_point {
  double above, distance;
} measured_point;

static bool usable(const ethd__calibration *c, const ethd__place_reading *place, int k, measured_point *out) {
  *out = (measured_point){place->counts[k] - c->sensors[k].dark, place->distance[k]};
  return place->counts[k] > 0 && place->counts[k] < CEILING && out->above > 1 && isfinite(out->distance);
}

static double law(const ethd__sensor *s, double above, double *u) {
  *u = ethd_exp(ethd_log(s->a / above) / s->p);
  return *u - s->d0;
}

static double any_law(const ethd__sensor *s, double above) {
  double u;
  ethd__sensor zeroed;
  if (!s->points) return law(s, above, &u);
  zeroed = *s;
  zeroed.dark = 0;
  return ethd__sensor_distance(&zeroed, (uint16_t)fmin(fmax(rint(above), 1), CEILING));
}

double ethd__calibration_error(const ethd__calibration *c, ethd__place_readings readings, int sensor) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < readings.count; i++)
    for (int k = 0; k < ETHD_RAYS; k++) {
      measured_point one;
      if ((sensor >= 0 && k != sensor) || !usable(c, &readings.at[i], k, &one)) continue;
      double e = any_law(&c->sensors[k], one.above) - one.distance;
      sum += e * e;
      count++;
    }
  return count ? sqrt(sum / (double)count) : (double)NAN;
}

/* ---- least squares in ln a, d0 and p, the first n of them ---- */

typedef struct normal {
  double h[UNKNOWNS][UNKNOWNS], g[UNKNOWNS], cost;
} normal;

/* d = u - d0 with u = (a / above)^(1/p): dd/d(ln a) = u/p, dd/d(d0) = -1, dd/dp = -u ln(u)/p. */
static void add(normal *to, const ethd__sensor *s, measured_point one) {
  double u, e = law(s, one.above, &u) - one.distance;
  const double row[UNKNOWNS] = {u / s->p, -1, -u * ethd_log(u) / s->p};
  for (int i = 0; i < UNKNOWNS; i++) {
    to->g[i] += row[i] * e;
    for (int j = 0; j < UNKNOWNS; j++) to->h[i][j] += row[i] * row[j];
  }
  to->cost += e * e;
}

/* Sums over the pairs of one sensor, or of all (sensor -1), under the law of `s`. */
static size_t collect(const ethd__calibration *c, ethd__place_readings readings, int sensor, const ethd__sensor *s,
                      normal *out) {
  size_t count = 0;
  memset(out, 0, sizeof *out);
  for (size_t i = 0; i < readings.count; i++)
    for (int k = 0; k < ETHD_RAYS; k++) {
      measured_point one;
      if ((sensor >= 0 && k != sensor) || !usable(c, &readings.at[i], k, &one)) continue;
      add(out, s, one);
      count++;
    }
  return count;
}

/* Solves (H + damping diag H) x = g by elimination; the matrix is positive definite. */
static void solve(normal m, int n, double damping, double x[UNKNOWNS]) {
  for (int i = 0; i < n; i++) m.h[i][i] += damping * m.h[i][i] + 1e-300;
  for (int i = 0; i < n; i++)
    for (int j = i + 1; j < n; j++) {
      double f = m.h[j][i] / m.h[i][i];
      for (int k = i; k < n; k++) m.h[j][k] -= f * m.h[i][k];
      m.g[j] -= f * m.g[i];
    }
  for (int i = n - 1; i >= 0; i--) {
    x[i] = m.g[i];
    for (int k = i + 1; k < n; k++) x[i] -= m.h[i][k] * x[k];
    x[i] /= m.h[i][i];
  }
}

static ethd__sensor moved(const ethd__sensor *s, int n, const double x[UNKNOWNS]) {
  ethd__sensor to = *s;
  to.a *= ethd_exp(-fmax(-3, fmin(3, x[LN_A])));
  to.d0 = fmax(0, fmin(D0_MAX, s->d0 - x[D0]));
  if (n > P) to.p = fmax(P_MIN, fmin(P_MAX, s->p - x[P]));
  return to;
}

/* Levenberg and Marquardt: a step that doesn't help is tried again, more cautiously. */
static size_t descend(const ethd__calibration *c, ethd__place_readings readings, int sensor, int n, ethd__sensor *s) {
  normal here, there;
  double damping = 1e-3, x[UNKNOWNS];
  size_t count = collect(c, readings, sensor, s, &here);
  for (int i = 0; i < 500 && count && damping < 1e12; i++) {
    solve(here, n, damping, x);
    ethd__sensor next = moved(s, n, x);
    collect(c, readings, sensor, &next, &there);
    if (!(there.cost < here.cost)) {
      damping *= 8;
      continue;
    }
    int done = here.cost - there.cost < 1e-14 * here.cost;
    *s = next;
    here = there;
    damping = fmax(damping / 4, 1e-12);
    if (done) break;
  }
  return count;
}

/* ---- tables: means of readings at one distance, made monotone by joining neighbours that aren't ---- */

typedef struct bin {
  double above, at, weight;
} bin;

static size_t insert(bin *bins, size_t n, measured_point one) {
  size_t i = n;
  for (; i > 0 && bins[i - 1].at > one.distance; i--) bins[i] = bins[i - 1];
  bins[i] = (bin){one.above, one.distance, 1};
  return n + 1;
}

static bin joined(bin a, bin b) {
  double w = a.weight + b.weight;
  return (bin){(a.above * a.weight + b.above * b.weight) / w, (a.at * a.weight + b.at * b.weight) / w, w};
}

/* Neighbours closer than `gap`, or whose counts don't fall, become one. */
static size_t join(bin *bins, size_t n, double gap) {
  size_t kept = 0;
  for (size_t i = 0; i < n; i++) {
    bins[kept++] = bins[i];
    while (kept > 1 && (bins[kept - 1].above >= bins[kept - 2].above || bins[kept - 1].at - bins[kept - 2].at < gap)) {
      bins[kept - 2] = joined(bins[kept - 2], bins[kept - 1]);
      kept--;
    }
  }
  return kept;
}

enum { PAIRS_MAX = 256 };

static size_t tabulate(const ethd__calibration *c, ethd__place_readings readings, int k, ethd__sensor *s) {
  bin bins[PAIRS_MAX];
  size_t n = 0, count;
  measured_point one;
  for (size_t i = 0; i < readings.count && n < PAIRS_MAX; i++)
    if (usable(c, &readings.at[i], k, &one)) n = insert(bins, n, one);
  count = n;
  n = join(bins, n, 10e-6);
  for (double gap = 20e-6; n > ETHD__POINTS_MAX; gap *= 1.5) n = join(bins, n, gap);
  for (size_t i = 0; i < n; i++) s->above[i] = bins[i].above, s->at[i] = bins[i].at;
  s->points = (uint32_t)n;
  return n < 2 ? 0 : count;
}

/* ---- levels ---- */

static ethd_status need(int sensor, size_t has, size_t needs, char *message) {
  if (has >= needs) return ETHD_OK;
  if (sensor < 0)
    return ethd__say(message, ETHD_E_RANGE, "%zu usable reading%s, at least %zu are needed", has, ethd__s(has), needs);
  return ethd__say(message, ETHD_E_RANGE,
                   "sensor %d: %zu usable reading%s, at least %zu are needed: is it missing, dirty or saturated?",
                   sensor, has, ethd__s(has), needs);
}

static ethd_status fit_sensor(ethd__level level, ethd__place_readings readings, int k, ethd__calibration *c,
                              char *message) {
  ethd__sensor *s = &c->sensors[k];
  if (level == ETHD__LEVEL_TABLE) return need(k, tabulate(c, readings, k, s), 2, message);
  if (level == ETHD__LEVEL_LAW) return need(k, descend(c, readings, k, P + 1, s), 4, message);
  if (level == ETHD__LEVEL_GAIN) return need(k, descend(c, readings, k, D0 + 1, s), 2, message);
  return ETHD_OK;
}

ethd_status ethd__calibration_fit(ethd__level level, ethd__place_readings readings, ethd__calibration *c,
                                  char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  ethd__sensor common = c->sensors[0];
  common.points = 0;
  if (level != ETHD__LEVEL_NONE) status = need(-1, descend(c, readings, -1, P + 1, &common), 4, message);
  for (int k = 0; k < ETHD_RAYS && !status; k++) {
    ethd__sensor *s = &c->sensors[k];
    s->a = common.a;
    s->p = common.p;
    s->d0 = common.d0;
    s->points = 0;
    status = fit_sensor(level, readings, k, c, message);
    s->residual = ethd__calibration_error(c, readings, k);
  }
  c->level = level;
  c->residual = ethd__calibration_error(c, readings, -1);
  return status;
}
