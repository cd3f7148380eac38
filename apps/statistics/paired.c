#include "statistics/paired.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/random.h"
#include "statistics/distribution.h"

#define EXACT 16u
#define BITS 53u /* random signs in one uniform number */
#define WORK 4e7 /* the most signs that are drawn, so that the time stays linear in the people */
#define FLIPS_MAX 20000u
#define FLIPS_MIN 2000u

/* ---- flipped signs ---- */

/* Returns the size of the differences' sum with some signs flipped: `signs` has a bit for each of at most 64
   differences. */
static double flipped(const double *differences, size_t n, uint64_t signs) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += signs >> i & 1 ? -differences[i] : differences[i];
  return fabs(sum);
}

static double drawn_flip(const double *differences, size_t n, ethd__sim_key key) {
  double sum = 0;
  for (size_t i = 0; i < n; i += BITS) {
    uint64_t signs = (uint64_t)(ethd__uniform(key, ETHD_DRAW_SIGN, (uint32_t)(i / BITS)) * 0x1p53);
    for (size_t k = i; k < n && k < i + BITS; k++) sum += signs >> (k - i) & 1 ? -differences[k] : differences[k];
  }
  return fabs(sum);
}

double ethd__sign_flip(const double *differences, size_t n, uint64_t seed) {
  double size = 0, here = 0;
  for (size_t i = 0; i < n; i++) here += differences[i], size += fabs(differences[i]);
  here = fabs(here) - 1e-12 * size; /* sums that are equal but for rounding count as equal */
  if (!n) return NAN;
  uint64_t as_far = 0,
           all = n <= EXACT ? (uint64_t)1 << n : (uint64_t)fmax(FLIPS_MIN, fmin(FLIPS_MAX, WORK / (double)n));
  for (uint64_t k = 0; k < all; k++)
    as_far += (n <= EXACT ? flipped(differences, n, k) : drawn_flip(differences, n, (ethd__sim_key){seed, k})) >= here;
  return n <= EXACT ? (double)as_far / (double)all : (double)(as_far + 1) / (double)(all + 1);
}

/* ---- the mean, and the effect size ---- */

/* Finds the shift at which a share p of the noncentral t lies below t; the share falls as the shift grows. */
static double shift_at(double t, double freedom, double p) {
  double low = t - 10 - fabs(t), high = t + 10 + fabs(t);
  for (int i = 0; i < 100 && high - low > 1e-12 * (1 + fabs(t)); i++) {
    double middle = (low + high) / 2;
    *(ethd__noncentral_below(t, freedom, middle) > p ? &low : &high) = middle;
  }
  return (low + high) / 2;
}

static ethd__interval effect_of(const ethd__paired *c) {
  double root = sqrt((double)c->n), t = c->d_z * root, freedom = (double)c->n - 1;
  if (c->n < 3 || !isfinite(t)) return (ethd__interval){NAN, NAN, c->n, 0};
  return (ethd__interval){shift_at(t, freedom, 0.975) / root, shift_at(t, freedom, 0.025) / root, c->n, 0};
}

static double error_of(const double *values, size_t n) { return ethd__sd_of(values, n) / sqrt((double)n); }

void ethd__compare(const double *differences, size_t n, uint64_t seed, ethd__paired *out) {
  double *copy = malloc((n + 1) * sizeof *copy);
  ethd__summary5 s;
  *out = (ethd__paired){.n = n, .interval = {NAN, NAN, n, 0}, .p = NAN};
  if (copy) memcpy(copy, differences, n * sizeof *copy);
  ethd__summarise(copy, copy ? n : 0, &s);
  free(copy);
  out->mean = s.mean, out->sd = s.sd, out->median = s.median;
  out->d_z = s.sd > 0 ? s.mean / s.sd : NAN;
  for (size_t i = 0; i < n; i++) out->positive += differences[i] > 0;
  double reach = n > 2 ? ethd__student_quantile(0.975, (double)n - 1) * error_of(differences, n) : NAN;
  out->interval.low = s.mean - reach, out->interval.high = s.mean + reach;
  out->effect = effect_of(out);
  if (n >= ETHD_STATISTICS_PEOPLE) out->p = ethd__sign_flip(differences, n, seed);
}

/* ---- equivalence ---- */

ethd__equivalence ethd__equivalent(const double *values, size_t n, double low, double high) {
  ethd__equivalence e = {NAN, false, NAN, NAN};
  if (n < 2) return e;
  double mean = ethd__mean_of(values, n), error = error_of(values, n), freedom = (double)n - 1;
  /* differences without spread have no error: the mean is clearly inside the margin or clearly outside */
  double above = error > 0 ? (mean - low) / error : mean > low ? INFINITY : -INFINITY;
  double below = error > 0 ? (high - mean) / error : mean < high ? INFINITY : -INFINITY;
  e.p = 1 - ethd__student_below(fmin(above, below), freedom);
  if (fmin(above, below) > 0) e.p = ethd__student_below(-fmin(above, below), freedom);
  double reach90 = ethd__student_quantile(0.95, freedom) * error,
         reach95 = ethd__student_quantile(0.975, freedom) * error;
  e.low = mean - reach90, e.high = mean + reach90;
  e.outside = mean - reach95 > high || mean + reach95 < low;
  return e;
}

/* ---- samples that overlap ---- */

typedef struct sample_moments {
  size_t n;
  double mean, square; /* square: sum of squared distances from the mean */
} sample_moments;

static sample_moments sample_moments_of(const double *values, size_t n) {
  sample_moments m = {0, 0, 0};
  for (size_t i = 0; i < n; i++)
    if (!isnan(values[i])) m.mean += values[i], m.n++;
  m.mean /= (double)m.n;
  for (size_t i = 0; i < n; i++)
    if (!isnan(values[i])) m.square += (values[i] - m.mean) * (values[i] - m.mean);
  return m;
}

/* Pearson's correlation over the people who are in both samples; 0 with fewer than three, who say nothing about it. */
static double correlation(const double *a, const double *b, size_t n, size_t both) {
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  for (size_t i = 0; i < n; i++)
    if (!isnan(a[i] + b[i])) mean_a += a[i] / (double)both, mean_b += b[i] / (double)both;
  for (size_t i = 0; i < n; i++) {
    double x = a[i] - mean_a, y = b[i] - mean_b;
    if (!isnan(x + y)) aa += x * x, bb += y * y, ab += x * y;
  }
  return both > 2 && aa > 0 && bb > 0 ? ab / sqrt(aa * bb) : 0;
}

ethd__overlap ethd__overlapping(const double *first, const double *second, size_t people) {
  sample_moments a = sample_moments_of(first, people), b = sample_moments_of(second, people);
  ethd__overlap out = {a.n, b.n, 0, a.mean - b.mean, NAN, NAN, NAN, NAN};
  for (size_t i = 0; i < people; i++) out.both += !isnan(first[i] + second[i]);
  if (a.n < 2 || b.n < 2) return out;
  double n = (double)a.n, m = (double)b.n, both = (double)out.both;
  double va = a.square / (n - 1) / n, vb = b.square / (m - 1) / m; /* of the means */
  double shared = 2 * correlation(first, second, people, out.both) * sqrt(va * vb) * both / sqrt(n * m);
  double welch = (va + vb) * (va + vb) / (va * va / (n - 1) + vb * vb / (m - 1));
  out.freedom = (both - 1) + (welch - both + 1) / (n + m) * (n + m - 2 * both);
  double error = sqrt(va + vb - shared), reach = ethd__student_quantile(0.975, out.freedom) * error;
  if (!(error > 0)) return out;
  out.low = out.difference - reach, out.high = out.difference + reach;
  out.p = 2 * ethd__student_below(-fabs(out.difference) / error, out.freedom);
  return out;
}

/* ---- many tests ---- */

void ethd__holm(double *p, size_t n) {
  size_t made = 0, done = 0;
  double least = 0;
  for (size_t i = 0; i < n; i++) made += isnan(p[i]) ? 0 : 1;
  char *taken = calloc(n + 1, 1);
  if (!taken) return;
  for (; done < made; done++) {
    size_t next = n;
    for (size_t i = 0; i < n; i++)
      if (!taken[i] && !isnan(p[i]) && (next == n || p[i] < p[next])) next = i;
    taken[next] = 1;
    least = fmax(least, fmin(1, p[next] * (double)(made - done)));
    p[next] = least;
  }
  free(taken);
}
