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
#include "statistics/coverage.h"
#include "study/stations.h"
#include "study/sums.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/text.h"

static const char doc[] =
    "Counts and draws the taps of a study: traces of taps, states and beta, box plots, Table 1 beside the paper's, "
    "delays between sight and touch, reasons, the survey, and strategies compared within participants.\v"
    "DIR is a folder of ethd-study, of a session or a simulation; several are stations of one study, with participants "
    "of their own. The first one's report/ gets report.html, which needs no other file, and the pictures and tidy CSV "
    "files behind it. Drawing needs gnuplot.\n\n"
    "Examples:\n"
    "  ethd-report session\n"
    "  ethd-report left-room right-room --out report\n"
    "  ethd-report session --beside crowd --tap P02-06-004";

enum { OPTION_BESIDE = 256, OPTION_TAP, OPTION_POINT, OPTION_SEED, OPTION_PLUGINS, OPTION_FORCE, OPTION_COVERAGE };

static const struct argp_option options[] = {
    {"out", 'o', "DIR", 0, "where the report goes (default: report, in the study's folder)", 0},
    {"beside", OPTION_BESIDE, "DIR", 0, "show the taps of another folder beside this one's", 0},
    {"tap", OPTION_TAP, "NAME", 0, "draw this tap (P02-06-004), not the typical one of each cell", 0},
    {"point", OPTION_POINT, "K", 0, "point of a grid that is shown in full (0)", 0},
    {"plugins", OPTION_PLUGINS, NULL, 0, "run the plugins that the folder's configuration names", 0},
    {"force", OPTION_FORCE, NULL, 0, "replace a report that is there", 0},
    {"seed", OPTION_SEED, "S", 0, "seed of the bootstrap (1)", 0},
    {"coverage", OPTION_COVERAGE, "N", 0,
     "instead of a report, print how often its intervals hold the truth in N simulated studies", 0},
    {0},
};

static struct {
  const char *folder[ETHD_STUDY_STATIONS], *out, *beside, *tap;
  size_t folders;
  int64_t coverage;
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
  case OPTION_COVERAGE: arg.coverage = ethd__option_integer("--coverage", text, 1, 1000000); return 0;
  case OPTION_FORCE: arg.force = true; return 0;
  case ARGP_KEY_ARG:
    if (arg.folders == ETHD_STUDY_STATIONS)
      argp_error(state, "\"%s\": %d folders are allowed", text, ETHD_STUDY_STATIONS);
    arg.folder[arg.folders++] = text;
    return 0;
  case ARGP_KEY_END:
    if (!arg.folders && !arg.coverage) argp_error(state, "DIR is needed");
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

/* The tables of folders of one study; `out` is the first one's. */
static void load(const ethd__stations *stations, size_t point, ethd__folder *out, ethd__sheet table[ETHD_TABLES],
                 ethd__data *data) {
  char message[ETHD_MESSAGE_MAX];
  const char *folder = stations->folder[0];
  check(ethd__folder_open(folder, arg.plugins, out, message), message);
  check(ethd__gather(stations, table, message), message);
  if (!table[ETHD_TABLE_TAPS].columns)
    ethd__fail(ETHD_EXIT_INPUT, "%s/%s: No such file; ethd-study --resume %s or --merge %s makes it", folder,
               ETHD_STUDY_TAPS, folder, folder);
  check(
      ethd__data_of(&table[ETHD_TABLE_TAPS], &table[ETHD_TABLE_PARTICIPANTS], &out->loaded.plant, point, data, message),
      message);
}

/* Until all is printed, or Ctrl-C. */
static void print_coverage(void) {
  static const size_t people[] = {3, 6, 12, 24};
  printf("Of %lld simulated studies (normal, %d taps a cell) so many have their truth within the 95 %% interval:\n\n"
         "participants  bootstrap of a median  bootstrap of Cliff's delta  t of a mean difference  d_z, noncentral t\n",
         (long long)arg.coverage, ETHD_COVERAGE_TAPS);
  for (size_t i = 0; i < sizeof people / sizeof *people && !ethd__stop; i++) {
    ethd__coverage c = ethd__coverage_of(people[i], (size_t)arg.coverage, arg.seed);
    printf("%12zu  %21.3f  %26.3f  %22.3f  %17.3f\n", c.people, c.median, c.cliff, c.mean, c.effect);
    fflush(stdout);
  }
}

/* What was changed is named, and the page goes on: nothing here can tell which of the two is right. */
static void print_sums(ethd__report *r) {
  char message[ETHD_MESSAGE_MAX];
  size_t all = 0, files;
  for (size_t i = 0; i < r->stations.count; i++, all += files) {
    const char *folder = r->stations.folder[i];
    size_t n = strlen(folder);
    if (!ethd__sums_check(folder, &files, message)) continue;
    ethd__html_print(&r->page, "<p class=\"note\"><b>Check sums:</b> %s.</p>\n",
                     strncmp(message, folder, n) ? message : message + n + strspn(message + n, "/: "));
    return;
  }
  ethd__html_print(&r->page, "<p class=\"note\">All %zu files are as SHA256SUMS says.</p>\n", all);
}

static void print_foot(ethd__report *r) {
  ethd__html_heading(&r->page, "data", "Data");
  ethd__html_markup(&r->page, "<p>The folder's README.md says what every file and column is. ");
  ethd__html_print(&r->page,
                   "Study hash <code>%s</code>; libethd %s. Any recorded tap repeats bit for bit: "
                   "<code>ethd-replay --verify DIR/taps/NAME</code>.</p>\n",
                   r->folder->hash, ETHD_VERSION);
  print_sums(r);
}

static ethd_status sections(ethd__report *r) {
  ethd_status (*const each[])(ethd__report *) = {ethd__report_table1,      ethd__report_claims,    ethd__report_boxes,
                                                 ethd__report_reasons,     ethd__report_validity,  ethd__report_pairs,
                                                 ethd__report_interaction, ethd__report_survey,    ethd__report_forces,
                                                 ethd__report_traces,      ethd__report_encounter, ethd__report_tidy,
                                                 ethd__report_grid};
  ethd_status status = ETHD_OK;
  char title[128], *text = NULL;
  size_t length;
  ethd__html page = r->page; /* its head counts what the sections find: they are written first, and stand below it */
  r->page.file = open_memstream(&text, &length);
  if (!r->page.file) ethd__fail_memory();
  for (size_t i = 0; !status && i < sizeof each / sizeof *each; i++) status = each[i](r);
  if (fclose(r->page.file)) ethd__fail_memory();
  r->page = page;
  snprintf(title, sizeof title, "Tapping study: %s", r->folder->protocol.name);
  ethd__html_begin(&r->page, title);
  ethd__report_origin(r);
  ethd__html_append(&r->page, text, length);
  free(text);
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
  for (size_t i = 0; i < r->stations.count; i++)
    if (ethd__claim_holds(r->stations.folder[i], NULL, r->out))
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
  static const struct argp argp = {options, parse, "DIR...", doc, NULL, NULL, NULL};
  char message[ETHD_MESSAGE_MAX] = "";
  static ethd__report report;
  ethd__folder folder, beside;
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  if (arg.coverage) {
    ethd__catch_interrupt();
    print_coverage();
    return ethd__end(ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE);
  }
  for (size_t i = 0; i < arg.folders; i++) ethd__receive(arg.folder[i]);
  ethd__receive(arg.beside);
  char *out = arg.out ? NULL : ethd__folder_path(arg.folder[0], "report");
  report = (ethd__report){.folder = &folder,
                          .stations = {arg.folder, arg.folders},
                          .out = out ? out : arg.out,
                          .tap = arg.tap,
                          .point = (size_t)arg.point,
                          .seed = arg.seed,
                          .message = message};
  load(&report.stations, report.point, &folder, report.table, &report.data);
  if (arg.beside) {
    const ethd__stations other = {&arg.beside, 1};
    ethd__sheet table[ETHD_TABLES];
    load(&other, 0, &beside, table, &report.beside);
    ethd__gather_free(table);
    report.beside_name = beside.protocol.name;
  }
  ethd__report_led(&report);
  write_page(&report);
  ethd__gather_free(report.table);
  ethd__data_free(&report.data);
  ethd__data_free(&report.beside);
  if (arg.beside) ethd__folder_close(&beside);
  ethd__folder_close(&folder);
  free(out);
  return ethd__end(ETHD_EXIT_DONE);
}
