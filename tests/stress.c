/* Numerical stress, as make stress runs it: the library's real code at its limits, each result beside its closed form.

   stress [NAME|all] [--quick|--long] [--csv FILE] [--out DIR]: exit code 1 if a result is off. Where one line stands for
   many points, it shows the worst of them; the CSV has them all. */
#include <stdbool.h>
#include <string.h>

#include "cli/cli.h"
#include "stress/stress.h"
#include "text/text.h"

static const ethd__stress *const tests[] = {
    &ethd__stress_boundary,  &ethd__stress_braking, &ethd__stress_viscous,    &ethd__stress_stop,
    &ethd__stress_touch,     &ethd__stress_lag,     &ethd__stress_press,      &ethd__stress_creep,
    &ethd__stress_energy,    &ethd__stress_arm,     &ethd__stress_parameters, &ethd__stress_inputs,
    &ethd__stress_denormals, &ethd__stress_drift,   &ethd__stress_jitter,     &ethd__stress_map,
    &ethd__stress_hold,
};
#define COUNT (sizeof tests / sizeof *tests)

static const struct argp_option options[] = {
    {"quick", 'q', NULL, 0, "fewer points: all in a few seconds", 0},
    {"long", 'l', NULL, 0, "run 1e9 ticks where the default runs 1e7; takes minutes", 0},
    {"csv", 'c', "FILE", 0, "write every result, one in a row", 0},
    {"out", 'o', "DIR", 0, "folder for the pictures' data", 0},
    {"list", 'L', NULL, 0, "list the tests", 0},
    {0},
};

static struct {
  const char *name, *csv, *folder;
  ethd__effort effort;
  int list;
} arg = {.effort = ETHD__NORMAL};

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'q': arg.effort = ETHD__QUICK; return 0;
  case 'l': arg.effort = ETHD__LONG; return 0;
  case 'c': arg.csv = text; return 0;
  case 'o': arg.folder = text; return 0;
  case 'L': arg.list = 1; return 0;
  case ARGP_KEY_ARG:
    if (arg.name) argp_error(state, "\"%s\": one NAME at a time", text);
    arg.name = text;
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static bool wanted(const ethd__stress *test) {
  return !arg.name || strcmp(arg.name, "all") == 0 || strcmp(arg.name, test->name) == 0;
}

static void check_name(void) {
  for (size_t i = 0; i < COUNT; i++)
    if (wanted(tests[i])) return;
  ethd__fail(ETHD_EXIT_INPUT, "\"%s\" isn't a test; all and those of --list are", arg.name);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "[NAME]", NULL, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  for (size_t i = 0; arg.list && i < COUNT; i++) printf("%-10s  %s\n", tests[i]->name, tests[i]->brief);
  if (arg.list) return ethd__end(ETHD_EXIT_DONE);
  check_name();
  ethd__stress_log log = {.effort = arg.effort, .folder = arg.folder};
  char message[ETHD_MESSAGE_MAX];
  ethd_replace csv;
  if (arg.csv) {
    if (ethd_replace_begin(arg.csv, &csv, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
    log.csv = csv.file;
    fprintf(log.csv, "test,what,measured,relation,analytic,unit,allowed,pass\n");
  }
  for (size_t i = 0; i < COUNT; i++) {
    if (!wanted(tests[i])) continue;
    printf("%s: %s\n", tests[i]->name, tests[i]->brief);
    log.test = tests[i]->name;
    tests[i]->run(&log);
    ethd__stress_flush(&log);
  }
  if (arg.csv && ethd_replace_commit(&csv, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  if (log.failures)
    printf("%llu FAILED\n", (unsigned long long)log.failures);
  else
    printf("all within what is allowed\n");
  return ethd__end(log.failures ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE);
}
