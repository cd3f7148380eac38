/* A study's figures, tables and page. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/cli.h"
#include "ethd/ethd.h"
#include "report/report.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/text.h"

static const char doc[] =
    "Counts and draws the taps of a study: traces of taps, states and beta, box plots, Table 1 beside the paper's, "
    "delays between sight and touch, reasons, survey, strategies compared within participants.\v"
    "The folder is one of ethd-study's, a session or a simulation. DIR/report holds report.html, which stands alone, "
    "and the pictures and tidy CSV files behind it. It needs gnuplot.\n\n"
    "Examples:\n"
    "  ethd-report session\n"
    "  ethd-report session --beside crowd --tap P02-06-004";

enum { OPTION_BESIDE = 256, OPTION_TAP, OPTION_POINT, OPTION_SEED, OPTION_PLUGINS, OPTION_FORCE };

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "where the report goes (default: report, in the study's folder)", 0},
    {"beside", OPTION_BESIDE, "DIR", 0, "another folder of taps, to stand beside this one's", 0},
    {"tap", OPTION_TAP, "NAME", 0, "draw this tap (P02-06-004), not the typical one of each cell", 0},
    {"point", OPTION_POINT, "K", 0, "point of a grid that is shown in full (0)", 0},
    {"plugins", OPTION_PLUGINS, NULL, 0, "run the plugins that the folder's configuration names", 0},
    {"force", OPTION_FORCE, NULL, 0, "replace a report that is there", 0},
    {"seed", OPTION_SEED, "S", 0, "seed of the bootstrap (1)", 0},
    {0},
};

static struct {
  const char *folder, *out, *beside, *tap;
  int64_t point;
  uint64_t seed;
  bool plugins, force;
} arg = {.seed = 1};

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'o': arg.out = text; return 0;
  case OPTION_BESIDE: arg.beside = text; return 0;
  case OPTION_TAP: arg.tap = text; return 0;
  case OPTION_POINT: arg.point = ethd__option_integer("--point", text, 0, ETHD_STUDY_POINTS); return 0;
  case OPTION_SEED: arg.seed = ethd__option_seed("--seed", text); return 0;
  case OPTION_PLUGINS: arg.plugins = true; return 0;
  case OPTION_FORCE: arg.force = true; return 0;
  case ARGP_KEY_ARG:
    if (arg.folder) argp_error(state, "\"%s\": one folder is allowed", text);
    arg.folder = text;
    return 0;
  case ARGP_KEY_END:
    if (!arg.folder) argp_error(state, "DIR is needed");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

/* Of what is drawn and written. */
static void check_job(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

static void load(const char *folder, size_t point, ethd__folder *out, ethd__data *data) {
  char message[ETHD_MESSAGE_MAX], *taps = ethd__folder_path(folder, ETHD_STUDY_TAPS);
  check(ethd__folder_open(folder, arg.plugins, out, message), message);
  if (access(taps, F_OK) != 0)
    ethd__fail(ETHD_EXIT_INPUT, "%s: No such file; ethd-study --resume %s or --merge %s makes it", taps, folder,
               folder);
  check(ethd__data_read(taps, &out->loaded.plant, point, data, message), message);
  free(taps);
}

/* Where people have led the finger, events have a clock. */
static bool led_by_people(const ethd__report *r) {
  char *path = ethd__folder_path(r->folder->path, ETHD_STUDY_EVENTS);
  ethd__sheet events = {0};
  bool found = access(path, F_OK) == 0 && !ethd__sheet_read(path, &events, r->message);
  free(path);
  int utc = found ? ethd__sheet_column(&events, "utc") : -1;
  bool led = false;
  for (size_t row = 0; row < events.rows; row++) led |= *ethd__sheet_cell(&events, row, utc) != 0;
  ethd__sheet_free(&events);
  return led;
}

static void print_origin(ethd__report *r) {
  if (ethd__report_measured(r)) {
    ethd__html_print(
        &r->page,
        "<b>Measured</b> on the device <code>%s</code> of config.ini, with people's fingers in it: the ring as the "
        "encoders have it, the finger as its filter has it. A finger counts as touching %.2g mm from the ring on.",
        r->folder->loaded.config->device, 1e3 * r->folder->protocol.slack);
    return;
  }
  ethd__html_markup(&r->page, "<b>Simulated, not measured.</b> ");
  ethd__html_markup(
      &r->page,
      led_by_people(r)
          ? "People led the hand; device and finger are plausible: the plant was fitted to Table 1 of the paper."
          : "Device, finger and people are plausible: the plant was fitted to Table 1 of the paper, the spread "
            "between people is assumed.");
}

static void print_lead(ethd__report *r) {
  const ethd__data *d = &r->data;
  size_t taps = 0, valid = 0;
  for (size_t i = 0; i < d->group_count; i++) {
    taps += d->group[i].cell.count;
    valid += ethd__cell_valid(&d->group[i].cell);
  }
  ethd__html_print(
      &r->page,
      "<p class=\"lead\">%zu participants, %zu cells, %zu test taps, %zu of them valid; %zu training taps.</p>\n",
      d->people_count, d->group_count, taps, valid, d->training);
  ethd__html_markup(&r->page, "<p class=\"note\">");
  print_origin(r);
  ethd__html_markup(&r->page,
                    " Laws and gains are those of the configuration, the paper's unless it says otherwise.</p>\n");
  ethd__html_markup(&r->page, "<nav>");
  static const char *const links[][2] = {{"table1", "Table 1"},   {"figures", "Figures"},  {"delay", "Delay"},
                                         {"valid", "Valid taps"}, {"pairs", "Comparison"}, {"survey", "Survey"},
                                         {"traces", "Traces"},    {"methods", "Methods"}};
  for (size_t i = 0; i < sizeof links / sizeof *links; i++)
    ethd__html_print(&r->page, "<a href=\"#%s\">%s</a>", links[i][0], links[i][1]);
  ethd__html_markup(&r->page, "</nav>\n");
}

static void print_foot(ethd__report *r) {
  ethd__html_heading(&r->page, "data", "Data");
  ethd__html_markup(&r->page, "<p>The folder's README.md says what every file and column is. ");
  ethd__html_print(&r->page,
                   "Study hash <code>%s</code>; libethd %s. Any recorded tap repeats bit for bit: "
                   "<code>ethd-replay --verify DIR/taps/NAME</code>.</p>\n",
                   r->folder->hash, ETHD_VERSION);
}

static ethd_status sections(ethd__report *r) {
  ethd_status (*const each[])(ethd__report *) = {ethd__report_table1, ethd__report_boxes,  ethd__report_reasons,
                                                 ethd__report_pairs,  ethd__report_survey, ethd__report_traces,
                                                 ethd__report_grid};
  ethd_status status = ETHD_OK;
  char title[128];
  snprintf(title, sizeof title, "Tapping study: %s", r->folder->protocol.name);
  ethd__html_begin(&r->page, title);
  print_lead(r);
  for (size_t i = 0; !status && i < sizeof each / sizeof *each; i++) status = each[i](r);
  if (status) return status;
  ethd__report_methods(r);
  print_foot(r);
  ethd__html_end(&r->page);
  return ETHD_OK;
}

static void write_page(ethd__report *r) {
  static const char *const files[] = {"report.html", "*.csv", "*.png", NULL};
  char *path = ethd__report_path(r, "report.html");
  ethd_replace replace;
  ethd__claim claim;
  if (ethd__claim_holds(r->folder->path, NULL, r->out))
    ethd__fail(ETHD_EXIT_INPUT, "--out: %s is the study's own folder; another one is needed", r->out);
  check(ethd__claim_folder(r->out, files, arg.force, &claim, r->message), r->message);
  check_job(ethd__picture_ready(r->message), r->message);
  check_job(ethd_replace_begin(path, &replace, r->message), r->message);
  r->page.file = replace.file;
  ethd_status status = sections(r);
  if (status) ethd_replace_abandon(&replace);
  check_job(status, r->message);
  check_job(ethd_replace_commit(&replace, r->message), r->message);
  ethd__claim_release(&claim);
  printf("%s\n", path);
  free(path);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "DIR", doc, NULL, NULL, NULL};
  char message[ETHD_MESSAGE_MAX] = "";
  static ethd__report report;
  ethd__folder folder, beside;
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  char *out = arg.out ? NULL : ethd__folder_path(arg.folder, "report");
  report = (ethd__report){.folder = &folder,
                          .out = out ? out : arg.out,
                          .tap = arg.tap,
                          .point = (size_t)arg.point,
                          .seed = arg.seed,
                          .message = message};
  load(arg.folder, report.point, &folder, &report.data);
  if (arg.beside) {
    load(arg.beside, 0, &beside, &report.beside);
    report.beside_name = beside.protocol.name;
  }
  write_page(&report);
  ethd__data_free(&report.data);
  ethd__data_free(&report.beside);
  if (arg.beside) ethd__folder_close(&beside);
  ethd__folder_close(&folder);
  free(out);
  return ethd__end(ETHD_EXIT_DONE);
}
