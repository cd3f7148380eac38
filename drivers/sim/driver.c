#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/driver.h"
#include "ethd/sim.h"
#include "file/text.h"
#include "sim/plant.h"

typedef struct device {
  ethd_sim *sim;
  ethd_sim_def def;
  ethd_sim_tap tap;
  int32_t safe;
} device;

/* ---- settings ---- */

enum { STEP, SEED, TAP, SPEED, MEET_X, MEET_Y, PARAMS };

static const ethd_param params[PARAMS] = {
    [STEP] = {"step", "s", 1e-7, 1e-2, 50e-6, "longest integration step"},
    [SEED] = {"seed", "1", 0, 0x1p53, 1, "key of every random number, whole"},
    [TAP] = {"tap", "1", 0, 0x1p53, 0, "number of the tap that is drawn, whole"},
    [SPEED] = {"speed", "m/s", 1e-3, 10, 0.4, "commanded speed of the finger"},
    [MEET_X] = {"meet_x", "m", -10, 10, 0.25, "ring's centre where it meets the wall on its left"},
    [MEET_Y] = {"meet_y", "m", -10, 10, 0.25, "likewise"},
};

typedef struct settings {
  double p[PARAMS];
  const ethd_setting *plant; /* NULL: n */
  int rays;                  /* -1: as the plant says */
} settings;

static ethd_status refuse(ethd_error *error, ethd_status status, const ethd_setting *s, double found, double min,
                          double max) {
  ethd__sim_refuse(error, status, s->key, found, min, max);
  if (error) error->line = s->line;
  return status;
}

static int is_whole(int i, double value) { return (i != SEED && i != TAP) || value == rint(value); }

static ethd_status set_number(const ethd_setting *s, settings *out, ethd_error *error) {
  int i = ethd_params_find(params, PARAMS, s->key);
  double value;
  if (i < 0) return refuse(error, ETHD_E_UNKNOWN, s, NAN, NAN, NAN);
  if (!ethd__number(s->value, strlen(s->value), &value)) return refuse(error, ETHD_E_SYNTAX, s, NAN, NAN, NAN);
  if (!(value >= params[i].min && value <= params[i].max) || !is_whole(i, value))
    return refuse(error, ETHD_E_RANGE, s, value, params[i].min, params[i].max);
  out->p[i] = value;
  return ETHD_OK;
}

static ethd_status set(const ethd_setting *s, settings *out, ethd_error *error) {
  if (!strcmp(s->key, "plant")) {
    out->plant = s;
    return ETHD_OK;
  }
  if (strcmp(s->key, "reading")) return set_number(s, out, error);
  out->rays = !strcmp(s->value, "rays") ? 1 : !strcmp(s->value, "centre") ? 0 : -1;
  return out->rays < 0 ? refuse(error, ETHD_E_UNKNOWN, s, NAN, NAN, NAN) : ETHD_OK;
}

static ethd_status read_settings(const ethd_device_def *def, settings *out, ethd_error *error) {
  ethd_status status = ETHD_OK;
  *out = (settings){.rays = -1};
  ethd_params_default(params, PARAMS, out->p);
  for (uint32_t i = 0; i < def->setting_count && !status; i++) status = set(&def->settings[i], out, error);
  return status;
}

/* ---- the plant's file ---- */

/* A short name is a file beside the configuration, else among the program's own. */
static void plant_path(const char *plant, const char *folder, char out[PATH_MAX]) {
  int named = !strchr(plant, '/') && !strchr(plant, '.');
  char *joined = ethd__path_join(folder, plant);
  snprintf(out, PATH_MAX, "%s%s", joined ? joined : plant, named ? ".plant" : "");
  free(joined);
  if (!named || access(out, R_OK) == 0) return;
  char program[PATH_MAX];
  ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  if (length < 0) return;
  program[length] = 0;
  for (int i = 0; i < 2 && strrchr(program, '/'); i++) *strrchr(program, '/') = 0;
  char shared[2 * PATH_MAX];
  snprintf(shared, sizeof shared, "%s/share/ethd/%s.plant", program, plant);
  if (strlen(shared) < PATH_MAX && access(shared, R_OK) == 0) strcpy(out, shared);
}

static ethd_status load_plant(const ethd_device_def *def, const settings *s, ethd_plant *out,
                              ethd_error *error) {
  char path[PATH_MAX], message[ETHD_MESSAGE_MAX];
  plant_path(s->plant ? s->plant->value : "n", def->folder, path);
  ethd_status status = ethd_plant_load(path, out, message);
  if (!status) return ETHD_OK;
  ethd__sim_refuse(error, status, message, NAN, NAN, NAN);
  if (error && s->plant) error->line = s->plant->line;
  return status;
}

/* ---- the driver ---- */

static ethd_status start(void *device);
static void close_device(void *device);

static ethd_status sim_open(const ethd_device_def *def, void **out, ethd_error *error) {
  settings s;
  *out = NULL;
  ethd_status status = read_settings(def, &s, error);
  if (status) return status;
  device *d = calloc(1, sizeof *d);
  if (!d) return ethd__sim_refuse(error, ETHD_E_MEMORY, "sim", NAN, NAN, NAN);
  d->def = (ethd_sim_def){.arm = def->setup->arm,
                          .ring_radius = def->setup->ring_radius,
                          .period = def->setup->period,
                          .step = s.p[STEP]};
  status = load_plant(def, &s, &d->def.plant, error);
  if (!status && s.rays >= 0) d->def.plant.rays = s.rays;
  if (!status) status = ethd_sim_create(&d->def, &d->sim, error);
  if (!status) {
    ethd_vec meet = {s.p[MEET_X], s.p[MEET_Y]};
    ethd_sim_draw(&d->def.plant, (uint64_t)s.p[SEED], (uint64_t)s.p[TAP], s.p[SPEED], meet, &d->tap);
    status = ethd_sim_start(d->sim, &d->tap);
    if (status) ethd__sim_refuse(error, status, "sim", NAN, NAN, NAN);
  }
  if (status)
    close_device(d);
  else
    *out = d;
  return status;
}

/* The tap from its beginning. */
static ethd_status start(void *device_) {
  device *d = device_;
  d->safe = 0;
  return ethd_sim_start(d->sim, &d->tap);
}

static ethd_status sim_read(void *device_, int64_t now_ns, ethd_sense *out) ETHD_RT {
  device *d = device_;
  (void)now_ns;
  ethd_sim_read(d->sim, out);
  return ETHD_OK;
}

/* In lock-step: a period passes. */
static ethd_status sim_write(void *device_, int64_t now_ns, const ethd_command *command) ETHD_RT {
  device *d = device_;
  ethd_command held = *command;
  (void)now_ns;
  if (d->safe) held.safe = 1;
  ethd_sim_write(d->sim, &held);
  return ETHD_OK;
}

static void safe(void *device_) ETHD_RT { ((device *)device_)->safe = 1; }

static ethd_status stop(void *device_) {
  safe(device_);
  return ETHD_OK;
}

static void close_device(void *device_) {
  device *d = device_;
  if (!d) return;
  ethd_sim_destroy(d->sim);
  free(d);
}

static ethd_limits limits(const void *device_) {
  const device *d = device_;
  ethd_limits limits = ethd_limits_none();
  limits.torque = d->def.plant.force_limit * fmin(d->def.arm.link1, d->def.arm.link2);
  return limits;
}

const ethd_driver ethd_driver_sim = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "sim",
    .brief = "simulated device: plausible, fitted to the paper's Table 1, not measured",
    .params = params,
    .param_count = PARAMS,
    .open = sim_open,
    .start = start,
    .read = sim_read,
    .write = sim_write,
    .service = NULL,
    .safe = safe,
    .stop = stop,
    .close = close_device,
    .limits = limits,
};
