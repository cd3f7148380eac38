#include "tap/early.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "statistics/clusters.h"

#define FROM 0.4
#define TO 0.6

/* Sides: 0 in time, 1 early. */
static size_t take(const ethd__sample *t, ethd__tapped *out) {
  size_t n = 0;
  for (size_t c = 0; c < t->count; c++)
    for (size_t i = 0; i < t->cells[c].count; i++) {
      const ethd__result *r = &t->cells[c].results[i];
      if (isnan(r->commanded)) continue;
      out[n++] =
          (ethd__tapped){r->commanded, ethd__cell_person(&t->cells[c], i), r->metrics.reason == ETHD_TAP_EARLY_CONTACT};
    }
  return n;
}

/* Of all thresholds the one that mistakes the fewest taps; NaN unless taps of both kinds are there. */
static double threshold(const ethd__clusters *c, const uint32_t *weight) {
  double all[2] = {0, 0}, best = NAN, before = NAN;
  for (size_t i = 0; i < c->n; i++) all[c->tap[i].side] += weight[i];
  if (!(all[0] > 0 && all[1] > 0)) return NAN;
  double mistakes = all[0], fewest = all[0];
  for (size_t i = 0; i < c->n; i++) { /* the threshold stands between `before` and tap i */
    if (!weight[i]) continue;
    if (mistakes < fewest) fewest = mistakes, best = (before + c->tap[i].value) / 2;
    mistakes += c->tap[i].side ? weight[i] : -(double)weight[i];
    before = c->tap[i].value;
  }
  return best;
}

static void judge(const ethd__clusters *clusters, uint64_t seed, ethd__claim_part *out) {
  double draws[ETHD_CLUSTERS_DRAWS], below = 1, above = 1;
  size_t n = ethd__clusters_draws(clusters, threshold, seed, draws);
  for (size_t i = 0; i < n; i++) below += draws[i]<FROM, above += draws[i]> TO;
  if (!n) return;
  out->test = "bootstrap";
  out->low = ethd__quantile(draws, n, 0.025), out->high = ethd__quantile(draws, n, 0.975);
  out->p = fmax(below, above) / (double)(n + 1);
  out->verdict = out->p < 0.05 ? ETHD_TAP_SHOWN : out->low > TO || out->high < FROM ? ETHD_TAP_CONTRARY : ETHD_TAP_OPEN;
}

void ethd__early_claim(const ethd__sample *t, ethd__tap_claim *out) {
  size_t room = 1;
  ethd__clusters clusters;
  *out =
      (ethd__tap_claim){.text = "the finger touches before the ring meets the wall from about 0.5 m/s on", .parts = 1};
  ethd__claim_part *part = &out->part[0];
  *part = (ethd__claim_part){.what = "commanded speed, threshold", .unit = "m/s", .from = FROM, .to = TO};
  part->low = part->high = part->p = part->d_z = NAN;
  part->test = "";
  for (size_t c = 0; c < t->count; c++) room += t->cells[c].count;
  ethd__tapped *taps = malloc(room * sizeof *taps);
  if (!taps || !ethd__clusters_make(taps, take(t, taps), t->people, &clusters)) ethd__fail_memory();
  part->mean = ethd__clusters_here(&clusters, threshold);
  part->people = clusters.persons;
  if (part->people >= ETHD_STATISTICS_PEOPLE && !isnan(part->mean)) judge(&clusters, t->seed, part);
  ethd__clusters_free(&clusters);
  free(taps);
}
