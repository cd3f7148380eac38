/* Identifies a plant from recordings of a device. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/picture.h"
#include "identify/enough.h"
#include "identify/excite.h"
#include "identify/page.h"
#include "record/recording_parts.h"
#include "sim/plant.h"
#include "text/error_text.h"
#include "text/text.h"

static const char doc[] =
    "Identifies a device from recordings of its commands and encoders, and writes a plant file with intervals of its "
    "numbers.\v"
    "DIR is a recording of ethd-run, ethd-tap or ethd-study, or a folder of them; recordings of one device are fitted "
    "together. The simulator's prediction over short windows is fitted to the encoders by least squares. An "
    "information criterion decides whether the transmission is elastic; the whiteness of the residual shows whether "
    "the model is complete. Ticks with a finger near the ring are left out. A number that the recordings don't "
    "determine keeps its value of --base, and the page says so.\n"
    "--judge fits nothing: it prints the error of a plant's predictions on recordings that it wasn't fitted to.\n"
    "--excite makes a recording: it moves the device of a configuration with multisine torques, without a finger, "
    "inside a box and under the guard, after a dry run on the simulated device. Keep clear of the arm.\n\n"
    "Examples:\n"
    "  ethd-identify --excite --config device.ini --record session\n"
    "  ethd-identify session --out mine.plant --plot fit.png\n"
    "  ethd-identify --judge mine.plant another";

enum { BASE = 256, CSV, PLOT, JUDGE, EXCITE, RECORD, FORCE, SHARE, TORQUE, HALF, AT, VIRTUAL, SECONDS, PLUGINS };

static const struct argp_option options[] = {
    {"out", 'o', "MINE.plant", 0, "write the plant", 0},
    {"base", BASE, "PLANT", 0, "plant that gives the numbers that the recordings don't determine (q)", 0},
    {"csv", CSV, "OUT.csv", 0, "write a stretch of motion, measured and predicted, and the residual's spectrum", 0},
    {"plot", PLOT, "OUT.png", 0, "draw these data (gnuplot); they are written to OUT.csv unless --csv names a file", 0},
    {"judge", JUDGE, "PLANT", 0, "print the error of this plant's predictions of the recordings", 0},
    {"plugins", PLUGINS, NULL, 0, "run the plugins of the recordings", 0},
    {"excite", EXCITE, NULL, 0, "make a recording by moving the device of --config", 1},
    {"config", 'c', "C.ini", 0, "configuration (default: the simulated device)", 1},
    {"record", RECORD, "DIR", 0, "folder of the recording", 1},
    {"force", FORCE, NULL, 0, "replace an existing recording", 1},
    {"duration", 'd', "S", 0, "duration of the recording, s (60)", 1},
    {"share", SHARE, "R", 0, "largest torque as a share of the torque limit (0.5)", 1},
    {"torque", TORQUE, "NM", 0, "torque limit, Nm, if neither device nor configuration has one", 1},
    {"half", HALF, "M", 0, "half the side of the box, m (0.04)", 1},
    {"at", AT, "X,Y", 0, "the box's middle, m (0.25,0.25)", 1},
    {"virtual", VIRTUAL, NULL, 0, "count time instead of waiting: for a simulated device", 1},
    {0},
};

static struct {
  const char *out, *base, *csv, *plot, *judge;
  char **folders;
  int folder_count;
  bool excite, plugins;
  ethd__excitation excitation;
} arg = {.base = ETHD__PLANT,
         .excitation = {.seconds = 60, .share = 0.5, .torque = NAN, .half = 0.04, .at = {0.25, 0.25}}};

static void parse_at(const char *text) {
  char *comma = strchr(text, ','), first[64];
  if (!comma || comma - text >= (int)sizeof first)
    ethd__fail(ETHD_EXIT_INPUT, "--at: found \"%s\", X,Y is allowed", text);
  memcpy(first, text, (size_t)(comma - text));
  first[comma - text] = 0;
  arg.excitation.at =
      (ethd_vec){ethd__option_number("--at", first, -10, 10), ethd__option_number("--at", comma + 1, -10, 10)};
}

static void check_usage(struct argp_state *state) {
  bool recording = arg.excitation.record || arg.excitation.config;
  if (arg.excite && arg.folder_count) argp_error(state, "--excite makes a recording; a folder to fit isn't needed");
  if (arg.excite && arg.plugins) argp_error(state, "--plugins belongs to recordings; --excite takes no law");
  if (arg.excite && !arg.excitation.record) argp_error(state, "--excite needs --record DIR");
  if (!arg.excite && recording) argp_error(state, "--config and --record belong to --excite");
  if (!arg.excite && !arg.folder_count) argp_error(state, "a folder with a recording is needed, or --excite");
  if (arg.judge && (arg.out || arg.plot || arg.csv))
    argp_error(state, "--judge fits nothing: no --out, --plot or --csv");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  ethd__excitation *x = &arg.excitation;
  switch (key) {
  case 'o': arg.out = text; return 0;
  case BASE: arg.base = text; return 0;
  case CSV: arg.csv = text; return 0;
  case PLOT: arg.plot = ethd__option_picture("--plot", text); return 0;
  case JUDGE: arg.judge = text; return 0;
  case PLUGINS: arg.plugins = true; return 0;
  case EXCITE: arg.excite = true; return 0;
  case 'c': x->config = text; return 0;
  case RECORD: x->record = text; return 0;
  case FORCE: x->replace = true; return 0;
  case 'd': x->seconds = ethd__option_number("--duration", text, 1, 3600); return 0;
  case SHARE: x->share = ethd__option_number("--share", text, 0.01, 1); return 0;
  case TORQUE: x->torque = ethd__option_number("--torque", text, 1e-3, 1e3); return 0;
  case HALF: x->half = ethd__option_number("--half", text, 5e-3, 1); return 0;
  case AT: parse_at(text); return 0;
  case VIRTUAL: x->is_virtual = true; return 0;
  case ARGP_KEY_ARGS:
    arg.folders = state->argv + state->next;
    arg.folder_count = state->argc - state->next;
    return 0;
  case ARGP_KEY_END: check_usage(state); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* ---- input ---- */

static ethd_plant load_plant(const char *name) {
  char message[ETHD_MESSAGE_MAX];
  ethd_plant plant;
  ETHD__FREED char *path = ethd__plant_path(name, ".");
  if (!path) ethd__fail_memory();
  if (ethd__plant_read(path, path, &plant, message)) ethd__fail(ETHD_EXIT_INPUT, "%s", message);
  return plant;
}

static void load_evidence(ethd__evidence *e) {
  char message[ETHD_MESSAGE_MAX];
  for (int i = 0; i < arg.folder_count; i++) {
    ethd__need(ethd__evidence_add(e, arg.folders[i], message), message);
  }
}

/* ---- output ---- */

static void refuse_recorded(const char *option, const char *output, const ethd__evidence *e) {
  for (uint32_t i = 0; output && i < e->recording_count; i++)
    if (ethd__recording_holds(e->folders[i], output))
      ethd__fail(ETHD_EXIT_INPUT, "%s: %s belongs to the recording %s, which is only read; another name is needed",
                 option, output, e->folders[i]);
}

/* What is read isn't written over, nor is one output by another. Returns the path of the CSV; NULL: none is written. */
static char *check_outputs(const ethd__evidence *e) {
  char *csv = arg.csv ? strdup(arg.csv) : arg.plot ? ethd__picture_table(arg.plot) : NULL;
  ETHD__FREED char *base = ethd__plant_path(arg.base, ".");
  const char *table = arg.csv ? "--csv" : "--plot";
  if ((arg.csv && !csv) || !base) ethd__fail_memory();
  const char *const outputs[][2] = {{"--out", arg.out}, {table, csv}, {"--plot", arg.plot}};
  for (int i = 0; i < 3; i++) {
    refuse_recorded(outputs[i][0], outputs[i][1], e);
    ethd__refuse_input(outputs[i][0], outputs[i][1], "--base", base);
    for (int k = 0; k < i; k++) ethd__refuse_same(outputs[i][0], outputs[i][1], outputs[k][0], outputs[k][1]);
  }
  return csv;
}

/* ---- fitting ---- */

static void check_finding(ethd__finding *f) {
  uint32_t other;
  double shift;
  if (f->fit.unseen[ETHD__MASS_X] && f->fit.unseen[ETHD__MASS_Y])
    ethd__fail(ETHD_EXIT_FAILED,
               "%s: the masses aren't determined: torque and motion are too little related; record with changing "
               "torques, as ethd-identify --excite does",
               arg.folders[0]);
  if (ethd__fit_stranger(&f->problem, &other, &shift))
    ethd__fail(ETHD_EXIT_INPUT,
               "%s: of another device than the rest, by itself its mass is %.0f %% %s: give the recordings of one "
               "device, or record it again",
               f->evidence->folders[other], 100 * fabs(shift), shift > 0 ? "more" : "less");
}

static void write_files(const ethd__finding *f, const char *csv) {
  char message[ETHD_MESSAGE_MAX];
  ethd_status status = ETHD_OK;
  if (arg.out) status = ethd__page_write(f, arg.out, message);
  if (!status && csv) status = ethd__page_csv(f, csv, message);
  if (!status && arg.plot) status = ethd__identify_draw(f, csv, arg.plot, message);
  if (status) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

static void fit_arm(ethd__finding *f) {
  ethd__fit_run(f->evidence, &f->plant, f->sensing.count, &f->problem, &f->fit);
  if (ethd__stop) return;
  check_finding(f);
  f->residual = calloc(f->problem.rows, sizeof *f->residual);
  if (!f->residual) ethd__fail_memory();
  ethd__whiteness_find(&f->problem, f->sensing.count, f->residual, &f->whiteness);
}

static int identify(const ethd__evidence *e) {
  static ethd__finding f;
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *csv = check_outputs(e);
  f.plant = load_plant(arg.base);
  f.base = arg.base;
  f.evidence = e;
  if (ethd__sensing_find(e, &f.sensing, message)) ethd__fail(ETHD_EXIT_INPUT, "%s", message);
  ethd__evidence_enough(e, f.sensing.count);
  if (arg.plot && ethd__picture_ready(message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  fit_arm(&f);
  if (ethd__stop) ethd__fail(ETHD_EXIT_FAILED, "stopped; nothing is written");
  ethd__finding_plant(&f);
  ethd__page_print(stdout, &f);
  write_files(&f, csv);
  free(f.residual);
  ethd__shooting_close(&f.problem);
  return ETHD_EXIT_DONE;
}

static int judge(const ethd__evidence *e) {
  char message[ETHD_MESSAGE_MAX];
  ethd__sensing sensing;
  ethd_plant plant = load_plant(arg.judge);
  if (ethd__sensing_find(e, &sensing, message)) ethd__fail(ETHD_EXIT_INPUT, "%s", message);
  ethd__evidence_enough(e, sensing.count);
  ethd__judgement j = ethd__prediction_judge(e, &plant);
  double floor = sensing.count / sqrt(12);
  printf("%zu window%s; errors of the prediction, rad rms; a count is %.4g rad, rounding to it leaves %.4g\n",
         j.windows, ethd__s(j.windows), sensing.count, floor);
  for (int i = 0; i < 2; i++)
    printf("  joint %d   one tick ahead %.4g (%.2f counts), %.0f ms ahead %.4g (%.2f counts)\n", i + 1, j.step[i],
           j.step[i] / sensing.count, 1e3 * ETHD__AHEAD, j.ahead[i], j.ahead[i] / sensing.count);
  return ETHD_EXIT_DONE;
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "[DIR...]", doc, NULL, NULL, NULL};
  static ethd__evidence evidence;
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  if (arg.excite) ethd__container_keeper();
  if (arg.excite) return ethd__end(ethd__excite(&arg.excitation));
  ethd__catch_interrupt();
  evidence.plugins = arg.plugins;
  for (int i = 0; i < arg.folder_count; i++) ethd__receive(arg.folders[i]);
  load_evidence(&evidence);
  int code = arg.judge ? judge(&evidence) : identify(&evidence);
  ethd__evidence_free(&evidence);
  return ethd__end(code);
}
