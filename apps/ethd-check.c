/* Is a configuration valid, how was it understood, and do its gains stay within the stability bounds? */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check/report.h"
#include "check/stability.h"
#include "common/cli.h"
#include "ethd/sim.h"
#include "file/config_parts.h"
#include "file/text.h"

static const char doc[] =
    "Validates a configuration, prints the setup as it was understood, and names the stability bounds that "
    "its gains exceed.\v"
    "Bounds are those of the sampled loop: a free mass (arm.mass_x, arm.mass_y) under zero-order hold with "
    "the configured velocity estimator, one axis at a time, without friction. The exit code is 0 for every "
    "valid configuration, whether bounds are exceeded or not; 2 with one line for one that isn't.\n\n"
    "Example:\n"
    "  ethd-check device.ini\n"
    "  ethd-check --counts 39200 --delay 1 device.ini";

static const struct argp_option options[] = {
    {"counts", 'c', "N", 0, "encoder counts per joint turn (known for the simulated device)", 0},
    {"delay", 'd', "TICKS", 0, "whole ticks from measurement to torque, 0 by default", 0},
    {0},
};

static struct {
  const char *config, *counts, *delay;
} arg;

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
    case 'c': arg.counts = text; return 0;
    case 'd': arg.delay = text; return 0;
    case ARGP_KEY_ARG:
      if (arg.config) argp_error(state, "\"%s\": one configuration is checked", text);
      arg.config = text;
      return 0;
    case ARGP_KEY_NO_ARGS: argp_error(state, "which configuration?"); return 0;
    default: return ARGP_ERR_UNKNOWN;
  }
}

/* ---- the device ---- */

static const ethd_setting *setting(const ethd_config *config, const char *key) {
  for (uint32_t i = 0; i < config->setting_count; i++)
    if (strcmp(config->settings[i].key, key) == 0) return &config->settings[i];
  return NULL;
}

static void check_device(const ethd_config *config) {
  char message[ETHD_MESSAGE_MAX];
  ethd_error error;
  void *device;
  const ethd_device_def def = {&config->setup, config->settings, config->setting_count, config->folder};
  if (strcmp(config->device, ethd_driver_sim.id) != 0)
    ethd__fail(ETHD_EXIT_INPUT, "%s:%d: device.driver: found \"%s\", sim is allowed", arg.config,
               ethd_ini_find(&ethd__config_whole(config)->ini, "device", "driver")->line, config->device);
  ethd_status status = ethd_driver_sim.open(&def, &device, &error);
  if (status < 0) {
    ethd_error_text(arg.config, &error, message);
    ethd__fail(ethd__exit_code(status), "%s", message);
  }
  ethd_driver_sim.close(device);
}

/* The simulated device's plant: beside the configuration, else one that came with the programs. */
static double plant_count(const ethd_config *config) {
  char message[ETHD_MESSAGE_MAX], name[64];
  ethd_plant plant;
  const ethd_setting *own = setting(config, "plant");
  const char *value = own ? own->value : "n";
  bool named = !strpbrk(value, "/.");
  if (strlen(value) >= sizeof name - sizeof ".plant") return NAN;
  snprintf(name, sizeof name, "%s%s", value, named ? ".plant" : "");
  char *path = ethd__path_join(config->folder, name);
  if (path && named && access(path, R_OK) != 0) {
    free(path);
    path = ethd__data_path(name);
  }
  ethd_status status = path ? ethd_plant_load(path, &plant, message) : ETHD_E_MEMORY;
  free(path);
  return status ? NAN : plant.count;
}

/* ---- all of it ---- */

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "C.ini", doc, NULL, NULL, NULL};
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd_status status = ethd_config_load(arg.config, &config, message);
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
  check_device(config);
  ethd__bounds bounds = {.config = config, .count = NAN};
  if (arg.delay) bounds.delay = (int)ethd__option_integer("--delay", arg.delay, 0, ETHD_LOOP_DELAY_MAX);
  if (arg.counts)
    bounds.count = 2 * M_PI / ethd__option_number("--counts", arg.counts, 1, 1e12);
  else
    bounds.count = plant_count(config);
  printf("; %s is valid\n\n", arg.config);
  ethd__report_setup(config);
  printf("\n");
  int exceeded = ethd__report_bounds(&bounds);
  printf("%d bound%s exceeded\n", exceeded, exceeded == 1 ? "" : "s");
  ethd_config_free(config);
  return ethd__end(ETHD_EXIT_DONE);
}
