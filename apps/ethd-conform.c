/* Tests a device's driver against its contract, and measures a drive's bus. */
#include <stdio.h>

#include "cli/cli.h"
#include "conform/probe.h"
#include "ethd/conform.h"

static const char doc[] =
    "Tests the driver of a configuration's device against its contract: opening and closing, zero torque, signs, "
    "counts, limits, the watchdog, the safe state.\v"
    "The device moves only with --move: each joint is pushed for 0.15 s, or longer on a bus with over 6 ms between "
    "samples; an arm with a section [space] goes 0.1 s along each axis, and with --virtual to the ends of its travel. "
    "Keep clear of it, with the emergency stop at hand. Ctrl-C, SIGTERM or SIGHUP makes the device safe and ends the "
    "test.\n\n"
    "--probe measures the bus to a servo drive instead, by the drive's register map: it connects, identifies the "
    "drive, writes zero torque and reads, as fast as the bus allows, and prints the rate that the bus holds. Only "
    "--try-watchdog enables the drive, at zero torque.\n\n"
    "Examples:\n"
    "  printf '[device]\\ndriver = hello\\n' >hello.ini\n"
    "  ethd-conform --config hello.ini --virtual --move\n"
    "  ethd-conform --config ur5e.ini --virtual --move\n"
    "  ethd-conform --probe svd48v.map --by-hand 20\n"
    "  ethd-conform --probe plant.map --port 127.0.0.1:1502 --duration 10\n"
    "A driver of your own: [device] driver = file:mine.so, or ethd_conform of ethd/conform.h in a program that links "
    "it. Without --config the simulated device is tested. Its ring moves even at zero torque, because the simulated "
    "finger pushes it.";

enum { OPTION_PROBE = 256, OPTION_PORT, OPTION_PERIOD, OPTION_DURATION, OPTION_WATCHDOG, OPTION_BY_HAND };

static const struct argp_option options[] = {
    {"config", 'c', "FILE", 0, "configuration whose [device] is tested (default: the simulated device)", 0},
    {"move", 'm', NULL, 0, "allow the device to move", 0},
    {"push", 'p', "N", 0, "how hard: a joint's torque, Nm, or an arm's speed, m/s, or force, N (0.1)", 0},
    {"virtual", 'v', NULL, 0, "count time instead of waiting: for a simulated device", 0},
    {"probe", OPTION_PROBE, "F.map", 0, "measure the bus to the drive of this register map", 1},
    {"port", OPTION_PORT, "PORT", 0, "HOST:PORT or a serial device, instead of the map's", 1},
    {"period", OPTION_PERIOD, "S", 0, "period of the loop that uses the bus, s (0.001)", 1},
    {"duration", OPTION_DURATION, "S", 0, "duration of the measurement, s (2)", 1},
    {"try-watchdog", OPTION_WATCHDOG, NULL, 0,
     "enable at zero torque, stop writing, and say whether the drive disables itself: keep clear of the arm", 1},
    {"by-hand", OPTION_BY_HAND, "S", 0,
     "then wait S seconds while you turn the joints by hand, and say which angle rose or fell", 1},
    {0},
};

static struct {
  const char *config;
  bool move, is_virtual;
  double push;
} arg = {.push = 0.1};
static ethd__probe_def probe = {.duration = 2, .period = 1e-3};
static bool of_driver, of_bus; /* an option of the one or of the other was given */

static error_t parse(int key, char *text, struct argp_state *state) {
  of_driver |= key == 'c' || key == 'm' || key == 'p' || key == 'v';
  of_bus |= key >= OPTION_PORT && key <= OPTION_BY_HAND;
  switch (key) {
  case 'c': arg.config = text; return 0;
  case 'm': arg.move = true; return 0;
  case 'p': arg.push = ethd__option_number("--push", text, 1e-6, 1e3); return 0;
  case 'v': arg.is_virtual = true; return 0;
  case OPTION_PROBE: probe.map = text; return 0;
  case OPTION_PORT: probe.port = text; return 0;
  case OPTION_PERIOD: probe.period = ethd__option_number("--period", text, 1e-5, 1); return 0;
  case OPTION_DURATION: probe.duration = ethd__option_number("--duration", text, 0.01, 86400); return 0;
  case OPTION_WATCHDOG: probe.watchdog = true; return 0;
  case OPTION_BY_HAND: probe.by_hand = ethd__option_number("--by-hand", text, 0.1, 3600); return 0;
  case ARGP_KEY_END:
    if (of_bus && !probe.map)
      argp_error(state, "--port, --period, --duration, --try-watchdog and --by-hand go with --probe");
    if (of_driver && probe.map) argp_error(state, "--config, --move, --push and --virtual don't go with --probe");
    return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* Returns the program's exit code. */
static int ask_driver(void) {
  static const char *const words[] = {"kept", "BROKEN", "at risk", "not asked"};
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd_conform_answer answers[ETHD_QUESTIONS];
  ethd__container_keeper();
  ethd__need(ethd_config_load(arg.config, &config, message), message);
  const ethd_device_def device = {.setup = config->is_space ? NULL : &config->setup,
                                  .settings = config->settings,
                                  .setting_count = config->setting_count,
                                  .folder = config->folder,
                                  .file = config->path,
                                  .is_virtual = arg.is_virtual,
                                  .space = config->is_space ? &config->space : NULL};
  (arg.is_virtual ? ethd__catch_end : ethd__hold_device)();
  const ethd_conform_def def = {config->device, NULL, &device, arg.move ? arg.push : 0, &ethd__stop};
  const int count = config->is_space ? ETHD_SPACE_QUESTIONS : ETHD_QUESTIONS;
  ethd_status status = (config->is_space ? ethd_conform_space : ethd_conform)(&def, answers);
  for (int i = 0; i < count; i++)
    printf("%-9s %-10s %s\n", answers[i].question, words[answers[i].verdict], answers[i].found);
  ethd__tell_refusal();
  if (status == ETHD_E_UNFINISHED)
    fprintf(stderr, "%s: stopped by a signal: the device is safe and closed, the rest isn't asked\n",
            program_invocation_short_name);
  else if (!arg.move)
    printf("with --move the device is pushed, and all is asked\n");
  ethd_config_free(config);
  return status ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  if (!probe.map) return ethd__end(ask_driver());
  ethd__probe(&probe);
  return ethd__end(ETHD_EXIT_DONE);
}
