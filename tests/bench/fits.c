/* Finger fits: the centre's error against the Cramer-Rao bound of the same rays and noise, and ns a fit. */
#include <math.h>

#include "bench/bench.h"
#include "bench/fit_trials.h"
#include "cli/cli.h"
#include "ethd/ethd.h"

enum { TRIALS_MAX = 40000, TIMED = 512 };

static fit_trial trials[TRIALS_MAX];

static ethd_fit prepare(ethd_fit_method method) {
  double p[ETHD_PARAMS_MAX];
  ethd_fit fit;
  ethd_error error;
  ethd_params_default(ethd_fit_methods[method].params, ethd_fit_methods[method].param_count, p);
  if (ethd_fit_prepare(method, p, FIT_RING, FIT_FINGER, &fit, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  return fit;
}

static void work(void *data) {
  const ethd_fit *fit = data;
  ethd_finger finger;
  double sum = 0;
  for (int i = 0; i < TIMED; i++)
    if (ethd_fit_step(fit, trials[i].r, &finger) == ETHD_OK) sum += finger.centre.x;
  bench_sink = sum;
}

static double rms_error(const ethd_fit *fit, int count) {
  double sum = 0;
  for (int i = 0; i < count; i++) {
    ethd_finger finger;
    if (ethd_fit_step(fit, trials[i].r, &finger) != ETHD_OK)
      ethd__fail(ETHD_EXIT_FAILED, "%s: no fit", ethd_fit_methods[fit->method].id);
    ethd_vec e = ethd_vec_sub(finger.centre, trials[i].centre);
    sum += ethd_vec_dot(e, e);
  }
  return sqrt(sum / count);
}

/* Returns the rms bound over the trials, m. */
static double rms_bound(int count, int known) {
  double sum = 0;
  for (int i = 0; i < count; i++) sum += trials[i].bound[known];
  return sqrt(sum / count);
}

typedef struct fit_figure {
  double error, ns;
} fit_figure;

static void judge(fit_figure f[FIT_SCENARIOS][ETHD_FIT_COUNT], double bounds[FIT_SCENARIOS][2]) {
  double slowest = 0;
  for (int s = 0; s < FIT_SCENARIOS; s++)
    slowest = fmax(slowest, fmax(f[s][ETHD_FIT_KASA].ns, f[s][ETHD_FIT_ROBUST].ns));
  bench_goal("kasa, 16 rays", f[0][ETHD_FIT_KASA].error / bounds[0][0], 1.05, "x the bound");
  bench_goal("robust, 16 rays", f[0][ETHD_FIT_ROBUST].error / bounds[0][1], 1.05, "x the bound");
  bench_goal("robust, 8 rays", 1e3 * f[1][ETHD_FIT_ROBUST].error, 0.13, "mm");
  bench_goal("robust, one outlier", 1e3 * f[2][ETHD_FIT_ROBUST].error, 0.10, "mm");
  bench_goal("kasa and robust, the slowest of all", slowest, 150, "ns");
}

static void measure(const fit_scenario *what, int count, double seconds, fit_figure out[ETHD_FIT_COUNT],
                    double bounds[2]) {
  ethd_fit fits[ETHD_FIT_COUNT];
  bench_entry entries[ETHD_FIT_COUNT];
  for (int i = 0; i < count; i++) fit_try((uint64_t)i, what, &trials[i]);
  for (int m = 0; m < ETHD_FIT_COUNT; m++) {
    fits[m] = prepare((ethd_fit_method)m);
    entries[m] = (bench_entry){ethd_fit_methods[m].id, work, &fits[m], TIMED, 0};
  }
  bench_race(entries, ETHD_FIT_COUNT, seconds);
  for (int m = 0; m < ETHD_FIT_COUNT; m++) out[m] = (fit_figure){rms_error(&fits[m], count), entries[m].ns};
  for (int known = 0; known < 2; known++) bounds[known] = rms_bound(count, known);
}

void bench_fits(const char *folder, int quick) {
  fit_figure f[FIT_SCENARIOS][ETHD_FIT_COUNT];
  double bounds[FIT_SCENARIOS][2];
  FILE *csv = bench_csv(folder, "fits",
                        "# 16 rays of normal noise, sd 0.173 mm (as +-0.3 mm uniform); ring 12 mm, finger "
                        "7.5 mm within 4 mm of its middle; error: rms, m\n"
                        "# bound: Cramer-Rao, the radius sought or known, rms over the same trials\n",
                        BENCH_RACE);
  printf("ring fits: rms error of the centre, mm, and ns a fit; bound: Cramer-Rao, radius sought / "
         "known\n");
  printf("  %-40s", "");
  for (int m = 0; m < ETHD_FIT_COUNT; m++) printf(" %16s", ethd_fit_methods[m].id);
  printf(" %16s\n", "bound");
  for (int s = 0; s < FIT_SCENARIOS; s++) {
    measure(&fit_scenarios[s], quick ? 10000 : TRIALS_MAX, quick ? 0.1 : 1, f[s], bounds[s]);
    printf("  %-40s", fit_scenarios[s].name);
    for (int m = 0; m < ETHD_FIT_COUNT; m++) {
      printf("  %6.4f %5.0f ns", 1e3 * f[s][m].error, f[s][m].ns);
      bench_row(csv, fit_scenarios[s].name, ethd_fit_methods[m].id, f[s][m].ns, f[s][m].error);
    }
    printf("  %6.4f / %6.4f\n", 1e3 * bounds[s][0], 1e3 * bounds[s][1]);
  }
  judge(f, bounds);
  bench_close();
}
