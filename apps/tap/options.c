#include "tap/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "text/error_text.h"

#define TAPS 100u       /* per cell */
#define TAPS_PAPER 400u /* with --paper */
#define TAPS_FINGER 10u /* with a recorded movement */
#define TAPS_MAX 1000000
#define LEARN_MAX 1000

static const char doc[] =
    "Taps a virtual wall with a simulated encounter-type haptic display and a simulated or recorded finger, under each "
    "transition law at each speed, and prints its figures beside the paper's.\v"
    "Plants are fitted to the paper's Table 1, not measured; time is simulated. Tap k has the same finger under every "
    "law. The same seed gives the same bytes on every machine.\n\n"
    "FILE.csv has columns t_s,x_m,y_m, or those of --columns (further ones are ignored), of a movement towards -x. "
    "Commas, semicolons or tabs separate them. The movement is shifted so that its speed toward the wall, after its "
    "peak, has fallen to the given speed (low, high: 0.2, 0.4 m/s) where the ring meets the wall, or, with "
    "--validity=finger, where the finger touches it. Only --scale scales it. Speed is the slope of the least-squares "
    "line through the samples within 5 ms, at least one on either side; the path itself is not filtered. A tap on a "
    "recording begins once the ring is clear of the wall.\n\n"
    "--csv has every tap. Means are over the valid taps: the ring meets the wall before the finger touches, at 0.2 "
    "(low) or 0.4 m/s (high) within the bands of the plant's section [study], or at V +- (0.04 + 0.1 V) for a number "
    "V. Where a law stops the ring before the wall, a second table shows all laws by the rule of --validity finger.\n\n"
    "Figures, along the wall's normal, positive into it:\n"
    "  v_rvo    speed of the ring when it meets the wall\n"
    "  v_of     speed of the ring at the touch, interpolated; 0: at rest\n"
    "  d_max    first rebound of the ring in the wall, at least 0.1 mm\n"
    "  v_rmin   least speed of the ring after the touch: its rebound\n"
    "  Delta_s  duration of the braking\n"
    "  eps      distance of the rendered wall behind its place\n"
    "  v_hand   speed of the hand where a finger touches the wall\n"
    "  depth    depth of the ring in the wall at the touch\n"
    "  felt     eps 60 ms after the touch; 0 if the law never moves the wall\n\n"
    "--arm taps with a simulated robot arm in space, which takes velocities, instead of the paper's device: a plate on "
    "its flange goes before the finger by --gap and is to stand at a flat wall when the finger comes. A headset sees "
    "the finger 30 ms late, with a noise of 1 mm. A tap is valid if the finger, at the given speed (default 0.4 m/s), "
    "touches the plate no more than 1 mm before the wall; a touch before that is early. Felt offset is the plate's "
    "place behind the wall at the touch. TABLE is ur5e, fr3, iiwa7 or a file; --finger may name a folder of "
    "recordings, and their column z_m, if there is one, is used too. predictive needs the mass of a device, and "
    "without one does what offset does.\n\n"
    "Examples:\n"
    "  ethd-tap\n"
    "  ethd-tap --taps 400 --csv taps.csv --trace traces\n"
    "  ethd-tap --finger motion/avraham_free_mit/avraham_ND_s02_be38_free.csv\n"
    "  ethd-tap --config mine.ini --transition mine,offset --record taps\n"
    "  ethd-tap --paper --plant q\n"
    "  ethd-tap --arm ur5e --delay 0.03 --plot sensitivity.png\n"
    "  ethd-tap --arm ur5e --finger motion/avraham_free_mit\n"
    "Eight recorded movements are installed in the folder motion; a FILE.csv that doesn't exist here is searched "
    "there.";

enum {
  OPTION_SCALE = 256,
  OPTION_TRACE,
  OPTION_RECORD,
  OPTION_CSV,
  OPTION_FORCE,
  OPTION_VALIDITY,
  OPTION_LEARN,
  OPTION_SET,
  OPTION_PAPER,
  OPTION_UNITS,
  OPTION_COLUMNS
};

static const struct argp_option options[] = {
    {"config", 'c', "C.ini", 0, "the controller's configuration (default: the plant's own)", 0},
    {"transition", 't', "LAW[,LAW..]", 0,
     "transition laws, also of the configuration's plugins (default: abrupt,smooth,offset,predictive and the "
     "configuration's own; with --arm abrupt,smooth,offset,approach)",
     0},
    {"speed", 's', "low|high|V[,..]", 0, "speeds: low,high; V in m/s, 0.01 to 2 (with --arm 0.4)", 0},
    {"taps", 'n', "N", 0,
     "attempts for each law and speed (100; 10 with --finger, and with --arm one for each recording, at least 10; with "
     "--paper 400, twice as many at high speed)",
     0},
    {"seed", 'r', "S", 0, "seed of every random number (1)", 0},
    {"plant", 'p', "q|n|b|p|FILE", 0,
     "the simulated device and finger (default: that of --config, else q); FILE.ini stands beside FILE.plant", 0},
    {"finger", 'f', "FILE.csv", 0, "use a recorded movement as the hand's voluntary path", 0},
    {"columns", OPTION_COLUMNS, "T,X,Y", 0,
     "names of the movement's columns (t_s,x_m,y_m); -x_m reverses the sign of x_m", 0},
    {"units", OPTION_UNITS, "LENGTH[,TIME]", 0, "units of the movement: m, cm, mm or in, and s or ms (m,s)", 0},
    {"scale", OPTION_SCALE, "K", 0, "multiply the recorded positions by K, 0.01 to 100", 0},
    {"validity", OPTION_VALIDITY, "paper|finger", 0,
     "a tap is valid by the ring's meeting with the wall (paper, the default), or by the finger alone, by one rule for "
     "all laws",
     0},
    {"learn", OPTION_LEARN, "K", 0, "taps before each counted tap, from which a law can learn (0)", 0},
    {"set", OPTION_SET, "KEY=VALUE", 0,
     "change a section.key of the configuration or of the law's device data (arm.mass_x), with --arm one of [space] "
     "and of "
     "the laws; may be given more than once",
     0},
    {"csv", OPTION_CSV, "OUT.csv", 0, "write a row for each tap", 0},
    {"record", OPTION_RECORD, "DIR", 0,
     "record every tick of every tap, for ethd-replay --verify, with truth.npy and taps.csv beside it", 0},
    {"force", OPTION_FORCE, NULL, 0, "replace an existing recording or traces", 0},
    {"trace", OPTION_TRACE, "DIR", 0,
     "write DIR/LAW-SPEED.csv, the typical tap of each cell with a row per tick, for plots", 0},
    {"paper", OPTION_PAPER, NULL, 0,
     "print the paper's statements on its device as lines with bounds, and mark the lines that this plant misses (400 "
     "taps)",
     0},
    {0},
};

static ethd__tap_options arg = {.scale = 1, .seed = 1, .delay = NAN, .gap = 0.06, .rate = 72};
static ethd__tap_words columns, units; /* of the recorded movement */

typedef struct named {
  ethd__tap_words *list;
  const char *option;
} named;

static void add(const char *word, void *user) {
  const named *to = user;
  char quote[ETHD_QUOTE_MAX];
  for (size_t i = 0; i < to->list->count; i++)
    if (!strcmp(to->list->words[i], word))
      ethd__fail(ETHD_EXIT_INPUT, "%s: %s stands there twice", to->option, ethd__quote(word, strlen(word), quote));
  if (to->list->count == ETHD_TAP_WORDS)
    ethd__fail(ETHD_EXIT_INPUT, "%s: at most %d words are allowed", to->option, ETHD_TAP_WORDS);
  char *copy = strdup(word);
  if (!copy) ethd__fail_memory();
  to->list->words[to->list->count++] = copy;
}

static void drop(ethd__tap_words *words) {
  for (size_t i = 0; i < words->count; i++) free((char *)words->words[i]);
  words->count = 0;
}

static void set_list(ethd__tap_words *words, const char *option, const char *text) {
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

static double unit_of(const char *word, const char *const *names, const double *sizes) {
  char quote[ETHD_QUOTE_MAX];
  for (; *names; names++, sizes++)
    if (!strcmp(*names, word)) return *sizes;
  ethd__fail(ETHD_EXIT_INPUT, "--units: found %s, m, cm, mm or in and then s or ms are allowed",
             ethd__quote(word, strlen(word), quote));
}

static ethd__movement_form form_of_movement(void) {
  static const char *const lengths[] = {"m", "cm", "mm", "in", NULL}, *const times[] = {"s", "ms", NULL};
  static const double metres[] = {1, 0.01, 0.001, 0.0254}, seconds[] = {1, 0.001};
  ethd__movement_form form = ethd__movement_si;
  if (columns.count && columns.count != 3)
    ethd__fail(ETHD_EXIT_INPUT, "--columns: %zu names; those of time, x and y are needed", columns.count);
  if (units.count > 2) ethd__fail(ETHD_EXIT_INPUT, "--units: one of length and one of time are allowed");
  for (size_t i = 0; i < columns.count; i++) form.columns[i] = columns.words[i];
  if (units.count) form.length = unit_of(units.words[0], lengths, metres);
  if (units.count > 1) form.time = unit_of(units.words[1], times, seconds);
  form.length *= arg.scale;
  return form;
}

/* Cuts the option's text in two in place. */
static void add_gain(char *text) {
  char quote[ETHD_QUOTE_MAX], *equals = strchr(text, '=');
  if (!equals || !strchr(text, '.') || strchr(text, '.') > equals)
    ethd__fail(ETHD_EXIT_INPUT, "--set: found %s, section.key=value is allowed",
               ethd__quote(text, strlen(text), quote));
  if (arg.gain_count == ETHD_TAP_GAINS) ethd__fail(ETHD_EXIT_INPUT, "--set: at most %d are allowed", ETHD_TAP_GAINS);
  *equals = 0;
  arg.gains[arg.gain_count++] = (ethd__gain){text, equals + 1};
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case ARGP_KEY_INIT: state->child_inputs[0] = &arg; return 0;
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
  case OPTION_COLUMNS: set_list(&columns, "--columns", text); return 0;
  case OPTION_UNITS: set_list(&units, "--units", text); return 0;
  case OPTION_CSV: arg.csv = text; return 0;
  case OPTION_RECORD: arg.record = text; return 0;
  case OPTION_VALIDITY: arg.validity = validity_of(text); return 0;
  case OPTION_LEARN: arg.learn = (uint32_t)ethd__option_integer("--learn", text, 0, LEARN_MAX); return 0;
  case OPTION_SET: add_gain(text); return 0;
  case OPTION_TRACE: arg.trace = text; return 0;
  case OPTION_FORCE: arg.force = true; return 0;
  case OPTION_PAPER: arg.paper = true; return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  case ARGP_KEY_END:
    if ((arg.scaled || columns.count || units.count) && !arg.finger)
      argp_error(state, "--scale, --columns and --units need --finger");
    arg.form = form_of_movement();
    if (arg.paper && (arg.finger || arg.csv || arg.record || arg.trace || arg.laws.count || arg.speeds.count))
      argp_error(state, "--paper sets laws, speeds and a simulated hand, and writes no files; --config, --plant, "
                        "--set, --taps and --seed go with it");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

void ethd__tap_options_read(int argc, char **argv, ethd__tap_options *out) {
  static const struct argp_child arm[] = {{&ethd__reach_argp, 0, "With an arm in space:", 1}, {NULL, 0, NULL, 0}};
  static const struct argp argp = {options, parse, NULL, doc, arm, NULL, NULL};
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  if (!arg.speeds.count) set_list(&arg.speeds, "--speed", arg.arm ? "0.4" : "low,high");
  if (!arg.taps && !(arg.arm && arg.finger)) arg.taps = arg.paper ? TAPS_PAPER : arg.finger ? TAPS_FINGER : TAPS;
  *out = arg;
}

void ethd__tap_options_free(ethd__tap_options *o) {
  drop(&o->laws);
  drop(&o->speeds);
  drop(&columns);
  drop(&units);
}

void ethd__speeds_read(const ethd__tap_words *words, const ethd_plant *plant, ethd__speed *out) {
  char quote[ETHD_QUOTE_MAX];
  for (size_t i = 0; i < words->count; i++)
    if (!ethd__speed_parse(words->words[i], plant, &out[i]))
      ethd__fail(ETHD_EXIT_INPUT, "--speed: found %s; low, high and numbers from 0.01 to 2 are allowed",
                 ethd__quote(words->words[i], strlen(words->words[i]), quote));
}

void ethd__tap_laws_choose(ethd__tap_options *o, const char *own) {
  named to = {&o->laws, "--transition"};
  if (o->laws.count) return;
  if (!own) {
    set_list(&o->laws, to.option, "abrupt,smooth,offset,approach");
    return;
  }
  set_list(&o->laws, to.option, "abrupt,smooth,offset,predictive");
  for (size_t i = 0; i < o->laws.count; i++)
    if (!strcmp(o->laws.words[i], own)) return;
  add(own, &to);
}
