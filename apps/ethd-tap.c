/* The tapping study on the simulated device, or with a simulated arm in space. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "record/recording_parts.h"
#include "tap/load.h"
#include "tap/options.h"
#include "tap/paper.h"
#include "tap/reach_main.h"
#include "tap/run.h"
#include "tap/table.h"
#include "text/claim.h"
#include "text/error_text.h"

static ethd__tap_options arg;

/* ---- loading ---- */

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

/* Of what is written and run, once all input has been read. */
static void check_job(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

static const char *base_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

/* ---- the study ---- */

static const char *const trace_files[] = {"*.csv", NULL};

/* What was read isn't written over. */
static void refuse_inputs(void) {
  const char *const inputs[][2] = {{"--finger", arg.finger}, {"--config", arg.config}, {"--plant", arg.plant}};
  for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
    const char *input = inputs[i][1];
    ethd__refuse_input("--csv", arg.csv, inputs[i][0], input);
    if (input && ((arg.record && ethd__recording_holds(arg.record, input)) ||
                  (arg.trace && ethd__claim_holds(arg.trace, trace_files, input))))
      ethd__fail(ETHD_EXIT_INPUT, "%s: %s would be written over; another folder is needed", inputs[i][0], input);
  }
}

static int run(const ethd__tap_plan *plan, const ethd__heading *heading) {
  char message[ETHD_MESSAGE_MAX];
  const ethd__study *study = plan->study;
  ethd__output output;
  ethd__cell *cells = ethd__cells_create(plan);
  if (!cells) ethd__fail_memory();
  const ethd__output_paths paths = {arg.csv, arg.record, arg.force};
  ethd__claim traces = ETHD_CLAIM_NONE;
  refuse_inputs();
  if (arg.trace) check(ethd__claim_folder(arg.trace, trace_files, arg.force, &traces, message), message);
  check(ethd__output_open(&paths, study->config, &output, message), message);
  ethd_status status = ethd__cells_run(plan, &output, cells, message), closed;
  char left[ETHD_MESSAGE_MAX];
  closed = ethd__output_close(&output, left);
  check_job(status, message);
  check_job(closed, left);
  if (arg.trace && !ethd__stop) check_job(ethd__cells_trace(plan, arg.trace, cells, message), message);
  ethd__claim_release(&traces);
  ethd__table_print(stdout, study, heading, cells, plan->law_count * study->speed_count);
  ethd__cells_free(cells);
  if (ethd__stop) fprintf(stderr, "%s: stopped; what was done is kept\n", program_invocation_short_name);
  return ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}

static int run_table(const ethd__study *study, const ethd__loaded *loaded) {
  char message[ETHD_MESSAGE_MAX];
  const ethd__tap_plan plan = {study, arg.laws.words, arg.laws.count, (uint64_t)arg.taps};
  check(ethd__plan_check(&plan, message), message);
  const ethd__heading heading = {loaded->plant_name, arg.config ? arg.config : base_name(loaded->path), arg.finger,
                                 arg.scale, arg.scaled};
  return run(&plan, &heading);
}

static int run_paper(const ethd__study *study) {
  char message[ETHD_MESSAGE_MAX];
  check(ethd__paper_print(study, (uint64_t)arg.taps, message), message);
  if (ethd__stop) fprintf(stderr, "%s: stopped; nothing is printed\n", program_invocation_short_name);
  return ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}

int main(int argc, char **argv) {
  char message[ETHD_MESSAGE_MAX];
  ethd__loaded loaded;
  ethd__study study = {0};
  ethd__begin();
  ethd__tap_options_read(argc, argv, &arg);
  if (arg.arm) {
    ethd__tap_laws_choose(&arg, NULL);
    const int done = ethd__reach_main(&arg);
    ethd__tap_options_free(&arg);
    return ethd__end(done);
  }
  ethd__load(arg.config, arg.plant, true, true, &loaded);
  ethd__tap_laws_choose(&arg, loaded.config->setup.transition->law.id);
  study.config = loaded.config;
  study.plant = loaded.plant;
  study.speeds = calloc(arg.speeds.count, sizeof *study.speeds);
  if (!study.speeds) ethd__fail_memory();
  ethd__speeds_read(&arg.speeds, &study.plant, study.speeds);
  study.speed_count = arg.speeds.count;
  study.seed = arg.seed;
  study.validity = arg.validity;
  study.learn = arg.learn;
  study.gains = arg.gains;
  study.gain_count = arg.gain_count;
  if (arg.finger) {
    char *finger = ethd__given_or_data(arg.finger);
    check(ethd__movement_load(finger, &arg.form, &study.movement, message), message);
    free(finger);
  }
  check(ethd__study_prepare(&study, message), message);
  ethd__catch_interrupt();
  int code = arg.paper ? run_paper(&study) : run_table(&study, &loaded);
  ethd__movement_free(&study.movement);
  ethd__loaded_free(&loaded);
  ethd__tap_options_free(&arg);
  free(study.speeds);
  return ethd__end(code);
}
