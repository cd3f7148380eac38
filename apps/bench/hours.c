/* Simulated hours per CPU hour: the closed loop of device, controller and record, tap after tap. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "tap/study.h"

#define GOAL 5000.0
#define REST 0.15    /* s: after the path's end */
#define TRUEST 1e-13 /* m/s: tolerance of the reference */

static const double tolerances[] = {1e-3, ETHD_SIM_FAST, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, ETHD_SIM_GOLDEN, 1e-11, 1e-12};

enum { TAPS = 8, TICKS = 1500, ROUNDS_MAX = 64, TOLERANCES = sizeof tolerances / sizeof *tolerances };

typedef struct closed_loop {
  ethd__stage stage;
  ethd__study study;
  ethd__speed speeds[2];
  ethd_config *config;
  ethd_sim *sim;
  ethd_trace trace[TICKS];
  ethd_truth truth[TICKS];
} closed_loop;

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

static void open_loop(closed_loop *l, const char *law) {
  char message[ETHD_MESSAGE_MAX], *plant = ethd__data_path("n.plant"), *controller = ethd__data_path("n.ini");
  check(ethd_config_load(controller, &l->config, message), message);
  check(ethd_plant_load(plant, &l->study.plant, message), message);
  ethd__speed_parse("low", &l->study.plant, &l->speeds[0]);
  ethd__speed_parse("high", &l->study.plant, &l->speeds[1]);
  l->study.config = l->config;
  l->study.seed = 1;
  l->study.speeds = l->speeds;
  l->study.speed_count = 2;
  check(ethd__study_prepare(&l->study, message), message);
  check(ethd__stage_open(&l->study, law, &l->stage, message), message);
  free(plant);
  free(controller);
}

static void close_loop(closed_loop *l) {
  ethd__stage_close(&l->stage);
  ethd_config_free(l->config);
}

/* Errors are measured with ideal encoders, because a count that turns over a moment earlier is a step of 40 um, not an
   error. */
static void use(closed_loop *l, double tolerance, int ideal) {
  ethd_sim_def def = {.plant = l->study.plant,
                      .arm = l->stage.setup.arm,
                      .ring_radius = l->stage.setup.ring_radius,
                      .period = l->stage.setup.period,
                      .step = l->stage.setup.period,
                      .tolerance = tolerance};
  ethd_error error;
  if (ideal) def.plant.count = 0;
  ethd_sim_destroy(l->sim);
  check(ethd_sim_create(&def, &l->sim, &error), error.name);
}

/* Runs one tap; returns its ticks. */
static size_t tap(closed_loop *l, int number, int truth) {
  ethd_sim_tap circumstances;
  ethd_sense sense;
  ethd_command command;
  check(ethd__stage_draw(&l->stage, &l->speeds[number & 1], (uint64_t)(number / 2), &circumstances), "a tap");
  check(ethd_sim_start(l->sim, &circumstances), "a tap begins out of reach");
  ethd_control_reset(l->stage.control);
  double seconds = ethd_path_end(&circumstances.path) + REST;
  size_t ticks = (size_t)fmin(TICKS, seconds / l->stage.setup.period);
  for (size_t k = 0; k < ticks; k++) {
    ethd_sim_read(l->sim, &sense);
    if (truth) ethd_sim_truth(l->sim, &l->truth[k]);
    (void)!ethd_control_step(l->stage.control, &sense, &command, &l->trace[k]);
    ethd_sim_write(l->sim, &command);
  }
  return ticks;
}

static double cpu(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Returns CPU seconds per simulated second, with the truth recorded or not. */
static double cost(closed_loop *l, double tolerance, int truth) {
  size_t ticks = 0;
  use(l, tolerance, 0);
  double start = cpu();
  for (int i = 0; i < TAPS; i++) ticks += tap(l, i, truth);
  return (cpu() - start) / ((double)ticks * l->stage.setup.period);
}

/* Contenders run in turns; the lower quartile counts, because other programs disturb it least. */
static void race(closed_loop *l, int rounds, double out[TOLERANCES][2]) {
  static double each[TOLERANCES][2][ROUNDS_MAX];
  for (int r = 0; r < rounds; r++)
    for (int i = 0; i < 2 * TOLERANCES; i++) each[i / 2][i % 2][r] = cost(l, tolerances[i / 2], i % 2);
  for (int i = 0; i < 2 * TOLERANCES; i++) {
    (void)ethd__bench_percentiles(each[i / 2][i % 2], (size_t)rounds);
    out[i / 2][i % 2] = each[i / 2][i % 2][rounds / 4];
  }
}

static double apart(const double *a, const double *b) { return hypot(a[0] - b[0], a[1] - b[1]); }

static double error_of(closed_loop *l, double tolerance) {
  static ethd_truth reference[TAPS][TICKS];
  double worst = 0;
  use(l, TRUEST, 1);
  for (int i = 0; i < TAPS; i++) {
    size_t ticks = tap(l, i, 1);
    memcpy(reference[i], l->truth, ticks * sizeof *l->truth);
  }
  use(l, tolerance, 1);
  for (int i = 0; i < TAPS; i++) {
    size_t ticks = tap(l, i, 1);
    for (size_t k = 0; k < ticks; k++) {
      const ethd_truth *a = &reference[i][k], *b = &l->truth[k];
      double e = fmax(apart(a->ring, b->ring), apart(a->finger, b->finger));
      worst = e <= worst ? worst : e; /* takes NaN too */
    }
  }
  return worst;
}

/* Returns the name of the setting that has this tolerance, "" if there is none. */
static const char *name_of(double tolerance) {
  return tolerance == ETHD_SIM_FAST ? "fast" : tolerance == ETHD_SIM_GOLDEN ? "golden" : "";
}

static void judge(double tolerance, double error, double time) {
  double most = tolerance == ETHD_SIM_FAST ? 1e-6 : 1e-8;
  if (!*name_of(tolerance)) return;
  if (tolerance == ETHD_SIM_FAST)
    printf("  goal: %.0f hours at the fast setting: %.0f, %s\n", GOAL, 1 / time, ethd__bench_verdict(1 / time >= GOAL));
  printf("  goal: error of the %s setting at most %.0e m: %.1e, %s\n", name_of(tolerance), most, error,
         ethd__bench_verdict(error <= most));
}

static int run(const char *folder, int quick) {
  static closed_loop l;
  double times[TOLERANCES][2];
  FILE *csv = ethd__bench_csv(
      folder, "hours",
      "# closed loop of plant n and law offset, 8 taps; error: largest distance of ring or finger\n"
      "# from the same loop at tolerance 1e-13, both with ideal encoders; time: CPU, of a simulated\n"
      "# second, the controller's ticks and their record included; truth: recorded, too, at each tick\n",
      "setting,tolerance,error_m,time_s,time_truth_s,hours_per_cpu_hour");
  open_loop(&l, "offset");
  printf("hours: closed loop of plant n, law offset and record, %d taps, simulated\n", TAPS);
  printf("  %-8s %9s %11s %10s %10s %18s\n", "", "tolerance", "error, m", "us/s", "with truth", "hours per CPU hour");
  race(&l, quick ? 16 : ROUNDS_MAX, times);
  for (size_t i = 0; i < TOLERANCES; i++) {
    double t = tolerances[i], error = error_of(&l, t), time = times[i][0], truth = times[i][1];
    printf("  %-8s %9.0e %11.2e %10.1f %10.1f %18.0f\n", name_of(t), t, error, 1e6 * time, 1e6 * truth, 1 / time);
    fprintf(csv, "%s,%.17g,%.17g,%.17g,%.17g,%.17g\n", name_of(t), t, error, time, truth, 1 / time);
    judge(t, error, time);
  }
  ethd_sim_destroy(l.sim);
  l.sim = NULL;
  close_loop(&l);
  return ethd__bench_close();
}

const ethd__bench ethd__bench_hours = {"hours", "simulated hours per CPU hour", run};
