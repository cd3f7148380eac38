/* Validates a configuration, prints the setup that it makes, and compares its gains with the stability bounds. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bounds/stability.h"
#include "check/laws.h"
#include "check/report.h"
#include "cli/cli.h"
#include "ethd/sim.h"
#include "scene/thin.h"
#include "settings/config_parts.h"
#include "sim/plant.h"

static const char doc[] =
    "Validates a configuration, prints the setup that it makes, and its distance from each bound: stability, "
    "passivity, rest at touch, quantisation, the tick's time. Each bound has its formula and says what to change.\v"
    "The device isn't opened: its drivers read their settings and files. A servo's map gives the time of an exchange "
    "on the wire, the divisor that the bus holds, unconfirmed registers, and faults that aren't noticed. --open reads "
    "the device too, and enables nothing. Figures come from the drivers and from [arm]; an option replaces them. If "
    "the delay is unknown, the worst case is assumed and printed: the longest spacing of samples that the limits "
    "allow, or with --open the longest one measured. Stability includes an elastic transmission but no friction, since "
    "friction stops only small oscillations. For a loop that is unstable without friction, two speeds are printed: up "
    "to "
    "the first, friction stops an oscillation; one encoder count moves the motors with the second. If the second is "
    "larger, the ring goes on chattering. A plugin's law that doesn't name its gains isn't judged; the last lines "
    "say so. For a configuration of space ([space]) it prints the setup, and the distance in which "
    "the device reacts before a wall.\n\n"
    "--laws and --drivers list the laws, methods and drivers that a configuration can name, with each parameter's "
    "unit, range and default. The first law or method of each kind is the default; for transitions it is offset.\n\n"
    "The exit code is 0 for a valid configuration, whether bounds are exceeded or not, and 2, with one line, for an "
    "invalid one.\n\n"
    "Example:\n"
    "  ethd-check device.ini\n"
    "  ethd-check --open device.ini\n"
    "  ethd-check --counts 39200 --delay 1 --force-limit 5.4 device.ini\n"
    "  ethd-check --laws --plugin mylaw.so --csv laws.csv\n"
    "  ethd-check --driver mydriver.so";

enum { OPTION_LAWS = 256, OPTION_PLUGIN, OPTION_DRIVERS, OPTION_DRIVER, OPTION_CSV };

static const struct argp_option options[] = {
    {"counts", 'c', "N", 0, "encoder counts in a turn of the joint", 0},
    {"delay", 'd', "TICKS", 0, "delay from measurement to torque, in ticks, 0 to 20; fractions are allowed", 0},
    {"force-limit", 'f', "N", 0, "largest force at the ring, N: torque limit of a joint / its link", 0},
    {"friction", 'r', "N", 0, "Coulomb friction at the ring, N", 0},
    {"viscous", 'b', "NSPM", 0, "viscous friction at the ring, Ns/m", 0},
    {"latency", 'l', "S", 0, "age of the finger's readings when they arrive, s", 0},
    {"open", 'o', NULL, 0, "open the device too, enabling nothing: ports, the drive's identity, the empty ring", 0},
    {"laws", OPTION_LAWS, NULL, 0, "list the built-in laws and methods", 1},
    {"plugin", OPTION_PLUGIN, "FILE", 0, "with --laws: list this plugin's laws too; may be given more than once", 1},
    {"drivers", OPTION_DRIVERS, NULL, 0, "list the built-in drivers", 1},
    {"driver", OPTION_DRIVER, "FILE", 0, "list this file's driver, checked as [device] driver = file:FILE checks it",
     1},
    {"csv", OPTION_CSV, "FILE", 0, "write a row for each listed parameter", 1},
    {0},
};

static struct {
  const char *config, *counts, *delay, *force, *friction, *viscous, *latency;
  bool open;
} arg;
static ethd__listing list;

static void add_plugin(const char *file, struct argp_state *state) {
  if (list.plugin_count == PLUGINS_MAX) argp_error(state, "over %d plugins", PLUGINS_MAX);
  list.plugins[list.plugin_count++] = file;
}

static bool lists(void) { return list.laws || list.drivers || list.driver; }

static void end(struct argp_state *state) {
  if (list.plugin_count && !list.laws) argp_error(state, "--plugin goes with --laws");
  if (list.csv && !lists()) argp_error(state, "--csv goes with --laws, --drivers and --driver");
  if (!arg.config && !lists()) argp_error(state, "which configuration?");
  if (arg.config && lists()) argp_error(state, "\"%s\": a list needs no configuration", arg.config);
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case 'c': arg.counts = text; return 0;
  case 'd': arg.delay = text; return 0;
  case 'f': arg.force = text; return 0;
  case 'r': arg.friction = text; return 0;
  case 'b': arg.viscous = text; return 0;
  case 'l': arg.latency = text; return 0;
  case 'o': arg.open = true; return 0;
  case OPTION_LAWS: list.laws = true; return 0;
  case OPTION_PLUGIN: add_plugin(text, state); return 0;
  case OPTION_DRIVERS: list.drivers = true; return 0;
  case OPTION_DRIVER: list.driver = text; return 0;
  case OPTION_CSV: list.csv = text; return 0;
  case ARGP_KEY_ARG:
    if (arg.config) argp_error(state, "\"%s\": one configuration is checked", text);
    arg.config = text;
    return 0;
  case ARGP_KEY_END: end(state); return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* ---- the device ---- */

static const ethd_setting *setting(const ethd_config *config, const char *key) {
  for (uint32_t i = 0; i < config->setting_count; i++)
    if (strcmp(config->settings[i].key, key) == 0) return &config->settings[i];
  return NULL;
}

static ethd_device *reach_device(const ethd_config *config) {
  char message[ETHD_MESSAGE_MAX];
  ethd_device *d;
  const ethd_device_def def = {.setup = config->is_space ? NULL : &config->setup,
                               .settings = config->settings,
                               .setting_count = config->setting_count,
                               .folder = config->folder,
                               .file = arg.config,
                               .space = config->is_space ? &config->space : NULL};
  ethd__need(arg.open ? ethd_device_open(config->device, NULL, &def, &d, message)
                      : ethd_device_prepare(config->device, &def, &d, message),
             message);
  return d;
}

/* From now on the setup is the one that the loop would run: the device narrows its limits, and adds what moves it. */
static void take_over(const ethd_device *d, ethd_setup *setup) {
  ethd_limits limits = ethd_device_limits(d);
  ethd_dynamics dynamics = ethd_device_dynamics(d);
  setup->limits = ethd_limits_narrower(&limits, &setup->limits);
  setup->dynamics = ethd_dynamics_known(&dynamics, &setup->dynamics);
}

/* Returns the largest of the figures of this name. */
static double named(const ethd_device *d, const char *name) {
  static ethd_figure all[ETHD_FIGURES_MAX];
  double most = NAN;
  for (uint32_t i = 0, n = ethd_device_figures(d, all, ETHD_FIGURES_MAX); i < n; i++)
    if (strstr(all[i].name, name)) most = fmax(most, all[i].value);
  return most;
}

static void from_drivers(const ethd_device *d, const ethd_setup *setup, ethd__figures *f) {
  const ethd_dynamics *known = &setup->dynamics;
  f->loop.friction = known->friction;
  f->loop.viscous = known->viscous;
  f->loop.delay = isnan(known->delay) ? named(d, "delay from measurement to torque") : known->delay;
  f->loop.count = named(d, "joint angle a count");
  f->latency = named(d, "reading age");
}

/* The driver has read the plant already, so that it can be read. */
static void from_plant(const ethd_config *config, ethd__figures *f) {
  char message[ETHD_MESSAGE_MAX];
  ethd_plant p;
  const ethd_setting *own = setting(config, "plant");
  ETHD__FREED char *path = ethd__plant_path(own ? own->value : ETHD__PLANT, config->folder);
  ethd_status status = path ? ethd_plant_load(path, &p, message) : ETHD_E_MEMORY;
  if (status) return;
  for (int i = 0; i < 2; i++) f->force[i] = p.force_limit;
  f->loop = ethd__bounds_device_of(&p, 0);
  f->latency = p.latency;
}

static void option(const char *name, const char *text, double max, double *out) {
  if (text) *out = ethd__option_number(name, text, 0, max);
}

/* `asked` is the torque that the configuration allows, Nm, whatever its device does. */
static ethd__figures figures(const ethd_config *config, const ethd_device *d, double asked) {
  const ethd_setup *setup = &config->setup;
  ethd__figures f = {.loop = {.mass = {NAN, NAN}, .delay = NAN, .friction = NAN, .viscous = NAN, .count = NAN},
                     .force = {NAN, NAN},
                     .latency = NAN};
  double links[2] = {setup->arm.link1, setup->arm.link2}, ticks = NAN;
  from_drivers(d, setup, &f);
  if (strcmp(config->device, ethd_driver_sim.id) == 0) from_plant(config, &f);
  option("--friction", arg.friction, 1e6, &f.loop.friction);
  option("--viscous", arg.viscous, 1e6, &f.loop.viscous);
  option("--latency", arg.latency, 1, &f.latency);
  option("--delay", arg.delay, ETHD_LOOP_DELAY_MAX, &ticks);
  if (arg.delay) f.loop.delay = ticks * setup->period;
  if (arg.counts) f.loop.count = 2 * M_PI / ethd__option_number("--counts", arg.counts, 1, 1e12);
  for (int i = 0; i < 2; i++) {
    double most = arg.force ? asked : setup->limits.torque; /* the option replaces the device's */
    option("--force-limit", arg.force, 1e6, &f.force[i]);
    if (isfinite(most)) f.force[i] = fmin(f.force[i], most / links[i]); /* NaN: no other */
  }
  if (!isnan(config->setup.dynamics.mass[0])) f.loop.mass[0] = config->setup.dynamics.mass[0];
  if (!isnan(config->setup.dynamics.mass[1])) f.loop.mass[1] = config->setup.dynamics.mass[1];
  return f;
}

/* ---- all of it ---- */

static void end_of_page(int exceeded) { printf("\n%d bound%s exceeded\n", exceeded, exceeded == 1 ? "" : "s"); }

/* A configuration of space without a device says of it what the bounds need. */
static void check_space(ethd_config *config) {
  const bool has_device = strcmp(config->device, ethd_driver_sim.id) != 0;
  if ((arg.open && !has_device) || arg.counts || arg.delay || arg.force || arg.friction || arg.viscous || arg.latency)
    ethd__fail(ETHD_EXIT_INPUT, "%s: [space] is there; the figures are for the plane, [ability] is for space",
               arg.config);
  ethd_device *device = has_device ? reach_device(config) : NULL;
  printf("; %s is valid\n\n", arg.config);
  ethd__report_setup(config);
  printf("\n");
  if (device) {
    const ethd_limits limits = ethd_device_limits(device);
    ethd_space_narrow(&config->space, &limits);
    ethd__report_drivers(config, device, arg.open);
  }
  end_of_page(ethd__report_space(&config->space, device));
  ethd_device_close(device);
  ethd_config_free(config);
}

static void check(void) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd__container_keeper(); /* what is said of the guardian holds for ethd-run */
  ethd__need(ethd_config_load(arg.config, &config, message), message);
  if (config->is_space) {
    check_space(config);
    return;
  }
  ethd_device *device = reach_device(config);
  printf("; %s is valid\n\n", arg.config);
  ethd__report_setup(config);
  double asked = config->setup.limits.torque;
  take_over(device, &config->setup);
  ethd__subject subject = {.config = config, .device = figures(config, device, asked)};
  printf("\n");
  ethd__report_drivers(config, device, arg.open);
  if (isnan(subject.device.loop.delay)) ethd__find_delay(&config->setup, device, arg.open, &subject.device);
  ethd__report_device(&subject);
  int exceeded = ethd__report_stability(&config->setup, &subject.device.loop);
  exceeded += ethd__report_passivity(&subject);
  exceeded += ethd__report_stop(&subject);
  exceeded += ethd__report_guard(&config->setup, &subject.device.loop);
  exceeded += ethd__report_threshold(&subject);
  exceeded += ethd__report_tick(&subject);
  if (config->setup.scene) ethd__scene_say_thin(config->setup.scene, "\nscene        ");
  end_of_page(exceeded);
  ethd__report_unjudged(&config->setup);
  ethd_device_close(device);
  ethd_config_free(config);
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "C.ini", doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  if (lists())
    ethd__list(&list);
  else
    check();
  return ethd__end(ETHD_EXIT_DONE);
}
