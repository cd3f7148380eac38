/* Does any plant within stated bounds explain what the paper measured, and gains that are the highest stable ones? */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "explain/search.h"
#include "report/picture.h"
#include "tap/load.h"

static const char doc[] =
    "Searches for a plant of the simulated device that explains the paper: the eight statistics of its Table 1, the "
    "sentences of its section 4, and gains that are \"the highest possible while remaining stable\".\v"
    "No plant that meets all of it has been found within these bounds, and n stays the default. On a rigid device "
    "the low row of Table 1 can't be met together with gains at their limit; a transmission that gives way meets the "
    "row, but there the brake's damping is unstable. apps/explain/README.md has the figures.\n\n"
    "The device's numbers are searched within bounds that its data sheets allow (ethd-explain --priors). Each line of "
    "what the paper says has bounds, too: a mean must lie within 1.5 standard errors of nine taps, a standard "
    "deviation within an F test's 5 %, a sentence must hold as it is written, and each gain must become unstable at "
    "1.2 to 2.5 times its value while the others stay. The search makes the sum of the misses small, to which a line "
    "adds 4 at most. It ends once that sum hasn't fallen by a hundredth for as many generations as --still says. Then "
    "the best plant is judged with other fingers, by 400 taps.\n\n"
    "--without leaves a group of lines out, which shows what can't be met together.\n\n"
    "Examples:\n"
    "  ethd-explain --generations 200 --work search.journal --out q\n"
    "  ethd-explain --without limits\n"
    "  ethd-explain --judge n --judge p --judge ./q --plot lines.png";

#define JUDGED_MAX 8 /* plants in a picture */

enum { COMPLIANT = 256, SAMPLE, JUDGE, WITHOUT, POPULATION, GENERATIONS, STILL, TAPS, WORK, PRIORS, BOUND, CSV, PLOT };

static const struct argp_option options[] = {
    {"compliant", COMPLIANT, NULL, 0, "let the transmission give way, with the encoders on the motors' side", 0},
    {"sample", SAMPLE, NULL, 0, "count a reading from where the ring was when it was taken, not from where it is", 0},
    {"judge", JUDGE, "n|b|p|FILE", 0,
     "don't search: judge a plant with the configuration beside it; may be given more than once", 0},
    {"without", WITHOUT, "table|claims|limits", 0, "leave these lines out; may be given more than once", 0},
    {"population", POPULATION, "N", 0, "number of plants in each generation (48)", 0},
    {"generations", GENERATIONS, "N", 0, "number of generations at most (100)", 0},
    {"still", STILL, "N", 0, "generations without a better plant after which a search ends (40)", 0},
    {"taps", TAPS, "N", 0, "taps of each law at low speed; at high speed there are twice as many (60)", 0},
    {"seed", 'r', "S", 0, "seed of the search and its taps (1)", 0},
    {"work", WORK, "FILE", 0, "keep what was judged, so that the same command goes on after an interruption", 0},
    {"out", 'o', "NAME", 0, "write the best plant: NAME.plant, NAME.ini", 0},
    {"bound", BOUND, "NAME=LOW:HIGH", 0, "search a number of --priors within other bounds; may be given more than once",
     0},
    {"csv", CSV, "OUT.csv", 0, "write the lines of each plant that is judged", 0},
    {"plot", PLOT, "OUT.png", 0, "draw them, with --csv (gnuplot)", 0},
    {"priors", PRIORS, NULL, 0, "print the bounds and where they come from", 0},
    {0},
};

static struct {
  ethd__explain_structure structure;
  bool without[ETHD_EXPLAIN_GROUPS], priors;
  int64_t population, generations, still, taps;
  uint64_t seed;
  const char *work, *out, *csv, *plot;
  const char *judged[JUDGED_MAX];
  size_t judged_count;
} arg = {.structure.tick = true, .population = 48, .generations = 100, .still = 40, .taps = 60, .seed = 1};

static void leave_out(const char *text) {
  for (int g = 0; g < ETHD_EXPLAIN_GROUPS; g++)
    if (!strcmp(text, ethd__explain_group_names[g])) {
      arg.without[g] = true;
      return;
    }
  ethd__fail(ETHD_EXIT_INPUT, "--without: table, claims and limits are allowed");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case COMPLIANT: arg.structure.compliant = true; return 0;
  case SAMPLE: arg.structure.tick = false; return 0;
  case JUDGE:
    if (arg.judged_count == JUDGED_MAX) ethd__fail(ETHD_EXIT_INPUT, "--judge: at most %d are allowed", JUDGED_MAX);
    arg.judged[arg.judged_count++] = text;
    return 0;
  case WITHOUT: leave_out(text); return 0;
  case POPULATION:
    arg.population = ethd__option_integer("--population", text, 8, ETHD_EXPLAIN_POPULATION_MAX);
    return 0;
  case GENERATIONS: arg.generations = ethd__option_integer("--generations", text, 0, 100000); return 0;
  case STILL: arg.still = ethd__option_integer("--still", text, 1, 100000); return 0;
  case BOUND:
    if (!ethd__explain_bound(text))
      ethd__fail(ETHD_EXIT_INPUT, "--bound: NAME=LOW:HIGH with a name of --priors and 0 < LOW < HIGH is allowed");
    return 0;
  case CSV: arg.csv = text; return 0;
  case PLOT: arg.plot = ethd__option_picture("--plot", text); return 0;
  case TAPS: arg.taps = ethd__option_integer("--taps", text, 10, 10000); return 0;
  case 'r': arg.seed = ethd__option_seed("--seed", text); return 0;
  case WORK: arg.work = text; return 0;
  case 'o': arg.out = text; return 0;
  case PRIORS: arg.priors = true; return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  case ARGP_KEY_END:
    if (arg.without[0] && arg.without[1] && arg.without[2]) argp_error(state, "--without: nothing is left to explain");
    if (arg.plot && !arg.csv) argp_error(state, "--plot needs --csv: it draws that file");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
}

static void print_priors(void) {
  printf("%-18s %10s %10s  %s\n", "number", "from", "to", "unit: where the bounds come from");
  for (int n = 0; n < ETHD_EXPLAIN_NUMBERS; n++) {
    const ethd__explain_prior *p = &ethd__explain_priors[n];
    printf("%-18s %10.4g %10.4g  %s: %s\n", p->name, p->low, p->high, p->unit, p->origin);
  }
}

static void print_point(const ethd__explain_point *point) {
  printf("\n%-18s %10s %10s %10s  %s\n", "number", "is", "from", "to", "unit");
  for (int n = 0; n < ETHD_EXPLAIN_NUMBERS; n++) {
    const ethd__explain_prior *p = &ethd__explain_priors[n];
    printf("%-18s %10.4g %10.4g %10.4g  %s\n", p->name, ethd__explain_value(point, n), p->low, p->high, p->unit);
  }
}

/* With fingers that no search has met. */
static ethd__explain_figures confirm(const ethd__explain_question *question, const ethd__explain_twin *twin,
                                     const char *what) {
  char message[ETHD_MESSAGE_MAX];
  ethd__explain_question q = *question;
  ethd__explain_figures figures;
  double total;
  q.seed += UINT64_C(1) << 32;
  q.taps = 400;
  for (int g = 0; g < ETHD_EXPLAIN_GROUPS; g++) q.asked[g] = true;
  check(ethd__explain_judge(&q, twin, (double)INFINITY, &figures, &total, message), message);
  printf("\n%s: 400 taps of each law at low speed, 800 at high speed\n", what);
  int missed = ethd__explain_print(&figures);
  printf("%d of %d lines %s missed\n", missed, ETHD_EXPLAIN_LINE_COUNT, missed == 1 ? "is" : "are");
  return figures;
}

static void write_lines(const char *const *names, const ethd__explain_figures *figures, size_t count) {
  char message[ETHD_MESSAGE_MAX];
  const ethd__picture_value values[] = {{"in", arg.csv, true}, {"out", arg.plot, true}, {0}};
  if (arg.csv) check(ethd__explain_csv(arg.csv, names, figures, count, message), message);
  if (arg.plot && ethd__picture_draw("explain.gp", NULL, values, message) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

static void print_end(const ethd__explain_search *search) {
  printf("%llu plants were judged; the search is %s: the sum last fell by a hundredth in generation %u\n",
         (unsigned long long)search->judged, ethd__explain_at_end(search) ? "at its end" : "not at its end",
         search->lowered);
}

static ethd__explain_point search_it(const ethd__explain_question *question) {
  static ethd__explain_search search;
  char message[ETHD_MESSAGE_MAX];
  search = (ethd__explain_search){.question = question,
                                  .population = (uint32_t)arg.population,
                                  .generations = (uint32_t)arg.generations,
                                  .still = (uint32_t)arg.still,
                                  .journal = arg.work};
  ethd__catch_interrupt();
  check(ethd__explain_run(&search, message), message);
  const uint32_t best = ethd__explain_best(&search);
  printf("%u generations of %u plants, %s transmission, readings counted from where the ring %s: least sum of misses "
         "%.3f\n",
         search.done, search.population, arg.structure.compliant ? "compliant" : "rigid",
         arg.structure.tick ? "is" : "was", search.total[best]);
  print_end(&search);
  return search.point[best];
}

/* What is read isn't written over. */
static void refuse_inputs(const ethd__loaded *loaded) {
  static const char *const suffixes[] = {".plant", ".ini"};
  for (int i = 0; arg.out && i < 2; i++) {
    char *name;
    if (asprintf(&name, "%s%s", arg.out, suffixes[i]) < 0) ethd__fail_memory();
    ethd__refuse_input("--out", name, "the plant that the search begins from", loaded->plant_path);
    ethd__refuse_input("--out", name, "the configuration beside that plant", loaded->path);
    ethd__refuse_same("--work", arg.work, "--out", name);
    free(name);
  }
}

/* The search, its best plant, and where that goes. */
static void find_plant(ethd__explain_question *question) {
  static const char *const name = "found";
  char message[ETHD_MESSAGE_MAX];
  ethd__explain_twin twin;
  const ethd__explain_point point = search_it(question);
  print_point(&point);
  if (ethd__stop)
    ethd__fail(ETHD_EXIT_FAILED, "stopped; nothing is written%s",
               arg.work ? ", and the same command goes on" : "; with --work the next run would go on");
  ethd__explain_make(&question->base, &arg.structure, &point, &twin);
  const ethd__explain_figures figures =
      confirm(question, &twin, "the best plant, with fingers that the search didn't meet");
  write_lines(&name, &figures, 1);
  if (arg.out) check(ethd__explain_write(arg.out, &point, &twin, message), message);
}

static ethd__explain_question question_of(const ethd__loaded *loaded) {
  ethd__explain_question question = {.config = loaded->config,
                                     .base = loaded->plant,
                                     .structure = arg.structure,
                                     .seed = arg.seed,
                                     .taps = (uint32_t)arg.taps};
  for (int g = 0; g < ETHD_EXPLAIN_GROUPS; g++) question.asked[g] = !arg.without[g];
  return question;
}

static void judge_plants(void) {
  ethd__loaded loaded[JUDGED_MAX];
  ethd__explain_figures figures[JUDGED_MAX];
  const char *names[JUDGED_MAX];
  for (size_t i = 0; i < arg.judged_count; i++) {
    ethd__load(NULL, arg.judged[i], true, false, &loaded[i]);
    ethd__refuse_input("--csv", arg.csv, "--judge", loaded[i].plant_path);
    ethd__refuse_input("--csv", arg.csv, "the configuration beside a plant of --judge", loaded[i].path);
    ethd__explain_question question = question_of(&loaded[i]);
    const char *slash = strrchr(loaded[i].plant_name, '/');
    names[i] = slash ? slash + 1 : loaded[i].plant_name;
    figures[i] = confirm(&question, &(ethd__explain_twin){.plant = loaded[i].plant}, loaded[i].plant_name);
  }
  write_lines(names, figures, arg.judged_count);
  for (size_t i = 0; i < arg.judged_count; i++) ethd__loaded_free(&loaded[i]);
}

static void search_plants(void) {
  ethd__loaded loaded;
  ethd__load(NULL, "n", true, false, &loaded);
  refuse_inputs(&loaded);
  ethd__explain_question question = question_of(&loaded);
  find_plant(&question);
  ethd__loaded_free(&loaded);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  char message[ETHD_MESSAGE_MAX];
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__refuse_same("--work", arg.work, "--csv", arg.csv);
  if (arg.plot) check(ethd__picture_ready(message), message);
  if (arg.priors)
    print_priors();
  else if (arg.judged_count)
    judge_plants();
  else
    search_plants();
  return ethd__end(ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE);
}
