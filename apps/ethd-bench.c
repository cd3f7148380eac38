/* Benchmarks: run time, and later run time against error. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bench/bench.h"
#include "common/cli.h"

static const ethd__bench *const benches[] = {&ethd__bench_tick};
#define BENCH_COUNT (sizeof benches / sizeof *benches)

static const char doc[] =
    "Measures libethd and writes a table and DIR/WHAT.csv. WHAT: all, tick.\v"
    "Absolute times mean this machine at this moment; compare within one run.\n\n"
    "Example:\n  ethd-bench tick --quick";

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "folder of the CSV files (default: bench)", 0},
    {"quick", 'q', NULL, 0, "fewer rounds", 0},
    {0},
};

static struct {
  const char *what, *folder;
  int quick;
} arg = {NULL, "bench", 0};

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
    case 'o': arg.folder = text; return 0;
    case 'q': arg.quick = 1; return 0;
    case ARGP_KEY_ARG:
      if (arg.what) argp_error(state, "\"%s\": one WHAT at a time", text);
      arg.what = text;
      return 0;
    case ARGP_KEY_END:
      if (!arg.what) argp_error(state, "WHAT is missing: all or tick");
      return 0;
    default: return ARGP_ERR_UNKNOWN;
  }
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "WHAT", doc, NULL, NULL, NULL};
  int code = ETHD_EXIT_DONE, known = 0;
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  if (mkdir(arg.folder, 0777) != 0 && errno != EEXIST)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", arg.folder, strerror(errno));
  for (size_t i = 0; i < BENCH_COUNT; i++) {
    if (strcmp(arg.what, "all") != 0 && strcmp(arg.what, benches[i]->name) != 0) continue;
    known = 1;
    int one = benches[i]->run(arg.folder, arg.quick);
    if (one != ETHD_EXIT_DONE) code = one;
  }
  if (!known) ethd__fail(ETHD_EXIT_INPUT, "\"%s\" is not known; all and tick are", arg.what);
  return ethd__end(code);
}
