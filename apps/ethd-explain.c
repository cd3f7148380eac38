/* Does any plant within stated bounds explain what the paper measured, and gains that are the highest stable ones? */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "explain/search.h"
#include "tap/load.h"

static const char doc[] =
    "Searches for a plant of the simulated device that explains the paper: the eight statistics of its Table 1, the "
    "sentences of its section 4, and gains that are \"the highest possible while remaining stable\".\v"
    "The device's numbers are looked for within bounds that its data sheets allow (ethd-explain --priors). Each line "
    "of "
    "what the paper says has bounds, too: means within 1.5 standard errors of nine taps, standard deviations within an "
    "F test's 5 %, sentences as they are written, and each gain unstable at 1.2 to 2.5 times its value, the others "
    "held. "
    "The search makes the sum of what is missed small; the best plant is then judged with other fingers, by 400 "
    "taps.\n\n"
    "--without leaves a group of lines out, so that it is seen which can't be met together.\n\n"
    "Examples:\n"
    "  ethd-explain --generations 200 --work search.journal --out q\n"
    "  ethd-explain --without limits";

enum { COMPLIANT = 256, SAMPLE, JUDGE, WITHOUT, POPULATION, GENERATIONS, TAPS, WORK, PRIORS };

static const struct argp_option options[] = {
    {"compliant", COMPLIANT, NULL, 0, "let the transmission give way, with the encoders on the motors' side", 0},
    {"sample", SAMPLE, NULL, 0, "count a reading from where the ring was as it was taken, not from where it is now", 0},
    {"judge", JUDGE, "n|b|p|FILE", 0, "don't search: judge a plant with the configuration beside it", 0},
    {"without", WITHOUT, "table|claims|limits", 0, "leave these lines out; repeat it", 0},
    {"population", POPULATION, "N", 0, "plants that are held: 48", 0},
    {"generations", GENERATIONS, "N", 0, "100", 0},
    {"taps", TAPS, "N", 0, "taps of each law at low speed, twice as many at high speed: 60", 0},
    {"seed", 'r', "S", 0, "of the search and its taps: 1", 0},
    {"work", WORK, "FILE", 0, "keep what was judged; the same command goes on", 0},
    {"out", 'o', "NAME", 0, "write the best plant: NAME.plant, NAME.ini", 0},
    {"priors", PRIORS, NULL, 0, "print the bounds and where they come from", 0},
    {0},
};

static struct {
  ethd__explain_structure structure;
  bool without[ETHD_EXPLAIN_GROUPS], priors;
  int64_t population, generations, taps;
  uint64_t seed;
  const char *work, *out, *judge;
} arg = {.structure.tick = true, .population = 48, .generations = 100, .taps = 60, .seed = 1};

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
  case JUDGE: arg.judge = text; return 0;
  case WITHOUT: leave_out(text); return 0;
  case POPULATION:
    arg.population = ethd__option_integer("--population", text, 8, ETHD_EXPLAIN_POPULATION_MAX);
    return 0;
  case GENERATIONS: arg.generations = ethd__option_integer("--generations", text, 0, 100000); return 0;
  case TAPS: arg.taps = ethd__option_integer("--taps", text, 10, 10000); return 0;
  case 'r': arg.seed = ethd__option_seed("--seed", text); return 0;
  case WORK: arg.work = text; return 0;
  case 'o': arg.out = text; return 0;
  case PRIORS: arg.priors = true; return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  case ARGP_KEY_END:
    if (arg.without[0] && arg.without[1] && arg.without[2]) argp_error(state, "--without: nothing is left to explain");
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
static void confirm(ethd__explain_question *q, const ethd__explain_twin *twin, const char *what) {
  char message[ETHD_MESSAGE_MAX];
  ethd__explain_figures figures;
  double total;
  q->seed += UINT64_C(1) << 32;
  q->taps = 400;
  for (int g = 0; g < ETHD_EXPLAIN_GROUPS; g++) q->asked[g] = true;
  check(ethd__explain_judge(q, twin, (double)INFINITY, &figures, &total, message), message);
  printf("\n%s: 400 taps of each law at low speed, 800 at high speed\n", what);
  int missed = ethd__explain_print(&figures);
  printf("%d of %d lines are missed\n", missed, ETHD_EXPLAIN_LINE_COUNT);
}

static ethd__explain_point search_it(const ethd__explain_question *question) {
  static ethd__explain_search search;
  char message[ETHD_MESSAGE_MAX];
  search = (ethd__explain_search){.question = question,
                                  .population = (uint32_t)arg.population,
                                  .generations = (uint32_t)arg.generations,
                                  .journal = arg.work};
  ethd__catch_interrupt();
  check(ethd__explain_run(&search, message), message);
  const uint32_t best = ethd__explain_best(&search);
  printf("%u generations of %u plants, %s transmission, readings counted from where the ring %s: least sum of misses "
         "%.3f\n",
         search.done, search.population, arg.structure.compliant ? "compliant" : "rigid",
         arg.structure.tick ? "is" : "was", search.total[best]);
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
  char message[ETHD_MESSAGE_MAX];
  ethd__explain_twin twin;
  const ethd__explain_point point = search_it(question);
  print_point(&point);
  if (ethd__stop)
    ethd__fail(ETHD_EXIT_FAILED, "stopped; nothing is written%s",
               arg.work ? ", and the same command goes on" : "; with --work the next run would go on");
  ethd__explain_make(&question->base, &arg.structure, &point, &twin);
  confirm(question, &twin, "the best plant, with fingers that the search didn't meet");
  if (arg.out) check(ethd__explain_write(arg.out, &point, &twin, message), message);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  ethd__loaded loaded;
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  if (arg.priors) {
    print_priors();
    return ethd__end(ETHD_EXIT_DONE);
  }
  ethd__load(NULL, arg.judge ? arg.judge : "n", true, false, &loaded);
  refuse_inputs(&loaded);
  ethd__explain_question question = {.config = loaded.config,
                                     .base = loaded.plant,
                                     .structure = arg.structure,
                                     .seed = arg.seed,
                                     .taps = (uint32_t)arg.taps};
  for (int g = 0; g < ETHD_EXPLAIN_GROUPS; g++) question.asked[g] = !arg.without[g];
  if (arg.judge)
    confirm(&question, &(ethd__explain_twin){.plant = loaded.plant}, loaded.plant_name);
  else
    find_plant(&question);
  ethd__loaded_free(&loaded);
  return ethd__end(ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE);
}
