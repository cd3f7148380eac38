/* Finds gains for a plant and its hands, and writes the user's configuration with them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/picture.h"
#include "ethd/ethd.h"
#include "tap/load.h"
#include "text/error_text.h"
#include "text/text.h"
#include "tune/options.h"
#include "tune/table.h"
#include "tune/tuned.h"

static ethd__tune_options arg;

/* ---- what is searched for ---- */

static void open_space(const ethd_config *config, ethd__tune_space *space) {
  char message[ETHD_MESSAGE_MAX];
  const char *law = arg.law ? arg.law : config->setup.transition->law.id;
  ethd__need(ethd__space_open(config, law, space, message), message);
}

/* Sets the ranges; what the user says of one has the last word. */
static void set_ranges(const ethd__tune_rig *rig, ethd__tune_space *space) {
  char message[ETHD_MESSAGE_MAX];
  ethd__score_widen(rig, space);
  for (size_t i = 0; i < arg.range_count; i++) ethd__need(ethd__space_range(space, arg.ranges[i], message), message);
}

/* ---- results ---- */

/* Returns what stands at the top of the tuned configuration. */
static char *head_of(const ethd__tune_search *search, const ethd__tune_entry *choice, const ethd__loaded *loaded,
                     const ethd__tune_worths *worths) {
  const ethd__tune_space *space = search->rig->space;
  ethd__printed out;
  FILE *f = ethd__print_begin(&out);
  fprintf(f, "Tuned by ethd-tune for plant %s (simulated), transition %s, margins %g and %g ms.\n", loaded->plant_name,
          space->law, arg.margin.gain, 1e3 * arg.margin.delay);
  ethd__tune_print_worths(f, space, &choice->point, worths);
  return ethd__print_end(&out);
}

static void write_tuned(const ethd__tune_search *search, const ethd__tune_entry *choice, const ethd__loaded *loaded,
                        const ethd__tune_worths *worths) {
  char message[ETHD_MESSAGE_MAX];
  const ethd__tune_space *space = search->rig->space;
  ETHD__FREED char *folder = ethd__path_folder(arg.out), *head = head_of(search, choice, loaded, worths);
  bool same = folder && space->config->folder && !strcmp(folder, space->config->folder);
  ETHD__FREED char *text = ethd__tuned_text(space, &choice->point, head, !same);
  ethd__need(ethd_text_write(arg.out, text, strlen(text), message), message);
}

static void draw(const ethd__tune_space *space, const ethd__loaded *loaded) {
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *heading = NULL;
  if (asprintf(&heading, "Gains for plant %s, transition %s", loaded->plant_name, space->law) < 0) ethd__fail_memory();
  const ethd__picture_value values[] = {
      {"in", arg.csv, true}, {"out", arg.plot, true}, {"heading", heading, false}, {0}};
  ethd__must(ethd__picture_draw("tune.gp", NULL, values, message), message);
}

static int show(const ethd__tune_search *search, const ethd__loaded *loaded) {
  char message[ETHD_MESSAGE_MAX];
  const ethd__tune_entry *choice = ethd__search_choice(search);
  ethd__tune_worths worths;
  printf("device       plant %s: simulated, plausible, not measured\n", loaded->plant_name);
  printf("margins      gains %g times, delay %g ms more, with %zu hand%s: %llu of %llu point%s %s them\n",
         arg.margin.gain, 1e3 * arg.margin.delay, arg.hands.count, ethd__s(arg.hands.count),
         (unsigned long long)search->kept, (unsigned long long)search->drawn, ethd__s(search->drawn),
         search->kept == 1 ? "keeps" : "keep");
  ethd__tune_print(stdout, search, choice);
  if (arg.csv) ethd__need(ethd__tune_csv(search, choice, arg.csv, message), message);
  if (arg.plot) draw(search->rig->space, loaded);
  if (!choice) {
    printf("\nno point came to rest with gains and delay at their margin, of %d that were tried; the last "
           "one "
           "swung\nby %.1f mm/s with %s there and %g of the hand: a smaller --gain-margin or --delay-margin, other "
           "--hands\n",
           (int)search->asked, 1e3 * search->verdict.swing, search->verdict.what ? search->verdict.what : "nothing",
           search->verdict.hand);
    return ETHD_EXIT_FAILED;
  }
  printf("chosen: the least sum of the four goals%s%s, confirmed in time at its margins (%d tried)\n",
         arg.prefer >= 0 ? ", twice for " : "", arg.prefer >= 0 ? ethd__tune_goal_names[arg.prefer] : "",
         (int)search->asked);
  (void)ethd__tune_print_margins(search->rig, &choice->point);
  ethd__need(ethd__tune_weigh(search, choice, &worths, message), message);
  printf("\n");
  ethd__tune_print_worths(stdout, search->rig->space, &choice->point, &worths);
  if (arg.out) write_tuned(search, choice, loaded, &worths);
  return ETHD_EXIT_DONE;
}

/* ---- the whole ---- */

static int search_it(ethd__tune_search *search, const ethd__loaded *loaded) {
  char message[ETHD_MESSAGE_MAX];
  bool over;
  ethd__need(ethd__search_run(search, &over, message), message);
  if (!over) fprintf(stderr, "%s: stopped; nothing is written\n", program_invocation_short_name);
  int code = over ? show(search, loaded) : ETHD_EXIT_FAILED;
  ethd__search_free(search);
  return code;
}

int main(int argc, char **argv) {
  char message[ETHD_MESSAGE_MAX];
  ethd__loaded loaded;
  ethd__tune_space space;
  ethd__speed speeds[ETHD_TUNE_SPEEDS];
  ethd__begin();
  ethd__tune_options_read(argc, argv, &arg);
  ethd__load(arg.config, arg.plant, true, true, &loaded);
  const char *const inputs[] = {arg.config, loaded.path, loaded.plant_path};
  for (int i = 0; i < 3; i++) {
    ethd__refuse_input("--out", arg.out, "--config or --plant", inputs[i]);
    ethd__refuse_input("--csv", arg.csv, "--config or --plant", inputs[i]);
    ethd__refuse_input("--plot", arg.plot, "--config or --plant", inputs[i]);
  }
  ethd__refuse_same("--csv", arg.csv, "--out", arg.out);
  ethd__refuse_same("--plot", arg.plot, "--out", arg.out);
  ethd__refuse_same("--plot", arg.plot, "--csv", arg.csv);
  open_space(loaded.config, &space);
  if (!ethd__speed_parse("low", &loaded.plant, &speeds[0]) || !ethd__speed_parse("high", &loaded.plant, &speeds[1]))
    ethd__fail(ETHD_EXIT_INPUT, "%s: a plant's speeds must be positive", loaded.plant_path);
  ethd__study study = {.config = loaded.config,
                       .plant = loaded.plant,
                       .seed = arg.seed,
                       .speeds = speeds,
                       .speed_count = ETHD_TUNE_SPEEDS};
  ethd__need(ethd__study_prepare(&study, message), message);
  const ethd__tune_rig rig = {&study, &space, arg.hands, arg.margin, arg.passive};
  set_ranges(&rig, &space);
  if (arg.plot) ethd__need(ethd__picture_ready(message), message);
  ethd__tune_search search = {.rig = &rig, .points = (uint32_t)arg.points, .taps = (uint32_t)arg.taps};
  for (int g = 0; g < ETHD_TUNE_GOALS; g++) search.weights[g] = g == arg.prefer ? 2 : 1;
  ethd__catch_interrupt();
  int code = search_it(&search, &loaded);
  ethd__loaded_free(&loaded);
  return ethd__end(code);
}
