#include <math.h>

#include "tap/options.h"

enum { OPTION_DELAY = 512, OPTION_GAP, OPTION_WALL, OPTION_BIAS, OPTION_RATE, OPTION_PLOT, OPTION_PLUGIN };

static const struct argp_option options[] = {
    {"arm", 'a', "TABLE", 0, "tap with a simulated arm in space: ur5e, fr3, iiwa7, planar or a file", 0},
    {"delay", OPTION_DELAY, "S", 0, "the arm's delay, s (default: the table's)", 0},
    {"gap", OPTION_GAP, "M", 0, "distance of the finger from the plate before it, m (0.06)", 0},
    {"wall", OPTION_WALL, "NX,NY,NZ,C", 0,
     "the wall: all points P with n.P > C, m, in the arm's frame (default: 0.12 m before the posture's plate, which "
     "faces "
     "it)",
     0},
    {"bias", OPTION_BIAS, "M", 0, "distance by which the headset sees the finger too near to the wall, m (0)", 0},
    {"rate", OPTION_RATE, "HZ", 0, "readings of the headset a second (72)", 0},
    {"plot", OPTION_PLOT, "FILE.png", 0,
     "draw early touches and felt offset against delay, gap and bias, in one to two minutes; FILE.csv has the numbers",
     0},
    {"plugin", OPTION_PLUGIN, "FILE.so", 0, "a plugin with laws of your own, for --transition", 0},
    {0},
};

typedef struct wall {
  double *number;
  int count;
} wall;

static void add_number(const char *word, void *user) {
  wall *to = user;
  const double number = ethd__option_number("--wall", word, -100, 100);
  if (to->count < 4) to->number[to->count] = number;
  to->count++;
}

static void set_wall(const char *text, double number[4]) {
  wall to = {number, 0};
  ethd__option_list("--wall", text, add_number, &to);
  if (to.count != 4 || !(hypot(hypot(number[0], number[1]), number[2]) > 1e-3))
    ethd__fail(ETHD_EXIT_INPUT, "--wall: a normal NX,NY,NZ that isn't 0 and a distance C are needed");
}

static void check(const struct argp_state *state, const ethd__tap_options *arg, bool any) {
  if (any && !arg->arm) argp_error(state, "--delay, --gap, --wall, --bias, --rate, --plot and --plugin need --arm");
  if (arg->arm && (arg->config || arg->plant || arg->record || arg->paper || arg->validity || arg->learn))
    argp_error(state, "--arm goes without --config, --plant, --record, --paper, --validity and --learn");
}

static error_t parse(int key, char *text, struct argp_state *state) {
  static bool any; /* except --arm itself */
  ethd__tap_options *arg = state->input;
  any |= key >= OPTION_DELAY && key <= OPTION_PLUGIN;
  switch (key) {
  case 'a': arg->arm = text; return 0;
  case OPTION_DELAY: arg->delay = ethd__option_number("--delay", text, 0, 0.1); return 0;
  case OPTION_GAP: arg->gap = ethd__option_number("--gap", text, 0.001, 0.5); return 0;
  case OPTION_WALL: set_wall(text, arg->wall); return 0;
  case OPTION_BIAS: arg->bias = ethd__option_number("--bias", text, -0.1, 0.1); return 0;
  case OPTION_RATE: arg->rate = ethd__option_number("--rate", text, 1, 1000); return 0;
  case OPTION_PLUGIN: arg->plugin = text; return 0;
  case OPTION_PLOT: arg->plot = ethd__option_picture("--plot", text); return 0;
  case ARGP_KEY_END: check(state, arg, any); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

const struct argp ethd__reach_argp = {options, parse, NULL, NULL, NULL, NULL, NULL};
