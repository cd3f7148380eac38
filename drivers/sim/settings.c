#include "sim/settings.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "finger/zones.h"
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
    [ETHD__SIM_FINGER] = {"finger", "centre|rays|zones|nail|camera", 0, ETHD_READING_COUNT - 1, 0,
                          "what measures the finger; not given: as the plant says"},
    [ETHD__SIM_RATE] = {"finger_rate", "Hz", 1, 1e5, 300, "readings; not given: the sensor's own"},
    [ETHD__SIM_LATENCY] = {"finger_latency", "s", 0, 1, 0, "likewise, from a sample to its delivery"},
    [ETHD__SIM_NOISE] = {"finger_noise", "m", 0, 0.1, 0, "likewise: of a centre, a barrier's reach, a distance; sd"},
    [ETHD__SIM_ZONES] = {"zones", "1", ETHD__ZONES_MIN, ETHD__ZONES_MAX, 12, "light barriers, whole"},
    [ETHD__SIM_REACH] = {"zone_reach", "m", 1e-4, 0.1, 3.5e-3, "a barrier is lit while the finger is nearer"},
    [ETHD__SIM_ANGLE] = {"nail_angle", "rad", -7, 7, 0, "toward the sensor that sees the nail's plate"},
};

const char *const ethd__sim_keys[] = {"plant", "reading", "empty", NULL};

static ethd_status refuse(ethd_error *error, ethd_status status, const ethd_setting *s, double found, double min,
                          double max) {
  ethd__sim_refuse(error, status, s->key, found, min, max);
  if (error) error->line = s->line;
  return status;
}

static bool is_whole(int i, double value) {
  return (i != ETHD__SIM_SEED && i != ETHD__SIM_TAP && i != ETHD__SIM_ZONES) || value == rint(value);
}

/* Reads which of the first `count` sensors is meant. */
static ethd_status set_reading(const ethd_setting *s, int32_t count, ethd__sim_settings *out, ethd_error *error) {
  out->reading = ethd_param_word(&ethd__sim_params[ETHD__SIM_FINGER], s->value);
  return out->reading >= 0 && out->reading < count ? ETHD_OK : refuse(error, ETHD_E_UNKNOWN, s, NAN, NAN, NAN);
}

static ethd_status set_number(const ethd_setting *s, ethd__sim_settings *out, ethd_error *error) {
  int i = ethd_params_find(ethd__sim_params, ETHD__SIM_PARAMS, s->key);
  double value;
  if (i < 0) return refuse(error, ETHD_E_UNKNOWN, s, NAN, NAN, NAN);
  if (i == ETHD__SIM_FINGER) return set_reading(s, ETHD_READING_COUNT, out, error);
  if (!ethd__number(s->value, strlen(s->value), &value)) return refuse(error, ETHD_E_SYNTAX, s, NAN, NAN, NAN);
  if (!ethd__is_within(value, ethd__sim_params[i].min, ethd__sim_params[i].max) || !is_whole(i, value))
    return refuse(error, ETHD_E_RANGE, s, value, ethd__sim_params[i].min, ethd__sim_params[i].max);
  out->p[i] = value;
  out->given |= UINT32_C(1) << i;
  return ETHD_OK;
}

static ethd_status set(const ethd_setting *s, ethd__sim_settings *out, ethd_error *error) {
  if (!strcmp(s->key, "plant")) {
    out->plant = s;
    return ETHD_OK;
  }
  if (!strcmp(s->key, "empty")) {
    out->no_finger = !strcmp(s->value, "yes");
    if (out->no_finger || !strcmp(s->value, "no")) return ETHD_OK;
    return refuse(error, ETHD_E_UNKNOWN, s, NAN, NAN, NAN);
  }
  if (strcmp(s->key, "reading")) return set_number(s, out, error);
  return set_reading(s, ETHD_READING_RAYS + 1, out, error);
}

ethd_status ethd__sim_settings_read(const ethd_device_def *def, ethd__sim_settings *out, ethd_error *error) {
  ethd_status status = ETHD_OK;
  *out = (ethd__sim_settings){.reading = -1};
  ethd_params_default(ethd__sim_params, ETHD__SIM_PARAMS, out->p);
  for (uint32_t i = 0; i < def->setting_count && !status; i++) status = set(&def->settings[i], out, error);
  return status;
}

void ethd__sim_settings_finger(const ethd__sim_settings *s, ethd_plant *plant) {
  double zones;
  const struct {
    int key;
    double *to;
  } numbers[] = {{ETHD__SIM_RATE, &plant->rate},        {ETHD__SIM_LATENCY, &plant->latency},
                 {ETHD__SIM_NOISE, &plant->noise},      {ETHD__SIM_ZONES, &zones},
                 {ETHD__SIM_REACH, &plant->zone_reach}, {ETHD__SIM_ANGLE, &plant->nail_angle}};
  if (s->reading >= 0) ethd_plant_finger(plant, s->reading);
  zones = plant->zones;
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (s->given >> numbers[i].key & 1) *numbers[i].to = s->p[numbers[i].key];
  plant->zones = (int32_t)zones;
}
