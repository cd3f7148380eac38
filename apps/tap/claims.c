#include "tap/claims.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FEWEST 5 /* valid taps that a verdict needs */

const ethd__cell *ethd__cell_find(const ethd__cell *cells, size_t count, const char *law, const char *speed) {
  for (size_t i = 0; i < count; i++)
    if (!strcmp(cells[i].law, law) && !strcmp(cells[i].speed->word, speed)) return &cells[i];
  return NULL;
}

static ethd__figure figure_of(const ethd__cell *cell, size_t field) {
  return cell ? ethd__cell_figure(cell, field) : (ethd__figure){0, NAN, NAN};
}

static ethd__verdict verdict(bool known, bool met) {
  return !known ? ETHD_TAP_UNKNOWN : met ? ETHD_TAP_MET : ETHD_TAP_NOT_MET;
}

/* ---- Table 1 ---- */

void ethd__means(const ethd__cell *cells, size_t count, ethd__mean out[ETHD_TAP_MEANS]) {
  static const struct {
    const char *name, *unit, *speed;
    size_t field;
    double scale, mean, sd;
  } table[ETHD_TAP_MEANS] = {
      {"Delta_s, low", "ms", "low", ETHD_TAP_FIELD(delta_s), 1, 3.111, 2.804},
      {"eps, low", "mm", "low", ETHD_TAP_FIELD(eps), 1e3, 0.388, 0.251},
      {"Delta_s, high", "ms", "high", ETHD_TAP_FIELD(delta_s), 1, 14.556, 1.424},
      {"eps, high", "mm", "high", ETHD_TAP_FIELD(eps), 1e3, 2.434, 0.357},
  };
  for (int i = 0; i < ETHD_TAP_MEANS; i++) {
    ethd__mean *mean = &out[i];
    *mean = (ethd__mean){table[i].name, table[i].unit, table[i].mean, table[i].sd, {0}, 0, 0};
    mean->here = figure_of(ethd__cell_find(cells, count, "offset", table[i].speed), table[i].field);
    mean->here.mean *= table[i].scale;
    mean->here.sd *= table[i].scale;
    mean->allowed = mean->paper_sd + 2 * ethd__figure_error(&mean->here);
    mean->verdict = verdict(mean->here.n >= FEWEST, fabs(mean->here.mean - mean->paper) <= mean->allowed);
  }
}

/* ---- claims ---- */

/* The same figure under smooth and offset. */
typedef struct both {
  ethd__figure smooth, offset;
  bool known;
} both;

static both both_of(const ethd__cell *cells, size_t count, const char *speed, size_t field) {
  both b = {figure_of(ethd__cell_find(cells, count, "smooth", speed), field),
            figure_of(ethd__cell_find(cells, count, "offset", speed), field), false};
  b.known = b.smooth.n >= FEWEST && b.offset.n >= FEWEST;
  return b;
}

static void rebound(const ethd__cell *cells, size_t count, ethd__tap_claim *out) {
  both d = both_of(cells, count, "high", ETHD_TAP_FIELD(d_max));
  out->text = "high: d_max of smooth is several times (>= 3) that of offset";
  snprintf(out->here, sizeof out->here, "%.2f / %.2f mm = %.1f x", 1e3 * d.smooth.mean, 1e3 * d.offset.mean,
           d.smooth.mean / d.offset.mean);
  out->verdict = verdict(d.known, d.smooth.mean >= 3 * d.offset.mean);
}

static void rebound_speed(const ethd__cell *cells, size_t count, ethd__tap_claim *out) {
  both v = both_of(cells, count, "high", ETHD_TAP_FIELD(v_rmin));
  out->text = "high: |v_rmin| is much smaller (<= 1/2) under offset";
  snprintf(out->here, sizeof out->here, "%.3f -> %.3f m/s", v.smooth.mean, v.offset.mean);
  out->verdict = verdict(v.known, fabs(v.offset.mean) <= fabs(v.smooth.mean) / 2);
}

static void speed_at_touch(const ethd__cell *cells, size_t count, ethd__tap_claim *out) {
  both v = both_of(cells, count, "high", ETHD_TAP_FIELD(v_of));
  out->text = "high: mean v_of is against the finger (< 0) under smooth, not so under offset";
  snprintf(out->here, sizeof out->here, "%+.3f -> %+.3f m/s", v.smooth.mean, v.offset.mean);
  out->verdict = verdict(v.known, v.smooth.mean < 0 && v.offset.mean > 0);
}

static void positive_at_touch(const ethd__cell *cells, size_t count, ethd__tap_claim *out) {
  const ethd__cell *cell = ethd__cell_find(cells, count, "offset", "high");
  bool known = cell && ethd__cell_valid(cell) >= FEWEST;
  double share = known ? ethd__cell_share(cell, ETHD_TAP_FIELD(v_of), 0x1p-1022, INFINITY) : NAN;
  out->text = "high: v_of is > 0 in at least 25 % of the taps under offset";
  snprintf(out->here, sizeof out->here, "%.0f %%", 100 * share);
  out->verdict = verdict(known, share >= 0.25);
}

static void alike(const ethd__cell *cells, size_t count, ethd__tap_claim *out) {
  both d = both_of(cells, count, "low", ETHD_TAP_FIELD(d_max));
  double a = ethd__figure_error(&d.smooth), b = ethd__figure_error(&d.offset), error = sqrt(a * a + b * b);
  out->text = "low: smooth and offset are alike (d_max within 25 %, 2 std. errors)";
  snprintf(out->here, sizeof out->here, "%.3f / %.3f mm", 1e3 * d.smooth.mean, 1e3 * d.offset.mean);
  out->verdict =
      verdict(d.known, fabs(d.smooth.mean - d.offset.mean) <= 0.25 * fmax(d.smooth.mean, d.offset.mean) + 2 * error);
}

static void early(const ethd__cell *cells, size_t count, ethd__tap_claim *out) {
  double from = ethd__cells_early_from(cells, count);
  out->text = "the finger touches before the wall from about 0.5 m/s on (0.4 to 0.6)";
  if (isnan(from))
    snprintf(out->here, sizeof out->here, "never");
  else
    snprintf(out->here, sizeof out->here, "%.2f m/s", from);
  out->verdict = verdict(ethd__cell_find(cells, count, "offset", "high") != NULL, from >= 0.4 && from <= 0.6);
}

/* The paper: 10 to 15 taps for three valid ones. */
static void valid_share(const ethd__cell *cells, size_t count, ethd__tap_claim *out) {
  size_t taps = 0, valid = 0, each = 0;
  for (size_t i = 0; i < count; i++) {
    if (strcmp(cells[i].speed->word, "high")) continue;
    taps += cells[i].count;
    valid += ethd__cell_valid(&cells[i]);
    each = cells[i].count;
  }
  double share = (double)valid / (double)taps, error = sqrt(share * (1 - share) / (double)each);
  out->text = "20 to 30 % of the high taps are valid (2 std. errors)";
  snprintf(out->here, sizeof out->here, "%.0f %%", 100 * share);
  out->verdict = verdict(each >= FEWEST, share >= 0.2 - 2 * error && share <= 0.3 + 2 * error);
}

size_t ethd__claims(const ethd__cell *cells, size_t count, ethd__tap_claim out[ETHD_TAP_CLAIMS_MAX]) {
  static void (*const claims[])(const ethd__cell *, size_t, ethd__tap_claim *) = {
      rebound, rebound_speed, speed_at_touch, positive_at_touch, alike, early, valid_share};
  size_t n = sizeof claims / sizeof *claims;
  for (size_t i = 0; i < n; i++) claims[i](cells, count, &out[i]);
  return n;
}
