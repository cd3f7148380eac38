/* Numerical stress: what the library does at its limits, against formulas. */
#include <stdbool.h>
#include <string.h>

#include "cli/cli.h"
#include "stress/stress.h"
#include "text/claim.h"
#include "text/text.h"

static const ethd__stress *const tests[] = {
    &ethd__stress_boundary,  &ethd__stress_braking, &ethd__stress_viscous,    &ethd__stress_stop,
    &ethd__stress_touch,     &ethd__stress_lag,     &ethd__stress_press,      &ethd__stress_creep,
    &ethd__stress_energy,    &ethd__stress_arm,     &ethd__stress_parameters, &ethd__stress_inputs,
    &ethd__stress_denormals, &ethd__stress_drift,   &ethd__stress_jitter,     &ethd__stress_map,
    &ethd__stress_hold,
};
#define COUNT (sizeof tests / sizeof *tests)

static const char doc[] =
    "Measures the library's real code at its limits and prints each result beside its closed form, with a "
    "verdict. The exit code is 1 when one fails. NAME is all (the default) or one of those listed by --list.\v"
    "Where one line stands for many points, it shows the worst of them; --csv has them all.\n\n"
    "Example:\n"
    "  ethd-stress all --quick\n"
    "  ethd-stress boundary --out pictures";

enum { OPTION_FORCE = 256 };

static const struct argp_option options[] = {
    {"quick", 'q', NULL, 0, "fewer points: all in a few seconds", 0},
    {"long", 'l', NULL, 0, "run 1e9 ticks where the default runs 1e7; takes minutes", 0},
    {"csv", 'c', "FILE", 0, "write every result, one in a row", 0},
    {"out", 'o', "DIR", 0, "folder for the pictures' data (plot/stability-*.gp draw them)", 0},
    {"force", OPTION_FORCE, NULL, 0, "replace data that is there", 0},
    {"list", 'L', NULL, 0, "list the tests", 0},
    {0},
};

static struct {
  const char *name, *csv, *folder;
  ethd__effort effort;
  int list;
  bool force;
} arg = {.effort = ETHD__NORMAL};

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'q': arg.effort = ETHD__QUICK; return 0;
  case 'l': arg.effort = ETHD__LONG; return 0;
  case 'c': arg.csv = text; return 0;
  case 'o': arg.folder = text; return 0;
  case 'L': arg.list = 1; return 0;
  case OPTION_FORCE: arg.force = true; return 0;
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

typedef struct outputs {
  ethd__claim folder;
  ethd_replace csv;
} outputs;

static void close_outputs(outputs *out) {
  char message[ETHD_MESSAGE_MAX];
  ethd__claim_release(&out->folder);
  if (out->csv.file && ethd_replace_commit(&out->csv, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

static void open_outputs(ethd__stress_log *log, outputs *out) {
  char message[ETHD_MESSAGE_MAX], file[128];
  const char *const files[] = {file, NULL};
  snprintf(file, sizeof file, "%.100s*.csv", arg.name && strcmp(arg.name, "all") ? arg.name : "");
  ethd_status status = arg.folder ? ethd__claim_folder(arg.folder, files, arg.force, &out->folder, message) : ETHD_OK;
  if (!status && arg.csv) status = ethd_replace_begin(arg.csv, &out->csv, message);
  if (status) ethd__fail(ethd__exit_code(status), "%s", message);
  log->csv = out->csv.file;
  if (!log->csv) return;
  fprintf(log->csv, "test,what,measured,relation,analytic,unit,allowed,pass\n");
}

static void check_name(void) {
  for (size_t i = 0; i < COUNT; i++)
    if (wanted(tests[i])) return;
  ethd__fail(ETHD_EXIT_INPUT, "\"%s\" isn't a test; all and those of --list are", arg.name);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "[NAME]", doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  for (size_t i = 0; arg.list && i < COUNT; i++) printf("%-10s  %s\n", tests[i]->name, tests[i]->brief);
  if (arg.list) return ethd__end(ETHD_EXIT_DONE);
  check_name();
  ethd__stress_log log = {.effort = arg.effort, .folder = arg.folder};
  outputs out = {.folder = ETHD_CLAIM_NONE};
  open_outputs(&log, &out);
  for (size_t i = 0; i < COUNT; i++) {
    if (!wanted(tests[i])) continue;
    printf("%s: %s\n", tests[i]->name, tests[i]->brief);
    log.test = tests[i]->name;
    tests[i]->run(&log);
    ethd__stress_flush(&log);
  }
  close_outputs(&out);
  if (log.failures)
    printf("%llu FAILED\n", (unsigned long long)log.failures);
  else
    printf("all within what is allowed\n");
  return ethd__end(log.failures ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE);
}
