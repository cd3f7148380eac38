#include "tune/options.h"

#include <string.h>

#include "cli/cli.h"
#include "text/error_text.h"

#define POINTS 384
#define TAPS 160

#define BUYS(name, low, high, buys) "  " name ": " buys ".\n"

static const char doc[] =
    "Finds gains for a device that a plant file describes.\v"
    "Tries gains of tracking, contact and transition and the filters' cut-offs, in ranges about the configuration's "
    "values. The benefit and cost of larger values:\n\n" ETHD_TUNE_KNOWN(
        BUYS) "\nPoints that don't keep the margins in every loop, along both axes and with every hand, are left out. "
              "The others are tapped on the simulated device, in four rounds of ever fewer points. It prints the "
              "Pareto front of tracking, braking, wall and calm, and chooses the point with the least weighted sum of "
              "the four (mean logarithms of their figures over the configuration's own); --prefer doubles one weight. "
              "The plants are simulated: test the gains on the device.\n\n"
              "Margins are those of ethd-check: they include an elastic transmission, but no friction, because "
              "friction stops only small oscillations. Where the configuration's own gains don't keep them (plant p's "
              "wall and brake chatter on the motors' side), lower dampings are tried, and the table shows their cost. "
              "A simulation confirms the choice, with gains and delay at their margin.\n\n"
              "Example:\n"
              "  ethd-tune --plant n --out tuned.ini --plot tuned.png\n"
              "  ethd-tune --plant mine.plant --config mine.ini --out best.ini";

enum { GAIN_MARGIN = 256, DELAY_MARGIN, HANDS, PASSIVE, PREFER, RANGE, POINTS_OPTION, TAPS_OPTION, CSV, PLOT, SEED };

static const struct argp_option options[] = {
    {"plant", 'p', "q|n|b|p|FILE", 0, "plant of the device and the hand: q, n, b, p or a plant file", 0},
    {"config", 'c', "C.ini", 0, "the configuration to begin from (default: the plant's own)", 0},
    {"transition", 't', "LAW", 0, "the transition law (default: the configuration's)", 0},
    {"out", 'o', "TUNED.ini", 0, "write the configuration with the chosen gains", 0},
    {"gain-margin", GAIN_MARGIN, "X", 0, "loops must be stable with gains X times as large (1.5)", 0},
    {"delay-margin", DELAY_MARGIN, "S", 0, "loops must be stable with torques S seconds later (0.0004)", 0},
    {"hands", HANDS, "LIST", 0, "hands in the ring, as shares of the plant's hand; 0: no hand (0,0.5,1,2)", 0},
    {"passive", PASSIVE, NULL, 0, "require a wall that is passive with the device's own friction", 0},
    {"prefer", PREFER, "tracking|brake|wall|calm", 0, "goal that counts twice in the choice", 0},
    {"range", RANGE, "KEY=LOW:HIGH", 0,
     "range of a section.key; KEY=VALUE holds it at a value; may be given more than once", 0},
    {"points", POINTS_OPTION, "N", 0, "points of the first round (384)", 0},
    {"taps", TAPS_OPTION, "N", 0, "taps of the last round at each speed; earlier rounds have fewer (160)", 0},
    {"seed", SEED, "S", 0, "seed of the taps (1)", 0},
    {"csv", CSV, "OUT.csv", 0, "write every point", 0},
    {"plot", PLOT, "OUT.png", 0, "draw the points of --csv (gnuplot)", 0},
    {0},
};

static ethd__tune_options arg = {
    .hands = {{0, 0.5, 1, 2}, 4}, .margin = {1.5, 0.4e-3}, .prefer = -1, .points = POINTS, .taps = TAPS, .seed = 1};

static void add_hand(const char *word, void *user) {
  ethd__tune_hands *hands = user;
  if (hands->count == sizeof hands->shares / sizeof *hands->shares)
    ethd__fail(ETHD_EXIT_INPUT, "--hands: at most %zu are allowed", hands->count);
  hands->shares[hands->count++] = ethd__option_number("--hands", word, 0, 100);
}

static int goal_of(const char *text) {
  char quote[ETHD_QUOTE_MAX];
  for (int g = 0; g < ETHD_TUNE_GOALS; g++)
    if (!strcmp(text, ethd__tune_goal_names[g])) return g;
  ethd__fail(ETHD_EXIT_INPUT, "--prefer: found %s; tracking, brake, wall and calm are allowed",
             ethd__quote(text, strlen(text), quote));
}

static void check_usage(struct argp_state *state) {
  if (!arg.plant && !arg.config) argp_error(state, "--plant is needed: a device's plant file, or q, n, b, p");
  if (arg.plot && !arg.csv) argp_error(state, "--plot needs --csv: it draws that file");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'p': arg.plant = text; return 0;
  case 'c': arg.config = text; return 0;
  case 't': arg.law = text; return 0;
  case 'o': arg.out = text; return 0;
  case GAIN_MARGIN: arg.margin.gain = ethd__option_number("--gain-margin", text, 1, 100); return 0;
  case DELAY_MARGIN: arg.margin.delay = ethd__option_number("--delay-margin", text, 0, 0.01); return 0;
  case HANDS:
    arg.hands.count = 0;
    ethd__option_list("--hands", text, add_hand, &arg.hands);
    return 0;
  case PASSIVE: arg.passive = true; return 0;
  case PREFER: arg.prefer = goal_of(text); return 0;
  case RANGE:
    if (arg.range_count == ETHD_TUNE_KEYS_MAX)
      ethd__fail(ETHD_EXIT_INPUT, "--range: at most %d are allowed", ETHD_TUNE_KEYS_MAX);
    arg.ranges[arg.range_count++] = text;
    return 0;
  case POINTS_OPTION: arg.points = ethd__option_integer("--points", text, 8, 100000); return 0;
  case TAPS_OPTION: arg.taps = ethd__option_integer("--taps", text, 20, 10000); return 0;
  case SEED: arg.seed = ethd__option_seed("--seed", text); return 0;
  case CSV: arg.csv = text; return 0;
  case PLOT: arg.plot = ethd__option_picture("--plot", text); return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  case ARGP_KEY_END: check_usage(state); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

void ethd__tune_options_read(int argc, char **argv, ethd__tune_options *out) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  *out = arg;
}
