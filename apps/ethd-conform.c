/* Does the driver of a device keep its contract? */
#include <stdio.h>

#include "cli/cli.h"
#include "ethd/conform.h"

static const char doc[] =
    "Puts the driver of a configuration's device to the test at its own boundary: opening and closing, zero torque, "
    "signs, counts, limits, the watchdog, the safe state.\v"
    "Only with --move does the device move: each joint is pushed, for 0.15 s at most. Keep clear of it, with the "
    "emergency stop at hand. Ctrl-C, SIGTERM or SIGHUP makes the device safe and ends the questions.\n\n"
    "Example:\n"
    "  printf '[device]\\ndriver = hello\\n' >hello.ini\n"
    "  ethd-conform --config hello.ini --virtual --move\n"
    "A driver of your own: [device] driver = file:mine.so, or ethd_conform of ethd/conform.h in a program that links "
    "it. "
    "Without --config the simulated device is asked; there the ring moves at zero torque, because its finger pushes "
    "it.";

static const struct argp_option options[] = {
    {"config", 'c', "FILE", 0, "configuration whose [device] is asked", 0},
    {"move", 'm', NULL, 0, "the device may move", 0},
    {"torque", 't', "NM", 0, "torque of the push (0.1)", 0},
    {"virtual", 'v', NULL, 0, "count time instead of waiting: for a simulated device", 0},
    {0},
};

static struct {
  const char *config;
  bool move, is_virtual;
  double torque;
} arg = {.torque = 0.1};

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'c': arg.config = text; return 0;
  case 'm': arg.move = true; return 0;
  case 't': arg.torque = ethd__option_number("--torque", text, 1e-6, 1e3); return 0;
  case 'v': arg.is_virtual = true; return 0;
  case ARGP_KEY_ARG: argp_error(state, "\"%s\": no such argument", text); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

int main(int argc, char **argv) {
  static const char *const words[] = {"kept", "BROKEN", "at risk", "not asked"};
  static const struct argp argp = {options, parse, NULL, doc, NULL, NULL, NULL};
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd_conform_answer answers[ETHD_QUESTIONS];
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__container_keeper();
  ethd_status status = ethd_config_load(arg.config, &config, message);
  if (status) ethd__fail(ethd__exit_code(status), "%s", message);
  const ethd_device_def device = {&config->setup, config->settings, config->setting_count,
                                  config->folder, config->path,     arg.is_virtual};
  (arg.is_virtual ? ethd__catch_end : ethd__hold_device)();
  const ethd_conform_def def = {config->device, NULL, &device, arg.move ? arg.torque : 0, &ethd__stop};
  status = ethd_conform(&def, answers);
  for (int i = 0; i < ETHD_QUESTIONS; i++)
    printf("%-9s %-10s %s\n", answers[i].question, words[answers[i].verdict], answers[i].found);
  ethd__tell_refusal();
  if (status == ETHD_E_UNFINISHED)
    fprintf(stderr, "%s: stopped by a signal: the device is safe and closed, the rest isn't asked\n",
            program_invocation_short_name);
  else if (!arg.move)
    printf("with --move the device is pushed, and all is asked\n");
  ethd_config_free(config);
  return ethd__end(status ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE);
}
