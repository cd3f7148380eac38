/* Benchmarks: run time against error. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "text/claim.h"
#include "text/text.h"

static const ethd__bench *const benches[] = {
    &ethd__bench_integrators, &ethd__bench_hours, &ethd__bench_fits, &ethd__bench_filters, &ethd__bench_velocity,
    &ethd__bench_kinematics,  &ethd__bench_scene, &ethd__bench_tick, &ethd__bench_sensors, &ethd__bench_readers,
};
#define BENCH_COUNT (sizeof benches / sizeof *benches)

static const char doc[] = "Measures libethd, and other libraries beside it if they are installed. "
                          "Prints a table for each question and writes "
                          "DIR/WHAT.csv. WHAT is one of those listed by --list, or all.\v"
                          "Absolute times hold for this machine at this moment: compare times of one run only.\n\n"
                          "Example:\n  ethd-bench tick --quick";

enum { OPTION_FORCE = 256 };

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "folder of the CSV files (default: bench)", 0},
    {"force", OPTION_FORCE, NULL, 0, "replace the CSV files that are there", 0},
    {"quick", 'q', NULL, 0, "fewer rounds", 0},
    {"peers", 'p', "DIR", 0, "folder of the other libraries' shared objects (default: beside the program's)", 0},
    {"about", 'a', "TEXT", 0, "text for the head of each CSV file: commit, compiler, flags", 0},
    {"list", 'l', NULL, 0, "list the questions", 0},
    {0},
};

static struct {
  const char *what, *folder, *peers;
  int quick, list;
  bool force;
} arg = {.folder = "bench"};

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'o': arg.folder = text; return 0;
  case 'q': arg.quick = 1; return 0;
  case OPTION_FORCE: arg.force = true; return 0;
  case 'p': arg.peers = text; return 0;
  case 'a': ethd__bench_about(text); return 0;
  case 'l': arg.list = 1; return 0;
  case ARGP_KEY_ARG:
    if (arg.what) argp_error(state, "\"%s\": one WHAT at a time", text);
    arg.what = text;
    return 0;
  case ARGP_KEY_END:
    if (!arg.what && !arg.list) argp_error(state, "WHAT is missing; --list lists them");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* The build's peers stand beside the folder of its programs. */
static void find_peers(void) {
  static char folder[4096 + 16];
  char program[4096];
  ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length > 0 ? length : 0] = 0;
  char *bin = ethd__path_folder(program);
  snprintf(folder, sizeof folder, "%s/../peers", bin ? bin : ".");
  free(bin);
  ethd__bench_peers_in(arg.peers ? arg.peers : folder);
}

static int run_wanted(void) {
  int code = ETHD_EXIT_DONE, known = 0;
  for (size_t i = 0; i < BENCH_COUNT; i++) {
    if (strcmp(arg.what, "all") != 0 && strcmp(arg.what, benches[i]->name) != 0) continue;
    if (known++) printf("\n");
    int one = benches[i]->run(arg.folder, arg.quick);
    if (one != ETHD_EXIT_DONE) code = one;
    fflush(stdout);
  }
  if (!known) ethd__fail(ETHD_EXIT_INPUT, "\"%s\" is not known; ethd-bench --list lists what is", arg.what);
  return code;
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "WHAT", doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  for (size_t i = 0; arg.list && i < BENCH_COUNT; i++) printf("%-12s %s\n", benches[i]->name, benches[i]->brief);
  if (!arg.what) return ethd__end(ETHD_EXIT_DONE);
  char message[ETHD_MESSAGE_MAX], file[128];
  ethd__claim claim;
  const char *const files[] = {file, NULL};
  snprintf(file, sizeof file, "%.100s.csv", strcmp(arg.what, "all") ? arg.what : "*");
  ethd_status status = ethd__claim_folder(arg.folder, files, arg.force, &claim, message);
  if (status) ethd__fail(ethd__exit_code(status), "%s", message);
  find_peers();
  int code = run_wanted();
  ethd__claim_release(&claim);
  return ethd__end(code);
}
