/* How far a plant is from what the paper says: Table 1's eight statistics, the paper's sentences, and gains that are
   "the highest possible while remaining stable". All [main]. */
#ifndef ETHD__APPS_EXPLAIN_JUDGE_H
#define ETHD__APPS_EXPLAIN_JUDGE_H

#include "explain/prior.h"

/* X(name, group, low, high, kind, unit, what it is). The bounds of a mean are 1.5 standard errors of the paper's nine
   taps to each side, those of a standard deviation an F test's two-sided 5 % with 8 degrees of freedom against many. */
#define ETHD_EXPLAIN_LINES(X)                                                              \
  X(ds_low, TABLE, 1.709, 4.513, MEAN, "ms", "mean Delta_s, low")                          \
  X(ds_low_sd, TABLE, 1.894, 5.371, RATIO, "ms", "sd of Delta_s, low")                     \
  X(eps_low, TABLE, 0.2625, 0.5135, MEAN, "mm", "mean eps, low")                           \
  X(eps_low_sd, TABLE, 0.1695, 0.4808, RATIO, "mm", "sd of eps, low")                      \
  X(ds_high, TABLE, 13.844, 15.268, MEAN, "ms", "mean Delta_s, high")                      \
  X(ds_high_sd, TABLE, 0.9618, 2.728, RATIO, "ms", "sd of Delta_s, high")                  \
  X(eps_high, TABLE, 2.2555, 2.6125, MEAN, "mm", "mean eps, high")                         \
  X(eps_high_sd, TABLE, 0.2411, 0.6838, RATIO, "mm", "sd of eps, high")                    \
  X(alike_d_max, CLAIMS, -0.3, 0.3, MEAN, "mm", "low: d_max, offset - smooth")             \
  X(alike_v_of, CLAIMS, -0.02, 0.02, MEAN, "m/s", "low: v_of, offset - smooth")            \
  X(alike_v_rmin, CLAIMS, -0.02, 0.02, MEAN, "m/s", "low: v_rmin, offset - smooth")        \
  X(times_d_max, CLAIMS, 3, INFINITY, RATIO, "1", "high: d_max, smooth / offset")          \
  X(times_v_rmin, CLAIMS, 2, INFINITY, RATIO, "1", "high: |v_rmin|, smooth / offset")      \
  X(times_v_of, CLAIMS, 1, INFINITY, RATIO, "1", "high: |v_of|, smooth / offset")          \
  X(with_finger, CLAIMS, 0.25, 1, RATIO, "1", "high: share of v_of > 0, offset")           \
  X(valid, CLAIMS, 0.2, 0.3, RATIO, "1", "high: share of valid taps")                      \
  X(early, CLAIMS, 0.4, 0.6, RATIO, "m/s", "speed from which on the finger touches early") \
  X(under_20, CLAIMS, 0.9, 1, RATIO, "1", "high: share of Delta_s under 20 ms")            \
  X(under_3, CLAIMS, 0.9, 1, RATIO, "1", "high: share of eps under 3 mm")                  \
  X(limit_k_t, LIMITS, 1.2, 2.5, RATIO, "1", "largest stable K_t, times the paper's")      \
  X(limit_b_t, LIMITS, 1.2, 2.5, RATIO, "1", "largest stable B_t")                         \
  X(limit_k_e, LIMITS, 1.2, 2.5, RATIO, "1", "largest stable K_e")                         \
  X(limit_b_e, LIMITS, 1.2, 2.5, RATIO, "1", "largest stable B_e")                         \
  X(limit_b_d, LIMITS, 1.2, 2.5, RATIO, "1", "largest stable B_d")

enum {
#define ETHD_EXPLAIN_INDEX(name, group, low, high, kind, unit, brief) ETHD_EXPLAIN_##name,
  ETHD_EXPLAIN_LINES(ETHD_EXPLAIN_INDEX)
#undef ETHD_EXPLAIN_INDEX
      ETHD_EXPLAIN_LINE_COUNT
};

typedef enum ethd__explain_group {
  ETHD_EXPLAIN_TABLE,
  ETHD_EXPLAIN_CLAIMS,
  ETHD_EXPLAIN_LIMITS,
  ETHD_EXPLAIN_GROUPS
} ethd__explain_group;

extern const char *const ethd__explain_group_names[ETHD_EXPLAIN_GROUPS];

typedef struct ethd__explain_figures {
  double value[ETHD_EXPLAIN_LINE_COUNT]; /* NaN: too few taps have this figure */
  bool known[ETHD_EXPLAIN_LINE_COUNT];   /* false: the figure wasn't asked for */
} ethd__explain_figures;

/* What is asked for. */
typedef struct ethd__explain_question {
  const ethd_config *config; /* has the paper's gains; in a search it is that of plant n */
  ethd_plant base;
  ethd__explain_structure structure;
  bool asked[ETHD_EXPLAIN_GROUPS]; /* which groups count */
  uint64_t seed;
  uint32_t taps; /* of each law at low speed; at high speed there are twice as many */
} ethd__explain_question;

/* Returns how far a line's value is outside of its bounds: 0 if it is within, more than 1 if it clearly misses them.
   With `inner` the bounds are a tenth narrower on either side, so that a search doesn't stop at their edge. */
double ethd__explain_miss(int line, double value, bool inner);

static inline void ethd__explain_set(ethd__explain_figures *figures, int line, double value) {
  figures->value[line] = value;
  figures->known[line] = true;
}

/* Fills the figures of the groups that count, the cheap ones first. *total becomes the sum of the lines' misses of
   their inner bounds, each at most 4; once it is over `enough` the remaining figures aren't asked for. */
ETHD_MUST_CHECK ethd_status ethd__explain_judge(const ethd__explain_question *question, const ethd__explain_twin *twin,
                                                double enough, ethd__explain_figures *out, double *total,
                                                char message[ETHD_MESSAGE_MAX]);

/* Fills the limits of the gains: the largest stable multiple of each while the others stay as they are. [in
   limits.c] */
ETHD_MUST_CHECK ethd_status ethd__explain_limits(const ethd__study *study, ethd__explain_figures *out,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Where a value lies in its line's bounds: 0 at the lower one, 1 at the upper one, evenly as its misses count. Without
   an upper bound what is met lies between 0 and 1, too. */
double ethd__explain_place(int line, double value);

/* Writes each line of each plant as a row: its bounds, the value, its place in the bounds, whether it is met. */
ETHD_MUST_CHECK ethd_status ethd__explain_csv(const char *path, const char *const *names,
                                              const ethd__explain_figures *figures, size_t count,
                                              char message[ETHD_MESSAGE_MAX]);

/* Prints every line with its bounds and whether it is met; returns how many aren't. */
int ethd__explain_print(const ethd__explain_figures *figures);

#endif
