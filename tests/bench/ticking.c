/* What all parts of the tick's benchmark share: a controller that taps, and rows of tick.csv. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/tick.h"
#include "cli/cli.h"

/* ---- a controller that taps ---- */

ethd__ticking *ethd__ticking_create(const ethd_transition_law *law, ethd__tap_wall wall, size_t segments,
                                    ethd__tap_finger how) {
  ethd__ticking *t = aligned_alloc(64, (sizeof *t + 63) / 64 * 64);
  if (!t) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  memset(t, 0, sizeof *t);
  ethd_setup setup = ethd_setup_default();
  ethd__tap_senses(&setup, how, t->senses);
  t->scene = ethd__tap_scene(wall, segments);
  t->control = ethd__tap_control(law, t->scene);
  t->traced = 1;
  return t;
}

void ethd__ticking_destroy(ethd__ticking *t) {
  ethd_control_destroy(t->control);
  ethd_scene_destroy(t->scene);
  free(t);
}

const ethd_sense *ethd__ticking_sense(ethd__ticking *t) {
  const int64_t tap = 1000000 * (int64_t)ETHD__TAP_TICKS;
  ethd_sense *s = &t->senses[t->next++ % ETHD__TAP_TICKS];
  s->time_ns += tap;
  s->sample_ns += tap;
  return s;
}

void ethd__ticking_step(ethd__ticking *t, const ethd_sense *sense) {
  ethd_command command;
  ethd_trace *trace = t->traced ? &t->traces[t->next % ETHD__TICK_RING] : NULL;
  if (ethd_control_step(t->control, sense, &command, trace) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "tick %d is at fault", t->next);
}

/* ---- output ---- */

static void put(FILE *csv, ethd__tick_row row, const char *name, double share_longer, double ns) {
  fprintf(csv, "%s,%s,%s,%s,%s,%.17g,%.17g\n", row.what, row.law, row.scene, row.finger, name, share_longer, ns);
}

bench_times ethd__tick_report(FILE *csv, ethd__tick_row row, double *ns, size_t count, const bench_times *quiet) {
  bench_times t = bench_percentiles(ns, count);
  if (quiet) {
    t.mean = quiet->mean;
    t.median = quiet->median;
    t.p99 = quiet->p99;
  }
  printf("  %-10s %-8s %-7s %-8s %7.0f %7.0f %7.0f %8.0f %9.0f\n", row.what, row.law, row.scene, row.finger, t.mean,
         t.median, t.p99, t.p999, t.max);
  put(csv, row, "mean", NAN, t.mean);
  put(csv, row, "median", 0.5, t.median);
  put(csv, row, "p99", 0.01, t.p99);
  for (double share = 1; share * (double)count >= 1; share *= 0.8)
    put(csv, row, "tail", share, ns[count - (size_t)(share * (double)count)]);
  put(csv, row, "max", 0, t.max);
  return t;
}
