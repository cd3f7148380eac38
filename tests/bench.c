/* Benchmarks, as make bench runs them: run time against error, other libraries beside ours where they are installed.

   bench WHAT|all [--quick] [--out DIR] [--about TEXT]: prints a table for each question and writes its CSV files into
   DIR. Absolute times hold for this machine at this moment: compare times of one run only. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "text/text.h"

static const bench *const benches[] = {&bench_tick,       &bench_scene,      &bench_plant,
                                       &bench_estimators, &bench_kinematics, NULL};

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "folder of the CSV files (.)", 0},
    {"quick", 'q', NULL, 0, "fewer rounds", 0},
    {"about", 'a', "TEXT", 0, "text for the head of each CSV file: commit, compiler, flags", 0},
    {0},
};

static struct {
  const char *what, *folder;
  int quick;
} arg = {.folder = "."};

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'o': arg.folder = text; return 0;
  case 'q': arg.quick = 1; return 0;
  case 'a': bench_about(text); return 0;
  case ARGP_KEY_ARG:
    if (arg.what) argp_error(state, "\"%s\": one WHAT at a time", text);
    arg.what = text;
    return 0;
  case ARGP_KEY_NO_ARGS: argp_error(state, "WHAT is missing"); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* The build's peers stand beside the folder of its tests. */
static void find_peers(void) {
  static char folder[4096 + 16];
  char program[4096];
  ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length > 0 ? length : 0] = 0;
  char *tests = ethd__path_folder(program);
  snprintf(folder, sizeof folder, "%s/../peers", tests ? tests : ".");
  free(tests);
  bench_peers_in(folder);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "tick|scene|plant|estimators|kinematics|all", NULL, NULL,
                                   NULL,    NULL};
  int known = 0;
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  find_peers();
  for (const bench *const *b = benches; *b; b++) {
    if (strcmp(arg.what, "all") && strcmp(arg.what, (*b)->name)) continue;
    if (known++) printf("\n");
    (*b)->run(arg.folder, arg.quick);
    fflush(stdout);
  }
  if (!known) ethd__fail(ETHD_EXIT_INPUT, "\"%s\" isn't a question; --help names them", arg.what);
  return ethd__end(ETHD_EXIT_DONE);
}
