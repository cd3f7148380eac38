#include "tap/reach_main.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/picture.h"
#include "ethd/plugin.h"
#include "tap/reach_table.h"
#include "text/claim.h"
#include "text/error_text.h"

#define AHEAD 0.12 /* m */

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

static void check_job(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

/* "ur5e" to ur5e.arm, here or installed. */
static char *table_path(const char *name) {
  const size_t length = strlen(name);
  char *file, *path;
  if (asprintf(&file, "%s%s", name, length > 4 && !strcmp(name + length - 4, ".arm") ? "" : ".arm") < 0)
    ethd__fail_memory();
  path = ethd__given_or_data(file);
  free(file);
  return path;
}

/* Sets the requested wall, or a wall AHEAD of the plate at the posture, facing the plate. */
static void put_wall(const ethd__tap_options *arg, ethd__reaches *r) {
  const ethd_vec3 given = ethd_vec3_of(arg->wall);
  const double length = ethd_vec3_norm(given);
  ethd__tool tool;
  ethd__linkage_place(&r->table.linkage, r->table.posture, &tool);
  r->n = length > 0 ? ethd_vec3_scale(1 / length, given) : tool.facing;
  r->wall = length > 0 ? arg->wall[3] / length : ethd_vec3_dot(r->n, tool.x) + AHEAD;
}

static const char *const trace_files[] = {"*.csv", NULL};

/* Inputs are never overwritten. */
static void refuse_input(const ethd__tap_options *arg, const char *option, const char *input) {
  char *table = arg->plot ? ethd__picture_table(arg->plot) : NULL;
  ethd__refuse_input("--csv", arg->csv, option, input);
  if (table) ethd__refuse_input("--plot", table, option, input);
  if (arg->trace && ethd__claim_holds(arg->trace, trace_files, input))
    ethd__fail(ETHD_EXIT_INPUT, "%s: %s would be written over; another folder is needed", option, input);
  free(table);
}

static void load_recorded(const ethd__tap_options *arg, ethd__recorded **out, size_t *count) {
  char message[ETHD_MESSAGE_MAX], **files, *finger = ethd__given_or_data(arg->finger);
  check(ethd__movements_list(finger, &files, count, message), message);
  *out = calloc(*count, sizeof **out);
  if (!*out) ethd__fail_memory();
  for (size_t i = 0; i < *count; i++) {
    refuse_input(arg, "--finger", files[i]);
    check(ethd__recorded_load(files[i], &arg->form, &(*out)[i], message), message);
  }
  ethd__movements_free(files, *count);
  free(finger);
}

/* Returns the library's laws and a plugin's, which stay until the program ends. */
static const ethd_law *const *laws_with(const char *plugin) {
  const ethd_plugin_entry *own;
  ethd_error error;
  char message[ETHD_MESSAGE_MAX];
  size_t count = 0;
  if (!plugin) return ethd_laws;
  const ethd_status status = ethd_plugin_open(plugin, &own, &error);
  if (status) {
    ethd_error_text(plugin, &error, message);
    ethd__fail(ethd__exit_code(status), "--plugin: %s", message);
  }
  while (ethd_laws[count]) count++;
  const ethd_law **all = calloc(count + own->law_count + 1, sizeof *all);
  if (!all) ethd__fail_memory();
  memcpy(all, ethd_laws, count * sizeof *all);
  memcpy(all + count, own->laws, own->law_count * sizeof *all);
  return all;
}

/* Refuses causes of failure of the first taps, and a key that no law has. */
static void try_laws(const ethd__reach_plan *plan) {
  static ethd__reach_rig rig;
  const ethd__reaches *r = &plan->reaches;
  char message[ETHD_MESSAGE_MAX];
  bool known[ETHD_TAP_GAINS] = {false};
  for (size_t i = 0; i < plan->law_count; i++) {
    check(ethd__reach_open(r, plan->laws[i], &rig, message), message);
    for (size_t k = 0; k < r->gain_count; k++) known[k] |= !isnan(ethd_space_get(&rig.setup, r->gains[k].key));
    ethd__reach_close(&rig);
  }
  for (size_t k = 0; k < r->gain_count; k++)
    if (!known[k])
      ethd__fail(ETHD_EXIT_INPUT, "--set: %s: no key of [space] or of a law; ethd-check --laws lists those of laws",
                 r->gains[k].key);
}

static void draw(const ethd__tap_options *arg, const ethd__reach_plan *plan) {
  const ethd__reaches *r = &plan->reaches;
  char message[ETHD_MESSAGE_MAX], title[160], base[96], laws[ETHD_TAP_WORDS * 34] = "";
  char *table = ethd__picture_table(arg->plot);
  check_job(ethd__reach_sweep(plan, arg->arm, table, message), message);
  snprintf(title, sizeof title, "%s, simulated: %zu taps at %s m/s a point", arg->arm, plan->taps, plan->speeds->word);
  snprintf(base, sizeof base, "%.6g %.6g %.6g", 1e3 * r->table.servo.delay, 1e3 * r->gap, 1e3 * r->bias);
  for (size_t i = 0; i < plan->law_count; i++)
    snprintf(laws + strlen(laws), sizeof laws - strlen(laws), "%s ", plan->laws[i]);
  const ethd__picture_value values[] = {{"in", table, true},   {"out", arg->plot, true}, {"name", title, false},
                                        {"base", base, false}, {"laws", laws, false},    {NULL, NULL, false}};
  if (!ethd__stop) check_job(ethd__picture_draw("sensitivity.gp", NULL, values, message), message);
  free(table);
}

static int run(const ethd__tap_options *arg, const ethd__reach_plan *plan) {
  char message[ETHD_MESSAGE_MAX];
  ethd__claim traces = ETHD_CLAIM_NONE;
  ethd__reach_cell *cells = ethd__reach_cells_create(plan);
  if (!cells) ethd__fail_memory();
  if (arg->plot) check_job(ethd__picture_ready(message), message);
  if (arg->trace) check(ethd__claim_folder(arg->trace, trace_files, arg->force, &traces, message), message);
  check_job(ethd__reach_cells_run(plan, cells, message), message);
  if (arg->csv) check_job(ethd__reach_write(plan, cells, arg->csv, message), message);
  if (arg->trace && !ethd__stop) check_job(ethd__reach_trace(plan, cells, arg->trace, message), message);
  ethd__claim_release(&traces);
  ethd__reach_print(stdout, plan, cells);
  if (arg->plot && !ethd__stop) draw(arg, plan);
  ethd__reach_cells_free(cells);
  if (ethd__stop) fprintf(stderr, "%s: stopped; what was done is kept\n", program_invocation_short_name);
  return ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}

int ethd__reach_main(const ethd__tap_options *arg) {
  char message[ETHD_MESSAGE_MAX], *path = table_path(arg->arm);
  ethd__recorded *recorded = NULL;
  ethd__speed *speeds = calloc(arg->speeds.count, sizeof *speeds);
  ethd__reach_plan plan = {.laws = arg->laws.words,
                           .law_count = arg->laws.count,
                           .speeds = speeds,
                           .speed_count = arg->speeds.count,
                           .reaches = {.laws = laws_with(arg->plugin),
                                       .gap = arg->gap,
                                       .rate = arg->rate,
                                       .bias = arg->bias,
                                       .seed = arg->seed,
                                       .gains = arg->gains,
                                       .gain_count = arg->gain_count}};
  ethd__reaches *r = &plan.reaches;
  if (!speeds) ethd__fail_memory();
  check(ethd__arm_table_load(path, path, &r->table, message), message);
  refuse_input(arg, "--arm", path);
  if (arg->plot) {
    char *picture = ethd__picture_table(arg->plot);
    ethd__refuse_same("--plot", picture, "--csv", arg->csv);
    free(picture);
  }
  if (!isnan(arg->delay)) r->table.servo.delay = arg->delay;
  put_wall(arg, r);
  check(ethd__reaches_prepare(r, path, message), message);
  if (arg->finger) load_recorded(arg, &recorded, &r->recorded_count);
  r->recorded = recorded;
  plan.taps = arg->taps ? (size_t)arg->taps : r->recorded_count > 10 ? r->recorded_count : 10;
  ethd__speeds_read(&arg->speeds, &(ethd_plant){.speed_low = 0.2, .speed_high = 0.4}, speeds);
  try_laws(&plan);
  ethd__catch_interrupt();
  const int code = run(arg, &plan);
  for (size_t i = 0; i < r->recorded_count; i++) ethd__recorded_free(&recorded[i]);
  free(recorded);
  free(speeds);
  free(path);
  return code;
}
