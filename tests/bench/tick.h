/* Parts of the tick's benchmark. */
#ifndef ETHD_TESTS_BENCH_TICK_H
#define ETHD_TESTS_BENCH_TICK_H

#include "bench/bench.h"
#include "bench/tap_track.h"

enum { ETHD__TICK_RING = 64 }; /* traces that are kept: a recorder's buffer, in the cache */

/* A controller that taps endlessly; `next` is its tick. */
typedef struct ethd__ticking {
  ethd_control *control;
  ethd_scene *scene;
  int traced, next;
  ethd_sense senses[ETHD__TAP_TICKS];
  ethd_trace traces[ETHD__TICK_RING];
} ethd__ticking;

ethd__ticking *ethd__ticking_create(const ethd_transition_law *law, ethd__tap_wall wall, size_t segments,
                                    ethd__tap_finger how);
void ethd__ticking_destroy(ethd__ticking *t);

/* Makes the next tick's sense, then runs the tick. */
const ethd_sense *ethd__ticking_sense(ethd__ticking *t);
void ethd__ticking_step(ethd__ticking *t, const ethd_sense *sense);

/* Rows of tick.csv. */
typedef struct ethd__tick_row {
  const char *what, *law, *scene, *finger;
} ethd__tick_row;

/* Prints a line and writes mean, percentiles and the tail; sorts `ns`. `quiet` (NULL: none): mean,
   median and p99 without disturbances by other programs. */
bench_times ethd__tick_report(FILE *csv, ethd__tick_row row, double *ns, size_t count, const bench_times *quiet);

/* Measure ticks cold, with the caches emptied before them, and live, in a 1 kHz loop. */
void ethd__tick_cold(FILE *csv, int quick);
void ethd__tick_live(FILE *csv, int quick);

/* Prints what a tick in space costs beside an entry of the plane's, and judges it. */
void ethd__tick_space(const bench_entry *plane, int quick);

/* Prints what the surfaces of a mesh cost in a tick. */
void ethd__tick_mesh(int quick);

#endif
