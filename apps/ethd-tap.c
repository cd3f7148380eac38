/* The tapping study on the simulated device. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "record/recording_parts.h"
#include "tap/load.h"
#include "tap/run.h"
#include "tap/table.h"
#include "text/claim.h"
#include "text/error_text.h"
#include "text/text.h"

#define LIST_MAX 32
#define TAPS 100u       /* per cell */
#define TAPS_FINGER 10u /* with a recorded movement */
#define TAPS_MAX 1000000
#define LEARN_MAX 1000
#define GAINS_MAX 32

static const char doc[] =
    "Taps a virtual wall with a simulated encounter-type haptic display and a simulated or recorded finger, "
    "under each transition law at each speed, and prints figures beside the paper's.\v"
    "Plants are fitted to the paper's Table 1, not measured; nothing runs in real time. Tap k has the same "
    "finger under every law. The same seed gives the same bytes on every machine.\n\n"
    "FILE.csv has columns t_s,x_m,y_m (further ones are ignored) of a movement towards -x. It is shifted so that "
    "the finger touches the wall where its speed toward it, after its peak, has fallen to the given speed "
    "(low, high: 0.2, 0.4 m/s), and is never scaled unless --scale says so. Speed is the slope of the "
    "least-squares line through the samples within 5 ms, at least one on either side; the path itself is "
    "not filtered. A tap on a recording begins once the ring is clear of the wall.\n\n"
    "Every tap is in --csv. Means are over the valid taps, in which the ring met the wall before the finger touched, "
    "at 0.2 +- 0.06 (low) or 0.4 +- 0.08 m/s (high), or at V +- (0.04 + 0.1 V) for a number; plant p has "
    "bands of its own.\n\n"
    "Figures, along the wall's normal, positive into it:\n"
    "  v_rvo    the ring's speed as it meets the wall\n"
    "  v_of     the ring's speed as the finger touches it; near 0 is what a wall does\n"
    "  d_max    the ring's first rebound after the touch\n"
    "  v_rmin   its smallest speed after the touch: how fast it is thrown back\n"
    "  Delta_s  the time of braking\n"
    "  eps      how far behind its own place the wall is rendered\n\n"
    "Examples:\n"
    "  ethd-tap\n"
    "  ethd-tap --taps 400 --csv taps.csv --trace traces\n"
    "  ethd-tap --finger motion/avraham_free_mit/avraham_ND_s02_be38_free.csv\n"
    "  ethd-tap --config mine.ini --transition mine,offset --speed 0.3 --record taps\n"
    "Eight recorded movements come with the programs, in motion: a FILE.csv that isn't there is looked for among them.";

enum {
  OPTION_SCALE = 256,
  OPTION_TRACE,
  OPTION_RECORD,
  OPTION_CSV,
  OPTION_FORCE,
  OPTION_VALIDITY,
  OPTION_LEARN,
  OPTION_SET
};

static const struct argp_option options[] = {
    {"config", 'c', "C.ini", 0, "the controller's configuration (default: the plant's own)", 0},
    {"transition", 't', "LAW[,LAW..]", 0,
     "transition laws, also of the configuration's plugins (default: abrupt,smooth,offset,predictive and the "
     "configuration's own)",
     0},
    {"speed", 's', "low|high|V[,..]", 0, "speeds: low,high; V in m/s, 0.01 to 2", 0},
    {"taps", 'n', "N", 0, "attempts for each law and speed (100; 10 with --finger)", 0},
    {"seed", 'r', "S", 0, "seed of every random number (1)", 0},
    {"plant", 'p', "n|b|p|FILE", 0,
     "the simulated device and finger (default: that of --config, else n); a FILE.plant has FILE.ini beside it", 0},
    {"finger", 'f', "FILE.csv", 0, "use a recorded movement as the hand's voluntary path", 0},
    {"scale", OPTION_SCALE, "K", 0, "multiply the recorded positions by K, 0.01 to 100", 0},
    {"validity", OPTION_VALIDITY, "paper|finger", 0,
     "judge taps by how the ring meets the wall (paper, the default), or by the finger alone, alike for every law", 0},
    {"learn", OPTION_LEARN, "K", 0, "taps before each counted one, from which a law can learn (0)", 0},
    {"set", OPTION_SET, "KEY=VALUE", 0,
     "change a section.key of the configuration, or what the law knows of the device (arm.mass_x); may be given more "
     "than once",
     0},
    {"csv", OPTION_CSV, "OUT.csv", 0, "write a row for each tap", 0},
    {"record", OPTION_RECORD, "DIR", 0,
     "record every tick of every tap, for ethd-replay --verify, with truth.npy and taps.csv beside it", 0},
    {"force", OPTION_FORCE, NULL, 0, "replace a recording or traces that are there", 0},
    {"trace", OPTION_TRACE, "DIR", 0,
     "write DIR/LAW-SPEED.csv, the typical tap of each cell with a row per tick, for plots", 0},
    {0},
};

typedef struct choices {
  const char *words[LIST_MAX];
  size_t count;
} choices;

static struct {
  const char *config, *plant, *finger, *csv, *record, *trace;
  double scale;
  bool scaled, force;
  int64_t taps;
  uint64_t seed;
  choices laws, speeds;
  ethd__validity validity;
  uint32_t learn;
  ethd__gain gains[GAINS_MAX];
  size_t gain_count;
} arg = {.scale = 1, .seed = 1};

/* ---- options ---- */

typedef struct named {
  choices *list;
  const char *option;
} named;

static void add(const char *word, void *user) {
  const named *to = user;
  char quote[ETHD_QUOTE_MAX];
  for (size_t i = 0; i < to->list->count; i++)
    if (!strcmp(to->list->words[i], word))
      ethd__fail(ETHD_EXIT_INPUT, "%s: %s stands there twice", to->option, ethd__quote(word, strlen(word), quote));
  if (to->list->count == LIST_MAX)
    ethd__fail(ETHD_EXIT_INPUT, "%s: at most %d words are allowed", to->option, LIST_MAX);
  char *copy = strdup(word);
  if (!copy) ethd__fail_memory();
  to->list->words[to->list->count++] = copy;
}

static void drop(choices *words) {
  for (size_t i = 0; i < words->count; i++) free((char *)words->words[i]);
  words->count = 0;
}

static void set_list(choices *words, const char *option, const char *text) {
  named to = {words, option};
  drop(words);
  ethd__option_list(option, text, add, &to);
}

static ethd__validity validity_of(const char *text) {
  char quote[ETHD_QUOTE_MAX];
  if (strcmp(text, "finger") && strcmp(text, "paper"))
    ethd__fail(ETHD_EXIT_INPUT, "--validity: found %s, paper or finger is allowed",
               ethd__quote(text, strlen(text), quote));
  return strcmp(text, "finger") ? ETHD_TAP_BY_PAPER : ETHD_TAP_BY_FINGER;
}

/* The option's text is cut in two where it stands. */
static void add_gain(char *text) {
  char quote[ETHD_QUOTE_MAX], *equals = strchr(text, '=');
  if (!equals || !strchr(text, '.') || strchr(text, '.') > equals)
    ethd__fail(ETHD_EXIT_INPUT, "--set: found %s, section.key=value is allowed",
               ethd__quote(text, strlen(text), quote));
  if (arg.gain_count == GAINS_MAX) ethd__fail(ETHD_EXIT_INPUT, "--set: at most %d are allowed", GAINS_MAX);
  *equals = 0;
  arg.gains[arg.gain_count++] = (ethd__gain){text, equals + 1};
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'c': arg.config = text; return 0;
  case 't': set_list(&arg.laws, "--transition", text); return 0;
  case 's': set_list(&arg.speeds, "--speed", text); return 0;
  case 'n': arg.taps = ethd__option_integer("--taps", text, 1, TAPS_MAX); return 0;
  case 'r': arg.seed = ethd__option_seed("--seed", text); return 0;
  case 'p': arg.plant = text; return 0;
  case 'f': arg.finger = text; return 0;
  case OPTION_SCALE:
    arg.scale = ethd__option_number("--scale", text, 0.01, 100);
    arg.scaled = true;
    return 0;
  case OPTION_CSV: arg.csv = text; return 0;
  case OPTION_RECORD: arg.record = text; return 0;
  case OPTION_VALIDITY: arg.validity = validity_of(text); return 0;
  case OPTION_LEARN: arg.learn = (uint32_t)ethd__option_integer("--learn", text, 0, LEARN_MAX); return 0;
  case OPTION_SET: add_gain(text); return 0;
  case OPTION_TRACE: arg.trace = text; return 0;
  case OPTION_FORCE: arg.force = true; return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  case ARGP_KEY_END:
    if (arg.scaled && !arg.finger) argp_error(state, "--scale needs --finger");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static void fill_in(void) {
  if (!arg.speeds.count) set_list(&arg.speeds, "--speed", "low,high");
  if (!arg.taps) arg.taps = arg.finger ? TAPS_FINGER : TAPS;
}

/* All laws of this library and the configuration's own. */
static void choose_laws(const ethd_config *config) {
  const char *own = config->setup.transition->law.id;
  named to = {&arg.laws, "--transition"};
  if (arg.laws.count) return;
  set_list(&arg.laws, to.option, "abrupt,smooth,offset,predictive");
  for (size_t i = 0; i < arg.laws.count; i++)
    if (!strcmp(arg.laws.words[i], own)) return;
  add(own, &to);
}

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

static ethd__speed *load_speeds(const ethd_plant *plant) {
  char quote[ETHD_QUOTE_MAX];
  ethd__speed *speeds = calloc(arg.speeds.count, sizeof *speeds);
  if (!speeds) ethd__fail_memory();
  for (size_t i = 0; i < arg.speeds.count; i++)
    if (!ethd__speed_parse(arg.speeds.words[i], plant, &speeds[i]))
      ethd__fail(ETHD_EXIT_INPUT, "--speed: found %s; low, high and numbers from 0.01 to 2 are allowed",
                 ethd__quote(arg.speeds.words[i], strlen(arg.speeds.words[i]), quote));
  return speeds;
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

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  char message[ETHD_MESSAGE_MAX];
  ethd__loaded loaded;
  ethd__study study = {0};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  fill_in();
  ethd__load(arg.config, arg.plant, true, true, &loaded);
  choose_laws(loaded.config);
  study.config = loaded.config;
  study.plant = loaded.plant;
  study.speeds = load_speeds(&study.plant);
  study.speed_count = arg.speeds.count;
  study.seed = arg.seed;
  study.validity = arg.validity;
  study.learn = arg.learn;
  study.gains = arg.gains;
  study.gain_count = arg.gain_count;
  if (arg.finger) {
    char *finger = ethd__given_or_data(arg.finger);
    check(ethd__movement_load(finger, arg.scale, &study.movement, message), message);
    free(finger);
  }
  check(ethd__study_prepare(&study, message), message);
  const ethd__tap_plan plan = {&study, arg.laws.words, arg.laws.count, (uint64_t)arg.taps};
  check(ethd__plan_check(&plan, message), message);
  const ethd__heading heading = {loaded.plant_name, arg.config ? arg.config : base_name(loaded.path), arg.finger,
                                 arg.scale, arg.scaled};
  ethd__catch_interrupt();
  int code = run(&plan, &heading);
  ethd__movement_free(&study.movement);
  ethd__loaded_free(&loaded);
  drop(&arg.laws);
  drop(&arg.speeds);
  free(study.speeds);
  return ethd__end(code);
}
