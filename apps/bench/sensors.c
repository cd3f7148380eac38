/* Sensors of the finger: taps at rising speed, the same hands for all; how far off the finger's estimate is on the way
   to the wall, how late, and how often the finger meets the ring before the wall does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "tap/study.h"

enum { SPEEDS = 6, SENSORS = 8 };

#define SETTLED 0.05 /* s: by then the filter has forgotten that it was told where the finger starts */

static const char *const speeds[SPEEDS] = {"0.2", "0.3", "0.4", "0.5", "0.6", "0.7"};

typedef struct finger_race {
  const char *name;
  int32_t reading, zones;
  bool silent; /* the readings' noise isn't told: all count alike, as the configuration says */
} finger_race;

static const finger_race sensors[SENSORS] = {
    {"16 rays", ETHD_READING_RAYS, 0, false},
    {"nail plate", ETHD_READING_NAIL, 0, false},
    {"16 zones", ETHD_READING_ZONES, 16, false},
    {"12 zones", ETHD_READING_ZONES, 12, false},
    {"12 zones (silent)", ETHD_READING_ZONES, 12, true},
    {"8 zones", ETHD_READING_ZONES, 8, false},
    {"camera 90 Hz", ETHD_READING_CAMERA, 0, false},
    {"camera (silent)", ETHD_READING_CAMERA, 0, true},
};

/* What taps of one sensor at one speed add up to. */
typedef struct approach_sums {
  double ticks, square, toward; /* of the estimate's error, squared, m^2; toward: along the wall's normal */
  double against, speed_square; /* error times speed, speed squared, along the normal */
  int taps, early;
} approach_sums;

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

/* The paper's controller on plant n with the filter that is the default. */
static ethd_config *load_config(void) {
  char message[ETHD_MESSAGE_MAX], *wall = ethd__data_path("wall.scene"), *absolute = realpath(wall, NULL), *text;
  ethd_config *config;
  if (!absolute || asprintf(&text,
                            "[finger]\nradius = 7.32e-3\nradius_max = 10.546e-3\n[velocity]\ncutoff = 133.4\n"
                            "[transition]\npreset = paper\n[scene]\nfile = %s\n",
                            absolute) < 0)
    ethd__fail_memory();
  check(ethd_config_parse(text, strlen(text), "sensors", NULL, &config, message), message);
  free(text);
  free(absolute);
  free(wall);
  return config;
}

static void load_study(const finger_race *race, const ethd_config *config, ethd__speed *speed, ethd__study *out) {
  char message[ETHD_MESSAGE_MAX], *plant = ethd__data_path("n.plant");
  *out = (ethd__study){.config = config, .seed = 1, .speeds = speed, .speed_count = 1};
  check(ethd_plant_load(plant, &out->plant, message), message);
  free(plant);
  ethd_plant_finger(&out->plant, race->reading);
  if (race->zones) out->plant.zones = race->zones;
  check(ethd__study_prepare(out, message), message);
}

/* ---- a tap ---- */

/* The rows of one tap, up to the wall or a little after it. */
static void play(ethd__stage *stage, const ethd_sim_tap *tap, const finger_race *race, double last) {
  ethd__tap_rows *rows = &stage->rows;
  rows->count = 0;
  ethd_control_reset(stage->control);
  check(ethd_sim_start(stage->sim, tap), "a tap begins out of reach");
  for (bool on = true; on;) {
    ethd_sense sense;
    ethd_command command;
    check(ethd__tap_rows_room(rows), "no memory");
    ethd_trace *trace = &rows->trace[rows->count];
    ethd_truth *truth = &rows->truth[rows->count];
    ethd_sim_read(stage->sim, &sense);
    if (race->silent) sense.finger_noise = 0;
    ethd_sim_truth(stage->sim, truth);
    (void)!ethd_control_step(stage->control, &sense, &command, trace);
    ethd_sim_write(stage->sim, &command);
    on = truth->t < last;
    rows->count++;
  }
}

static void add_tick(const ethd_trace *trace, const ethd_truth *truth, ethd_vec n, approach_sums *s) {
  ethd_vec e = ethd_vec_sub(ethd_vec_of(trace->xf), ethd_vec_of(truth->finger));
  double v = ethd_vec_dot(n, ethd_vec_of(truth->finger_v));
  s->ticks++;
  s->square += ethd_vec_dot(e, e);
  s->toward += ethd_vec_dot(n, e) * ethd_vec_dot(n, e);
  s->against += ethd_vec_dot(n, e) * v;
  s->speed_square += v * v;
}

/* The way to the wall ends where the ring meets it or the finger the ring. */
static void add_tap(const ethd__stage *stage, const ethd__rule *rule, approach_sums *s) {
  const ethd__tap_rows *rows = &stage->rows;
  size_t end = ethd__metrics_meeting(rows, rule);
  for (size_t k = 0; k < end; k++) {
    if (rows->truth[k].pad > 0) end = k;
    if (k < end && rows->truth[k].t > SETTLED) add_tick(&rows->trace[k], &rows->truth[k], rule->n, s);
  }
  s->early += end < rows->count && rows->truth[end].pad > 0;
  s->taps++;
}

static approach_sums run_taps(const finger_race *race, const ethd_config *config, const char *word, int taps) {
  char message[ETHD_MESSAGE_MAX];
  ethd__speed speed;
  ethd__study study;
  ethd__stage stage;
  approach_sums s = {0};
  ethd_plant none = {0};
  if (!ethd__speed_parse(word, &none, &speed)) ethd__fail(ETHD_EXIT_FAILED, "a speed that is none");
  load_study(race, config, &speed, &study);
  check(ethd__stage_open(&study, "offset", &stage, message), message);
  for (int i = 0; i < taps; i++) {
    ethd_sim_tap tap;
    check(ethd__stage_draw(&stage, &speed, (uint64_t)i, &tap), "a tap can't be drawn");
    const ethd__rule rule = ethd__stage_rule(&stage, &speed, tap.finger_radius);
    play(&stage, &tap, race, ethd_path_end(&tap.path));
    add_tap(&stage, &rule, &s);
  }
  ethd__stage_close(&stage);
  return s;
}

/* ---- the table ---- */

static double error_of(const approach_sums *s) { return sqrt(s->square / s->ticks); }
static double toward_of(const approach_sums *s) { return sqrt(s->toward / s->ticks); }
static double lag_of(const approach_sums *s) { return -s->against / s->speed_square; }
static double early_of(const approach_sums *s) { return (double)s->early / s->taps; }

static void print_part(const char *what, approach_sums all[SENSORS][SPEEDS], double unit,
                       double (*of)(const approach_sums *)) {
  printf("  %-22s", what);
  for (int v = 0; v < SPEEDS; v++) printf("  %s m/s", speeds[v]);
  printf("\n");
  for (int i = 0; i < SENSORS; i++) {
    printf("    %-20s", sensors[i].name);
    for (int v = 0; v < SPEEDS; v++) printf(" %8.3f", unit * of(&all[i][v]));
    printf("\n");
  }
}

static int find_sensor(const char *name) {
  int i = 0;
  while (strcmp(sensors[i].name, name) != 0) i++;
  return i;
}

static void print_goal(approach_sums all[SENSORS][SPEEDS]) {
  double told = error_of(&all[find_sensor("12 zones")][0]),
         silent = error_of(&all[find_sensor("12 zones (silent)")][0]);
  printf("  goal: error of the zones at 0.2 m/s less when each reading tells its noise: %.3f, silent %.3f, %s\n",
         1e3 * told, 1e3 * silent, ethd__bench_verdict(told < silent));
}

static int run(const char *folder, int quick) {
  static approach_sums all[SENSORS][SPEEDS];
  int taps = quick ? 15 : 150;
  ethd_config *config = load_config();
  FILE *csv = ethd__bench_csv(
      folder, "sensors",
      "# simulated taps under law offset, plant n; sensors as drivers/sim/finger.c has them, not measured\n"
      "# error: of the finger's centre before the ring meets the wall; toward: along its normal; lag: its "
      "part that grows with the speed; early: the finger met the ring first\n",
      "sensor,speed_mps,taps,error_rms_mm,error_toward_mm,lag_ms,early_share");
  printf("sensors of the finger: %d simulated taps each at rising speed, before the ring meets the wall\n", taps);
  for (int i = 0; i < SENSORS; i++)
    for (int v = 0; v < SPEEDS; v++) {
      const approach_sums *s = &all[i][v];
      all[i][v] = run_taps(&sensors[i], config, speeds[v], taps);
      fprintf(csv, "%s,%s,%d,%.17g,%.17g,%.17g,%.17g\n", sensors[i].name, speeds[v], s->taps, 1e3 * error_of(s),
              1e3 * toward_of(s), 1e3 * lag_of(s), early_of(s));
      ethd__progress((uint64_t)i * SPEEDS + (uint64_t)v + 1, SENSORS * SPEEDS, "sensors");
    }
  print_part("rms error, mm", all, 1e3, error_of);
  print_part("toward the wall, mm", all, 1e3, toward_of);
  print_part("lag, ms", all, 1e3, lag_of);
  print_part("early contacts, %", all, 100, early_of);
  print_goal(all);
  ethd_config_free(config);
  return ethd__bench_close();
}

const ethd__bench ethd__bench_sensors = {"sensors", "what the finger's sensor costs: error, lag, early contacts", run};
