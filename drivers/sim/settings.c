#include "sim/settings.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "sim/plant.h"
#include "text/text.h"

const ethd_param ethd__sim_params[ETHD__SIM_PARAMS] = {
    [ETHD__SIM_STEP] = {"step", "s", 1e-7, 1e-2, 1e-3, "longest integration step"},
    [ETHD__SIM_TOLERANCE] = {"tolerance", "m/s", 1e-14, 1, ETHD_SIM_GOLDEN, "of a step's last terms"},
    [ETHD__SIM_SEED] = {"seed", "1", 0, 0x1p53, 1, "key of every random number, whole"},
    [ETHD__SIM_TAP] = {"tap", "1", 0, 0x1p53, 0, "number of the tap that is drawn, whole"},
    [ETHD__SIM_SPEED] = {"speed", "m/s", 1e-3, 10, 0.4, "commanded speed of the finger"},
    [ETHD__SIM_MEET_X] = {"meet_x", "m", -10, 10, 0.25, "ring's centre where it meets the wall on its left"},
    [ETHD__SIM_MEET_Y] = {"meet_y", "m", -10, 10, 0.25, "likewise"},
};

const char *const ethd__sim_keys[] = {"plant", "reading", NULL};

static ethd_status refuse(ethd_error *error, ethd_status status, const ethd_setting *s, double found, double min,
                          double max) {
  ethd__sim_refuse(error, status, s->key, found, min, max);
  if (error) error->line = s->line;
  return status;
}

static bool is_whole(int i, double value) {
  return (i != ETHD__SIM_SEED && i != ETHD__SIM_TAP) || value == rint(value);
}

static ethd_status set_number(const ethd_setting *s, ethd__sim_settings *out, ethd_error *error) {
  int i = ethd_params_find(ethd__sim_params, ETHD__SIM_PARAMS, s->key);
  double value;
  if (i < 0) return refuse(error, ETHD_E_UNKNOWN, s, NAN, NAN, NAN);
  if (!ethd__number(s->value, strlen(s->value), &value)) return refuse(error, ETHD_E_SYNTAX, s, NAN, NAN, NAN);
  if (!(value >= ethd__sim_params[i].min && value <= ethd__sim_params[i].max) || !is_whole(i, value))
    return refuse(error, ETHD_E_RANGE, s, value, ethd__sim_params[i].min, ethd__sim_params[i].max);
  out->p[i] = value;
  return ETHD_OK;
}

static ethd_status set(const ethd_setting *s, ethd__sim_settings *out, ethd_error *error) {
  if (!strcmp(s->key, "plant")) {
    out->plant = s;
    return ETHD_OK;
  }
  if (strcmp(s->key, "reading")) return set_number(s, out, error);
  out->rays = !strcmp(s->value, "rays") ? 1 : !strcmp(s->value, "centre") ? 0 : -1;
  return out->rays < 0 ? refuse(error, ETHD_E_UNKNOWN, s, NAN, NAN, NAN) : ETHD_OK;
}

ethd_status ethd__sim_settings_read(const ethd_device_def *def, ethd__sim_settings *out, ethd_error *error) {
  ethd_status status = ETHD_OK;
  *out = (ethd__sim_settings){.rays = -1};
  ethd_params_default(ethd__sim_params, ETHD__SIM_PARAMS, out->p);
  for (uint32_t i = 0; i < def->setting_count && !status; i++) status = set(&def->settings[i], out, error);
  return status;
}
