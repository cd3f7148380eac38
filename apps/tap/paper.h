/* The paper's statements on its device, as lines with bounds: Table 1, the sentences of sections 3 and 4, and gains that
   are "the highest possible while remaining stable". */
#ifndef ETHD__APPS_TAP_PAPER_H
#define ETHD__APPS_TAP_PAPER_H

#include "tap/study.h"

/* A mean of Table 1 has the 95 % interval of the paper's nine taps (2.306 standard errors), a standard deviation that of
   its chi-squared distribution with 8 degrees of freedom. */
#define ETHD_PAPER_MEAN(mean, sd) (mean) - 0.76867 * (sd), (mean) + 0.76867 * (sd)
#define ETHD_PAPER_SD(sd) 0.67545 * (sd), 1.91576 * (sd)

/* X(name, group, low, high, unit, description) */
#define ETHD_PAPER_LINES(X)                                                                   \
  X(ds_low, table, ETHD_PAPER_MEAN(3.11, 2.80), "ms", "mean Delta_s, low")                    \
  X(ds_low_sd, table, ETHD_PAPER_SD(2.80), "ms", "sd of Delta_s, low")                        \
  X(eps_low, table, ETHD_PAPER_MEAN(0.388, 0.251), "mm", "mean eps, low")                     \
  X(eps_low_sd, table, ETHD_PAPER_SD(0.251), "mm", "sd of eps, low")                          \
  X(ds_high, table, ETHD_PAPER_MEAN(14.56, 1.42), "ms", "mean Delta_s, high")                 \
  X(ds_high_sd, table, ETHD_PAPER_SD(1.42), "ms", "sd of Delta_s, high")                      \
  X(eps_high, table, ETHD_PAPER_MEAN(2.434, 0.357), "mm", "mean eps, high")                   \
  X(eps_high_sd, table, ETHD_PAPER_SD(0.357), "mm", "sd of eps, high")                        \
  X(alike_d_max, taps, -0.3, 0.3, "mm", "low: d_max, offset - smooth")                        \
  X(alike_v_of, taps, -0.02, 0.02, "m/s", "low: v_of, offset - smooth")                       \
  X(alike_v_rmin, taps, -0.02, 0.02, "m/s", "low: v_rmin, offset - smooth")                   \
  X(times_d_max, taps, 3, INFINITY, "", "high: d_max, smooth / offset")                       \
  X(times_v_rmin, taps, 2, INFINITY, "", "high: |v_rmin|, smooth / offset")                   \
  X(times_v_of, taps, 1, INFINITY, "", "high: |v_of|, smooth / offset")                       \
  X(with_finger, taps, 0.25, 1, "", "high: share of v_of > 0, offset")                        \
  X(early, taps, 0.4, 0.6, "m/s", "speed from which the finger touches early")                \
  X(under_20, taps, 0.9, 1, "", "high: share of Delta_s under 20 ms")                         \
  X(under_3, taps, 0.9, 1, "", "high: share of eps under 3 mm")                               \
  X(vo_first, taps, 0.9, 1, "", "high: share of offset with vo before the touch")             \
  X(holds, taps, 0.9, 1, "", "high: share of offset within 1 mm of x_eps for 60 ms")          \
  X(smooth_low, taps, 0, 0.05, "m/s", "low: |v_of|, smooth")                                  \
  X(smooth_ratio, taps, 0, 0.5, "", "|v_of|, smooth, low / high")                             \
  X(turns, taps, 1, INFINITY, "", "high: turns over 0.3 mm within 100 ms, smooth")            \
  X(turns_ratio, taps, 0, 0.5, "", "high: these turns, offset / smooth")                      \
  X(attempts_low, taps, 10, 15, "", "low: attempts for three valid taps")                     \
  X(attempts_high, taps, 10, 15, "", "high: attempts for three valid taps")                   \
  X(slightly, taps, 1, 2, "", "low: |v_rmin|, smooth / offset")                               \
  X(limit_k_t, gains, 1.2, INFINITY, "", "first K_t without rest, times the configuration's") \
  X(limit_b_t, gains, 1.2, INFINITY, "", "first B_t")                                         \
  X(limit_k_e, gains, 1.2, INFINITY, "", "first K_e")                                         \
  X(limit_b_e, gains, 1.2, INFINITY, "", "first B_e")                                         \
  X(least_tracking, gains, 1.2, 2.5, "", "the lesser of K_t, B_t")                            \
  X(grows_tracking, gains, 2, INFINITY, "", "rms speed there / at half that gain")            \
  X(least_wall, gains, 1.2, 2.5, "", "the lesser of K_e, B_e")                                \
  X(grows_wall, gains, 2, INFINITY, "", "rms speed there / at half that gain")                \
  X(hum_tracking, gains, 0, 10, "mm/s", "rms speed at the configuration's gains, free")       \
  X(hum_wall, gains, 0, 10, "mm/s", "rms speed at the configuration's gains, pressing 2.5 N")

enum {
#define ETHD_PAPER_INDEX(name, ...) ETHD_PAPER_##name,
  ETHD_PAPER_LINES(ETHD_PAPER_INDEX)
#undef ETHD_PAPER_INDEX
      ETHD_PAPER_COUNT
};

/* Taps the wall under smooth and offset, `taps` times at low speed and twice as often at high speed, tries the gains,
   and prints each line with its value, its bounds, and whether it misses them. The study has the speeds low and high.
   [main] */
ETHD_MUST_CHECK ethd_status ethd__paper_print(const ethd__study *study, uint64_t taps, char message[ETHD_MESSAGE_MAX]);

/* Fills the lines of gains; NaN: the configuration's law has no such gain. A gain's ring no longer rests from the first
   multiple at which the speed of the measured side along n exceeds 20 mm/s (rms over 0.2 s, median of eight tries),
   with the finger at rest (tracking) or pressing 2.5 N (wall); 1: not even now, 8: at none that was tried. [main, in
   limits.c] */
ETHD_MUST_CHECK ethd_status ethd__paper_limits(const ethd__study *study, double out[ETHD_PAPER_COUNT],
                                               char message[ETHD_MESSAGE_MAX]);

#endif
