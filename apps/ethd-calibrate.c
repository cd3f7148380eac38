/* Calibrates the proximity ring: fits the law from counts to distances. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "calibrate/guided.h"
#include "calibrate/made.h"
#include "calibrate/report.h"
#include "cli/cli.h"

#define LAW_ERROR_MAX 0.05e-3 /* m: what a self-test allows level law and table */

static const char doc[] =
    "Calibrates the proximity ring with a rod of known radius.\v"
    "With --port it guides you: first measure the empty ring, then the rod in the middle, then the rod pressed against "
    "the ring at each sensor. --record keeps the counts, and --in fits them again without the ring. It prints the "
    "remaining error of each level, and writes the chosen level to --out, the file for the ring's key calibration.\n"
    "--self-test does the same with a simulated ring whose laws are known, and prints the error of the fit.\n\n"
    "Example:\n"
    "  ethd-calibrate --port /dev/ttyUSB0 --record counts.csv --out ring.ini\n"
    "  ethd-calibrate --in counts.csv --level gain --out ring.ini\n"
    "  ethd-calibrate --self-test";

enum { RING_RADIUS = 256, SELF_TEST, SEED, NOISE, SERIAL, BAUD, FRAMES };

static const struct argp_option options[] = {
    {"port", 'p', "TTY", 0, "the ring's serial port", 0},
    {"baud", BAUD, "B", 0, "baud rate of that port (500000)", 0},
    {"in", 'i', "COUNTS.csv", 0, "fit the counts of an earlier --record, without a ring", 0},
    {"self-test", SELF_TEST, NULL, 0, "calibrate a simulated ring instead of a real one", 0},
    {"seed", SEED, "S", 0, "seed of the simulated ring (1)", 0},
    {"noise", NOISE, "N", 0, "standard deviation of the simulated ring's counts (30)", 0},
    {"frames", FRAMES, "N", 0, "number of frames at each place (100)", 0},
    {"ring-radius", RING_RADIUS, "M", 0, "inner radius of the ring, m (0.012)", 0},
    {"rod", 'r', "M", 0, "radius of the rod, m (0.0075)", 0},
    {"level", 'l', "LEVEL", 0, "detail of the calibration: none, common, gain, law or table (law)", 0},
    {"serial", SERIAL, "TEXT", 0, "serial number of the ring, kept in the calibration", 0},
    {"record", 'R', "COUNTS.csv", 0, "keep the counts; the file is written after each step", 0},
    {"out", 'o', "RING.ini", 0, "write the calibration", 0},
    {"csv", 'c', "OUT.csv", 0, "write a row for each reading: the rod's true and measured place, and the error", 0},
    {"plot", 'P', "OUT.png", 0, "draw the file of --csv (gnuplot)", 0},
    {0},
};

static struct {
  ethd__guided_options guided;
  const char *in, *out, *csv, *plot, *serial;
  ethd__level level;
  bool self_test;
  uint64_t seed;
  double noise;
} arg = {.guided = {.baud = 500000, .frames = 100, .ring_radius = 0.012, .rod = 0.0075},
         .level = ETHD__LEVEL_LAW,
         .seed = 1,
         .noise = 30};

static ethd__level level_of(const char *text) {
  for (int i = 0; i < ETHD__LEVEL_COUNT; i++)
    if (!strcmp(text, ethd__level_names[i])) return (ethd__level)i;
  ethd__fail(ETHD_EXIT_INPUT, "--level: found \"%s\"; none, common, gain, law or table is allowed", text);
}

static void check_usage(struct argp_state *state) {
  if ((arg.guided.port != NULL) + (arg.in != NULL) + arg.self_test != 1)
    argp_error(state, "one of --port, --in and --self-test is needed");
  if (arg.plot && !arg.csv) argp_error(state, "--plot draws the file of --csv: give both");
  if (arg.serial && strlen(arg.serial) >= ETHD__SERIAL_MAX)
    argp_error(state, "--serial: at most %d characters are allowed", ETHD__SERIAL_MAX - 1);
  if (arg.serial && (strpbrk(arg.serial, ";#\n\r") || !arg.serial[0] || arg.serial[0] == ' '))
    argp_error(state, "--serial: found \"%s\"; text without ; # and line ends is allowed", arg.serial);
  if (!(arg.guided.rod < arg.guided.ring_radius)) argp_error(state, "--rod: a rod thinner than the ring is needed");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  ethd__guided_options *g = &arg.guided;
  switch (key) {
  case 'p': g->port = text; return 0;
  case BAUD: g->baud = (uint32_t)ethd__option_integer("--baud", text, 9600, 12000000); return 0;
  case 'i': arg.in = text; return 0;
  case SELF_TEST: arg.self_test = true; return 0;
  case SEED: arg.seed = ethd__option_seed("--seed", text); return 0;
  case NOISE: arg.noise = ethd__option_number("--noise", text, 0, 10000); return 0;
  case FRAMES: g->frames = (int)ethd__option_integer("--frames", text, 10, 100000); return 0;
  case RING_RADIUS: g->ring_radius = ethd__option_number("--ring-radius", text, 1e-3, 0.5); return 0;
  case 'r': g->rod = ethd__option_number("--rod", text, 1e-3, 0.5); return 0;
  case 'l': arg.level = level_of(text); return 0;
  case SERIAL: arg.serial = text; return 0;
  case 'R': g->record = text; return 0;
  case 'o': arg.out = text; return 0;
  case 'c': arg.csv = text; return 0;
  case 'P': arg.plot = ethd__option_picture("--plot", text); return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  case ARGP_KEY_END: check_usage(state); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* ---- the counts ---- */

static void get_places(const ethd__calibration *truth, ethd__places *out) {
  char message[ETHD_MESSAGE_MAX];
  ethd_status status = ETHD_OK;
  const ethd__guided_options *g = &arg.guided;
  if (arg.self_test) {
    ethd__made_places(truth, arg.seed, arg.noise, g->frames, g->ring_radius, g->rod, out);
    if (g->record) status = ethd__places_save(out, g->record, message);
  } else if (arg.in) {
    status = ethd__places_load(arg.in, out, message);
  } else {
    status = ethd__guided_run(g, out, message);
  }
  if (status) ethd__fail(ethd__exit_code(status), "%s", message);
}

/* ---- the calibration ---- */

static void date_it(ethd__calibration *c) {
  time_t now = time(NULL);
  struct tm utc;
  if (gmtime_r(&now, &utc)) strftime(c->date, sizeof c->date, "%Y-%m-%d", &utc);
}

static void write_files(const ethd__places *p, ethd__calibration *c) {
  char message[ETHD_MESSAGE_MAX];
  const char *const outputs[][2] = {{"--out", arg.out}, {"--csv", arg.csv}, {"--plot", arg.plot}};
  for (int i = 0; i < 3; i++) {
    ethd__refuse_input(outputs[i][0], outputs[i][1], "--in", arg.in);
    for (int k = 0; k < i; k++) ethd__refuse_same(outputs[i][0], outputs[i][1], outputs[k][0], outputs[k][1]);
  }
  ethd_status status = ETHD_OK;
  date_it(c);
  if (arg.serial) strcpy(c->serial, arg.serial);
  if (arg.out) status = ethd__calibration_save(c, arg.out, message);
  if (!status && arg.csv) status = ethd__calibration_csv(p, c, arg.csv, message);
  if (!status && arg.plot) status = ethd__calibration_draw(arg.csv, arg.plot, message);
  if (status) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

/* The same places at every level against the truth. */
static int judge(const ethd__calibration *truth, const ethd__places *p) {
  char message[ETHD_MESSAGE_MAX];
  bool failed = false;
  printf("made ring %llu, counts +-%g (sd), %d frames: error of the laws found, %g to %g mm, mm rms\n",
         (unsigned long long)arg.seed, arg.noise, arg.guided.frames, 1e3 * ETHD__MADE_FROM, 1e3 * ETHD__MADE_TO);
  for (int level = 0; level < ETHD__LEVEL_COUNT; level++) {
    ethd__calibration c;
    ethd__must(ethd__places_fit(p, (ethd__level)level, &c, message), message);
    double error = ethd__made_error(truth, &c);
    bool bad = level >= ETHD__LEVEL_LAW && !(error <= LAW_ERROR_MAX);
    printf("  %-8s %8.4f%s\n", ethd__level_names[level], 1e3 * error, bad ? "  over 0.05: failed" : "");
    failed |= bad;
  }
  return failed ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  static ethd__places places;
  static ethd__calibration truth, c;
  char message[ETHD_MESSAGE_MAX];
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__catch_interrupt();
  if (arg.self_test) truth = ethd__made_ring(arg.seed);
  get_places(&truth, &places);
  ethd__must(ethd__places_fit(&places, arg.level, &c, message), message);
  ethd__calibration_print(&places, &c);
  write_files(&places, &c);
  return ethd__end(arg.self_test ? judge(&truth, &places) : ETHD_EXIT_DONE);
}
