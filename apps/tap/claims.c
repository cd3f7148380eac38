#include "tap/claims.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "statistics/paired.h"
#include "tap/early.h"

#define LEVEL 0.05

const ethd__margins ethd__margins_default = {0.3e-3, 0.02, 0.02};

const char *const ethd__verdict_words[ETHD_TAP_VERDICTS] = {
    [ETHD_TAP_UNKNOWN] = "too few people",
    [ETHD_TAP_SHOWN] = "shown",
    [ETHD_TAP_OPEN] = "not shown",
    [ETHD_TAP_CONTRARY] = "the contrary is shown",
};

const ethd__cell *ethd__cell_find(const ethd__cell *cells, size_t count, const char *law, const char *speed) {
  for (size_t i = 0; i < count; i++)
    if (!strcmp(cells[i].law, law) && !strcmp(cells[i].speed->word, speed)) return &cells[i];
  return NULL;
}

static double *numbers(size_t n) {
  double *out = malloc((n + 1) * sizeof *out);
  if (!out) ethd__fail_memory();
  return out;
}

/* Moves the numbers that there are to the front; how many. */
static size_t drop_missing(double *values, size_t n) {
  size_t kept = 0;
  for (size_t i = 0; i < n; i++)
    if (!isnan(values[i])) values[kept++] = values[i];
  return kept;
}

/* ---- figures of a tap ---- */

#define OF(name, expression) \
  static double name(const ethd__metrics *m) { return expression; }
OF(d_max_mm, 1e3 * m->d_max)
OF(v_of, m->v_of)
OF(v_of_size, fabs(m->v_of))
OF(v_rmin, m->v_rmin)
OF(v_rmin_size, fabs(m->v_rmin))
OF(delta_s, m->delta_s)
OF(eps_mm, 1e3 * m->eps)
OF(with_finger, isnan(m->v_of) ? NAN : 100 * (m->v_of > 0))
OF(is_valid, 100 * (m->reason == ETHD_TAP_OK))

/* ---- Table 1 ---- */

void ethd__means(const ethd__sample *t, ethd__mean out[ETHD_TAP_MEANS]) {
  static const struct {
    const char *name, *unit, *speed;
    size_t field;
    ethd__tap_value *of;
    double scale, mean, sd;
  } table[ETHD_TAP_MEANS] = {
      {"Delta_s, low", "ms", "low", ETHD_TAP_FIELD(delta_s), delta_s, 1, 3.111, 2.804},
      {"eps, low", "mm", "low", ETHD_TAP_FIELD(eps), eps_mm, 1e3, 0.388, 0.251},
      {"Delta_s, high", "ms", "high", ETHD_TAP_FIELD(delta_s), delta_s, 1, 14.556, 1.424},
      {"eps, high", "mm", "high", ETHD_TAP_FIELD(eps), eps_mm, 1e3, 2.434, 0.357},
  };
  double *own = numbers(t->people);
  for (int i = 0; i < ETHD_TAP_MEANS; i++) {
    const ethd__cell *cell = ethd__cell_find(t->cells, t->count, "offset", table[i].speed);
    ethd__mean *m = &out[i];
    *m = (ethd__mean){.name = table[i].name, .unit = table[i].unit, .paper = table[i].mean, .paper_sd = table[i].sd};
    m->here = cell ? ethd__cell_figure(cell, table[i].field) : (ethd__figure){0, NAN, NAN};
    m->here.mean *= table[i].scale, m->here.sd *= table[i].scale;
    ethd__people_figure(cell, table[i].of, ETHD_PERSON_MEAN, t->people, own);
    m->people = drop_missing(own, t->people);
    m->average = ethd__mean_of(own, m->people);
    ethd__equivalence e = ethd__equivalent(own, m->people, m->paper - m->paper_sd, m->paper + m->paper_sd);
    m->low = e.low, m->high = e.high, m->p = e.p;
    if (m->people < ETHD_STATISTICS_PEOPLE) continue;
    m->verdict = e.p < LEVEL ? ETHD_TAP_SHOWN : e.outside ? ETHD_TAP_CONTRARY : ETHD_TAP_OPEN;
  }
  free(own);
}

/* ---- contrasts ---- */

enum { SMOOTH_LOW, OFFSET_LOW, SMOOTH_HIGH, OFFSET_HIGH, CELLS };

/* Weights of the four cells; people who lack one with a weight are left out. */
typedef struct contrast {
  const char *what, *unit;
  ethd__tap_value *of;
  ethd__person_figure figure;
  double weight[CELLS];
  double from, to;
  size_t margin; /* of ethd__margins: the place of a margin that stands for `from` and `to`, in `scale`; */
  double scale;  /* 0: the two are as they stand */
} contrast;

typedef struct sentence {
  const char *text;
  contrast part[ETHD_TAP_PARTS_MAX];
} sentence;

#define MARGIN(name, scale) 0, 0, offsetof(ethd__margins, name), scale
#define ABOVE(x) x, INFINITY, 0, 0
#define BELOW(x) -INFINITY, x, 0, 0
#define MEDIAN ETHD_PERSON_MEDIAN
#define MEAN ETHD_PERSON_MEAN
#define MOST ETHD_PERSON_MOST
static const sentence sentences[] = {
    {"low speed: smooth and offset are alike in d_max, v_of and v_rmin",
     {{"d_max: offset - smooth", "mm", d_max_mm, MEDIAN, {-1, 1, 0, 0}, MARGIN(d_max, 1e3)},
      {"v_of: offset - smooth", "m/s", v_of, MEDIAN, {-1, 1, 0, 0}, MARGIN(v_of, 1)},
      {"v_rmin: offset - smooth", "m/s", v_rmin, MEDIAN, {-1, 1, 0, 0}, MARGIN(v_rmin, 1)}}},
    {"high speed: smooth rebounds several times as far as offset (more than 3 times)",
     {{"d_max: smooth - 3 offset", "mm", d_max_mm, MEDIAN, {0, 0, 1, -3}, ABOVE(0)}}},
    {"high speed: smooth rebounds much faster than offset (more than twice as fast)",
     {{"|v_rmin|: smooth - 2 offset", "m/s", v_rmin_size, MEDIAN, {0, 0, 1, -2}, ABOVE(0)}}},
    {"high speed: the ring's speed at the touch is nearer to zero under offset",
     {{"|v_of|: smooth - offset", "m/s", v_of_size, MEDIAN, {0, 0, 1, -1}, ABOVE(0)}}},
    {"high speed: in at least 25 % of the taps under offset the ring moves with the finger",
     {{"share of v_of > 0: offset", "%", with_finger, MEAN, {0, 0, 0, 1}, ABOVE(25)}}},
    {"the strategies differ more at high speed than at low, in d_max, |v_of| and |v_rmin|",
     {{"d_max: (smooth - offset), high - low", "mm", d_max_mm, MEDIAN, {-1, 1, 1, -1}, ABOVE(0)},
      {"|v_of|: (smooth - offset), high - low", "m/s", v_of_size, MEDIAN, {-1, 1, 1, -1}, ABOVE(0)},
      {"|v_rmin|: (smooth - offset), high - low", "m/s", v_rmin_size, MEDIAN, {-1, 1, 1, -1}, ABOVE(0)}}},
    {"high speed: 20 to 30 % of the taps are valid, as 10 to 15 taps were needed for three",
     {{"valid taps: mean of smooth and offset", "%", is_valid, ETHD_PERSON_ATTEMPTS, {0, 0, 0.5, 0.5}, 20, 30, 0, 0}}},
    {"the ring is stopped in practice in less than 20 ms",
     {{"longest Delta_s: offset, low", "ms", delta_s, MOST, {0, 1, 0, 0}, BELOW(20)},
      {"longest Delta_s: offset, high", "ms", delta_s, MOST, {0, 0, 0, 1}, BELOW(20)}}},
    {"the offset of the wall remains below 3 mm",
     {{"largest eps: offset, low", "mm", eps_mm, MOST, {0, 1, 0, 0}, BELOW(3)},
      {"largest eps: offset, high", "mm", eps_mm, MOST, {0, 0, 0, 1}, BELOW(3)}}},
};
enum { SENTENCES = sizeof sentences / sizeof *sentences };
_Static_assert(SENTENCES + 1 == ETHD_TAP_CLAIMS, "and the one of early touches");

/* Each person's contrast, NaN where the person lacks a part of it. Only cells `from` up to `end` count. */
static void contrast_of(const ethd__sample *t, const contrast *c, int from, int end, double *out) {
  static const char *const laws[CELLS] = {"smooth", "offset", "smooth", "offset"}, *const speeds[CELLS] = {
                                                                                       "low", "low", "high", "high"};
  double *own = numbers(t->people);
  for (size_t p = 0; p < t->people; p++) out[p] = 0;
  for (int k = from; k < end; k++) {
    if (c->weight[k] == 0) continue;
    const ethd__cell *cell = ethd__cell_find(t->cells, t->count, laws[k], speeds[k]);
    ethd__people_figure(cell, c->of, c->figure, t->people, own);
    for (size_t p = 0; p < t->people; p++) out[p] += c->weight[k] * own[p];
  }
  free(own);
}

static ethd__verdict verdict_beyond(double p, bool right_side) {
  return !(p < LEVEL) ? ETHD_TAP_OPEN : right_side ? ETHD_TAP_SHOWN : ETHD_TAP_CONTRARY;
}

/* Above `from` or below `to`. */
static void judge_beyond(ethd__claim_part *out, double *values, uint64_t seed) {
  ethd__paired shifted;
  bool above = isinf(out->to);
  for (size_t i = 0; i < out->people; i++) values[i] = above ? values[i] - out->from : out->to - values[i];
  ethd__compare(values, out->people, seed, &shifted);
  out->test = "sign flip";
  out->p = shifted.p;
  if (above && out->from == 0) out->d_z = shifted.d_z;
  out->verdict = verdict_beyond(out->p, shifted.mean > 0);
}

static void judge_between(ethd__claim_part *out, const double *values) {
  ethd__equivalence e = ethd__equivalent(values, out->people, out->from, out->to);
  out->test = "TOST";
  out->p = e.p;
  out->verdict = e.p < LEVEL ? ETHD_TAP_SHOWN : e.outside ? ETHD_TAP_CONTRARY : ETHD_TAP_OPEN;
}

/* A difference of differences that too few people have whole: those who have the strategies' difference at one speed
   alone count, too. */
static void judge_overlap(const ethd__sample *t, const contrast *c, ethd__claim_part *out) {
  double *low = numbers(t->people), *high = numbers(t->people);
  contrast_of(t, c, SMOOTH_LOW, SMOOTH_HIGH, low);
  contrast_of(t, c, SMOOTH_HIGH, CELLS, high);
  for (size_t p = 0; p < t->people; p++) low[p] = -low[p];
  ethd__overlap o = ethd__overlapping(high, low, t->people);
  free(low);
  free(high);
  if (o.first < ETHD_STATISTICS_PEOPLE || o.second < ETHD_STATISTICS_PEOPLE || isnan(o.p)) return;
  out->test = "overlap";
  out->people = o.first + o.second - o.both;
  out->at[0] = o.second, out->at[1] = o.first;
  out->mean = o.difference, out->low = o.low, out->high = o.high, out->p = o.p;
  out->verdict = verdict_beyond(o.p, o.difference > 0);
}

static bool is_interaction(const contrast *c) {
  double low = c->weight[SMOOTH_LOW] + c->weight[OFFSET_LOW], high = c->weight[SMOOTH_HIGH] + c->weight[OFFSET_HIGH];
  return low == 0 && high == 0 && c->weight[SMOOTH_LOW] != 0 && c->weight[SMOOTH_HIGH] != 0 && c->from == 0;
}

static void test_part(const ethd__sample *t, const contrast *c, ethd__claim_part *out) {
  double margin = c->scale > 0 ? c->scale * *(const double *)((const char *)&t->margins + c->margin) : 0;
  double *values = numbers(t->people);
  ethd__paired plain;
  *out = (ethd__claim_part){
      .what = c->what, .unit = c->unit, .from = c->from, .to = c->to, .p = NAN, .d_z = NAN, .test = ""};
  if (c->scale > 0) out->from = -margin, out->to = margin;
  contrast_of(t, c, 0, CELLS, values);
  out->people = drop_missing(values, t->people);
  ethd__compare(values, out->people, t->seed, &plain);
  out->mean = plain.mean, out->low = plain.interval.low, out->high = plain.interval.high;
  if (out->people < ETHD_STATISTICS_PEOPLE) {
    if (is_interaction(c)) judge_overlap(t, c, out);
  } else if (isinf(out->to) || isinf(out->from)) {
    judge_beyond(out, values, t->seed);
  } else {
    judge_between(out, values);
  }
  free(values);
}

/* ---- sentences ---- */

static void conclude(ethd__tap_claim *c) {
  c->p = 0;
  for (size_t i = 0; i < c->parts; i++) {
    const ethd__claim_part *part = &c->part[i];
    /* a part that points the other way speaks for nothing, however small its p */
    bool away = (isinf(part->to) && part->mean < part->from) || (isinf(part->from) && part->mean > part->to);
    double p = part->verdict == ETHD_TAP_CONTRARY || away ? 1 : part->p;
    c->p = isnan(p) || isnan(c->p) ? NAN : fmax(c->p, p);
  }
}

static ethd__verdict verdict_of(const ethd__tap_claim *c) {
  bool contrary = false;
  for (size_t i = 0; i < c->parts; i++) contrary |= c->part[i].verdict == ETHD_TAP_CONTRARY;
  if (isnan(c->p)) return ETHD_TAP_UNKNOWN;
  if (contrary) return ETHD_TAP_CONTRARY;
  return c->holm < LEVEL ? ETHD_TAP_SHOWN : ETHD_TAP_OPEN;
}

void ethd__claims(const ethd__sample *t, ethd__tap_claim out[ETHD_TAP_CLAIMS]) {
  double p[ETHD_TAP_CLAIMS];
  for (int i = 0; i < SENTENCES; i++) {
    out[i] = (ethd__tap_claim){.text = sentences[i].text};
    for (int k = 0; k < ETHD_TAP_PARTS_MAX && sentences[i].part[k].what; k++)
      test_part(t, &sentences[i].part[k], &out[i].part[out[i].parts++]);
  }
  ethd__early_claim(t, &out[SENTENCES]);
  for (int i = 0; i < ETHD_TAP_CLAIMS; i++) conclude(&out[i]), p[i] = out[i].p;
  ethd__holm(p, ETHD_TAP_CLAIMS);
  for (int i = 0; i < ETHD_TAP_CLAIMS; i++) out[i].holm = p[i], out[i].verdict = verdict_of(&out[i]);
}
