#include "identify/sensing.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "text/error_text.h"

#define LEAST 1e-9   /* rad: smaller differences of two angles are rounding */
#define LATTICE 0.02 /* largest distance of an angle from the lattice, counts */
#define ALIKE 1e-3   /* relative difference that two estimates of one encoder's count may have */
#define TOGETHER 1.5 /* readings are consecutive if less than this number of median periods lies between them */
#define ORDERS 4     /* orders of differences: a high one removes a smooth motion and leaves noise */

/* ---- counts ---- */

static double least_difference(const ethd__evidence *e, uint32_t recording) {
  double least = (double)INFINITY;
  for (size_t i = 0; i < e->stretch_count; i++) {
    const ethd__passage *s = &e->stretches[i];
    if (s->recording != recording) continue;
    for (size_t k = s->first + 1; k < s->first + s->count; k++)
      for (int j = 0; j < 2; j++) {
        double d = fabs(e->q[k][j] - e->q[k - 1][j]);
        if (d > LEAST && d < least) least = d;
      }
  }
  return least;
}

/* Refines the count: the slope of differences of angles over whole numbers, first small ones, then larger ones as the
   slope gets better. Returns how far the differences miss the lattice, counts rms. */
static double refine(const ethd__evidence *e, uint32_t recording, double *count) {
  double missed = 0;
  for (double most = 10; most < 1e7; most *= 10) {
    double nd = 0, nn = 0, squares = 0, rows = 0;
    for (size_t i = 0; i < e->stretch_count; i++) {
      const ethd__passage *s = &e->stretches[i];
      if (s->recording != recording) continue;
      for (size_t k = s->first + 1; k < s->first + s->count; k++)
        for (int j = 0; j < 2; j++) {
          double d = e->q[k][j] - e->q[s->first][j], n = rint(d / *count);
          if (!(fabs(n) <= most)) continue;
          nd += n * d;
          nn += n * n;
          squares += (d / *count - n) * (d / *count - n);
          rows++;
        }
    }
    if (!(nn > 0)) continue;
    missed = sqrt(squares / rows);
    *count = nd / nn;
  }
  return missed;
}

static bool has_phase(const ethd__evidence *e, double count) {
  for (size_t i = 0; i < e->stretch_count; i++)
    for (int j = 0; j < 2; j++) {
      double at = e->q[e->stretches[i].first][j] / count;
      if (fabs(at - rint(at)) > LATTICE) return true;
    }
  return false;
}

static ethd_status find_counts(const ethd__evidence *e, ethd__sensing *out, char *message) {
  uint32_t first = UINT32_MAX;
  for (uint32_t r = 0; r < e->recording_count; r++) {
    double count = least_difference(e, r);
    if (!isfinite(count)) continue;
    if (!(refine(e, r, &count) < LATTICE)) count = 0;
    if (first == UINT32_MAX) {
      first = r;
      out->count = count;
    }
    if (!(fabs(count - out->count) <= ALIKE * out->count))
      return ethd__say(
          message, ETHD_E_ARGUMENT,
          "%s: an encoder count is %.6g rad, but %.6g rad in %s: recordings of two devices are mixed; give "
          "those of one",
          e->folders[r], count, out->count, e->folders[first]);
  }
  out->count_drawn = out->count > 0 && has_phase(e, out->count);
  return ETHD_OK;
}

/* ---- readings ---- */

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *values, size_t count) {
  if (!count) return (double)NAN;
  qsort(values, count, sizeof *values, by_size);
  return values[count / 2];
}

static double apart(const ethd__delivery *d) { return ethd__evidence_apart(d[-1].sample_ns, d[0].sample_ns); }

static bool follows(const ethd__evidence *e, size_t i, double pace) {
  const ethd__delivery *d = &e->deliveries[i];
  return i > 0 && d[0].recording == d[-1].recording && apart(d) > 0 && !(apart(d) > TOGETHER * pace);
}

static double pace_of(const ethd__evidence *e, double *room) {
  size_t n = 0;
  for (size_t i = 1; i < e->delivery_count; i++)
    if (follows(e, i, (double)INFINITY)) room[n++] = apart(&e->deliveries[i]);
  return median(room, n);
}

static void find_rate(const ethd__evidence *e, double pace, ethd__bracket *out) {
  double sum = 0, squares = 0, n = 0;
  for (size_t i = 1; i < e->delivery_count; i++) {
    if (!follows(e, i, pace)) continue;
    double d = apart(&e->deliveries[i]) - pace;
    sum += d;
    squares += d * d;
    n++;
  }
  if (!(n > 1)) return;
  double mean = sum / n, error = sqrt(fmax(squares / n - mean * mean, 1e-18) / n);
  *out = (ethd__bracket){1 / (pace + mean), 1 / (pace + mean + 1.96 * error), 1 / (pace + mean - 1.96 * error)};
}

/* Brackets the latency: a reading that came at one tick had not come at the tick before. */
static void find_latency(const ethd__evidence *e, ethd__bracket *out) {
  double low = 0, high = (double)INFINITY;
  for (size_t i = 0; i < e->delivery_count; i++) {
    const ethd__delivery *d = &e->deliveries[i];
    low = fmax(low, ethd__evidence_apart(d->sample_ns, d->after_ns));
    high = fmin(high, ethd__evidence_apart(d->sample_ns, d->at_ns));
  }
  if (isfinite(high)) *out = (ethd__bracket){low < high ? (low + high) / 2 : high, fmin(low, high), fmax(low, high)};
}

/* Fills the differences of this order of the finger's position, scaled so that noise of 1 gives 1; returns how many. */
static size_t differences(const ethd__evidence *e, double pace, int order, double *out) {
  static const double weights[ORDERS][ORDERS + 1] = {{-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}, {1, -4, 6, -4, 1}};
  size_t n = 0, in_row = 0;
  double size = 0;
  for (int k = 0; k <= order; k++) size += weights[order - 1][k] * weights[order - 1][k];
  for (size_t i = 0; i < e->delivery_count; i++) {
    in_row = follows(e, i, pace) && !e->deliveries[i].near ? in_row + 1 : 0;
    if (in_row <= (size_t)order) continue;
    double x = 0, y = 0;
    for (int k = 0; k <= order; k++) {
      ethd_vec f = e->deliveries[i - (size_t)(order - k)].finger;
      x += weights[order - 1][k] * f.x;
      y += weights[order - 1][k] * f.y;
    }
    if (isfinite(x + y)) {
      out[n++] = fabs(x) / sqrt(size);
      out[n++] = fabs(y) / sqrt(size);
    }
  }
  return n;
}

/* Touches are left out, because the finger turns sharply there; medians are robust to other sharp turns. */
static void find_noise(const ethd__evidence *e, double pace, double *room, ethd__bracket *out) {
  for (int order = 1; order <= ORDERS; order++) {
    size_t n = differences(e, pace, order, room);
    double sd = median(room, n) / 0.674489750196082, error = sd * 1.17 * sqrt(order / fmax((double)n, 1));
    if (n < 50 || out->value < sd + 2 * error)
      continue; /* an order counts if it gives clearly less noise than lower
                                                            ones */
    *out = (ethd__bracket){sd, sd - 1.96 * error, sd + 1.96 * error};
  }
}

ethd_status ethd__sensing_find(const ethd__evidence *e, ethd__sensing *out, char message[ETHD_MESSAGE_MAX]) {
  const ethd__bracket none = {(double)NAN, (double)NAN, (double)NAN};
  *out = (ethd__sensing){.rate = none, .latency = none, .noise = none};
  ethd_status status = find_counts(e, out, message);
  if (status || e->delivery_count < 10) return status;
  ETHD__FREED double *room = malloc(2 * e->delivery_count * sizeof *room);
  if (!room) ethd__fail_memory();
  double pace = pace_of(e, room);
  find_rate(e, pace, &out->rate);
  find_latency(e, &out->latency);
  find_noise(e, pace, room, &out->noise);
  return ETHD_OK;
}
