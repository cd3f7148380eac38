#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "encoder/counter.h"
#include "text/error_text.h"
#include "text/text.h"

const ethd_param ethd__counter_params[ETHD__COUNTER_PARAMS] = {
    [ETHD__COUNTER_COUNTS_PER_TURN] = {"counts_per_turn", "1", 1, 0x1p32, 4000, "of the encoder's shaft, whole"},
    [ETHD__COUNTER_RATIO] = {"ratio", "1", 1e-3, 1e4, 1, "turns of that shaft in one of the joint"},
    [ETHD__COUNTER_SIGN1] = {"sign1", "1", -1, 1, 1, "1, or -1: joint 1's counts rise while its angle falls"},
    [ETHD__COUNTER_SIGN2] = {"sign2", "1", -1, 1, 1, "the same of joint 2"},
    [ETHD__COUNTER_OFFSET1] = {"offset1", "rad", -10, 10, 0, "joint 1's angle at count 0, or at the home mark"},
    [ETHD__COUNTER_OFFSET2] = {"offset2", "rad", -10, 10, 0, "the same of joint 2"},
    [ETHD__COUNTER_WIDTH] = {"width", "1", 0, 64, 0,
                             "bits of a count whose ceiling the kernel doesn't say, whole; 0: it says"},
    [ETHD__COUNTER_HOME] = {"home", "no|yes", 0, 1, 0, "start waits for both index marks"},
    [ETHD__COUNTER_HOME_TIME] = {"home_time", "s", 0.001, 3600, 30, "for so long"},
    [ETHD__COUNTER_STAMPS] = {"stamps", "no|yes", 0, 1, 0, "speeds from the instants of the edges"},
    [ETHD__COUNTER_SPEED_MAX] = {"speed_max", "rad/s", 1e-3, 1e4, 30, "of a joint; what is faster is a jump"},
    [ETHD__COUNTER_FREEZE_TORQUE] = {"freeze_torque", "Nm", 1e-6, (double)INFINITY, 0.4,
                                     "a change of torque that moves a sound joint, four times its friction; inf: none"},
    [ETHD__COUNTER_FREEZE_TIME] = {"freeze_time", "s", 1e-3, 10, 0.045, "within so long"},
    [ETHD__COUNTER_REVERSE_TORQUE] = {"reverse_torque", "Nm", 1e-6, (double)INFINITY, (double)INFINITY,
                                      "against more a sound joint gains no speed by itself; inf: it may"},
    [ETHD__COUNTER_REVERSE_TIME] = {"reverse_time", "s", 1e-3, 10, 0.010, "it may for so long"},
    [ETHD__COUNTER_INERTIA] = {"inertia", "kg m^2", 1e-6, 1e3, 0.01, "of a joint, within a half"},
};

const char *const ethd__counter_keys[] = {"device", "device2",  "function", "count1",
                                          "count2", "channel1", "channel2", NULL};

static ethd_status refuse(const ethd_device_def *def, const ethd_setting *s, ethd_status status, double found,
                          double min, double max, char *message) {
  ethd_error error = {.status = status, .line = s->line, .found = found, .min = min, .max = max};
  strncpy(error.name, s->key, sizeof error.name - 1);
  ethd_error_text(def->file, &error, message);
  return status;
}

static ethd_status set_text(const ethd_device_def *def, const ethd_setting *s, char *out, char *message) {
  size_t n = strlen(s->value);
  if (n >= ETHD_COUNTER_TEXT_MAX) return refuse(def, s, ETHD_E_RANGE, (double)n, 1, ETHD_COUNTER_TEXT_MAX - 1, message);
  memcpy(out, s->value, n + 1);
  return ETHD_OK;
}

static ethd_status set_small(const ethd_device_def *def, const ethd_setting *s, uint8_t *out, char *message) {
  double v;
  if (!ethd__number(s->value, strlen(s->value), &v)) return refuse(def, s, ETHD_E_SYNTAX, NAN, NAN, NAN, message);
  if (!(v >= 0 && v <= 255) || v != rint(v)) return refuse(def, s, ETHD_E_RANGE, v, 0, 255, message);
  *out = (uint8_t)v;
  return ETHD_OK;
}

static bool is_whole(int i, double v) {
  if (i == ETHD__COUNTER_SIGN1 || i == ETHD__COUNTER_SIGN2) return fabs(v) == 1;
  return (i != ETHD__COUNTER_COUNTS_PER_TURN && i != ETHD__COUNTER_WIDTH) || v == rint(v);
}

static ethd_status set_number(const ethd_device_def *def, const ethd_setting *s, double *p, char *message) {
  int i = ethd_params_find(ethd__counter_params, ETHD__COUNTER_PARAMS, s->key);
  if (i < 0) return refuse(def, s, ETHD_E_UNKNOWN, NAN, NAN, NAN, message);
  const ethd_param *row = &ethd__counter_params[i];
  if (ethd_param_words(row)) {
    int word = ethd_param_word(row, s->value);
    if (word < 0) return refuse(def, s, ETHD_E_UNKNOWN, NAN, NAN, NAN, message);
    p[i] = word;
    return ETHD_OK;
  }
  double v;
  if (!ethd__number(s->value, strlen(s->value), &v)) return refuse(def, s, ETHD_E_SYNTAX, NAN, NAN, NAN, message);
  if (!(v >= row->min && v <= row->max) || !is_whole(i, v))
    return refuse(def, s, ETHD_E_RANGE, v, row->min, row->max, message);
  p[i] = v;
  return ETHD_OK;
}

static ethd_status set(const ethd_device_def *def, const ethd_setting *s, ethd__counter_settings *out, char *message) {
  if (!strcmp(s->key, "device")) return set_text(def, s, out->device[0], message);
  if (!strcmp(s->key, "device2")) return set_text(def, s, out->device[1], message);
  if (!strcmp(s->key, "function")) return set_text(def, s, out->function, message);
  if (!strcmp(s->key, "count1")) return set_small(def, s, &out->count[0], message);
  if (!strcmp(s->key, "count2")) return set_small(def, s, &out->count[1], message);
  if (!strcmp(s->key, "channel1")) return set_small(def, s, &out->channel[0], message);
  if (!strcmp(s->key, "channel2")) return set_small(def, s, &out->channel[1], message);
  return set_number(def, s, out->p, message);
}

ethd_status ethd__counter_settings_read(const ethd_device_def *def, ethd__counter_settings *out,
                                        char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  *out = (ethd__counter_settings){
      .device = {"/dev/counter0"}, .function = "quadrature x4", .count = {0, 1}, .channel = {0, 1}};
  ethd_params_default(ethd__counter_params, ETHD__COUNTER_PARAMS, out->p);
  for (uint32_t i = 0; i < def->setting_count && !status; i++) status = set(def, &def->settings[i], out, message);
  if (!out->device[1][0]) memcpy(out->device[1], out->device[0], sizeof out->device[1]);
  return status;
}
