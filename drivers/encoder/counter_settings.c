#include <string.h>

#include "device/settings.h"
#include "encoder/counter.h"

const ethd_param ethd__counter_params[ETHD__COUNTER_PARAMS] = {
    [ETHD__COUNTER_COUNTS_PER_TURN] = {"counts_per_turn", ETHD_WHOLE, 1, 0x1p32, 4000,
                                       "counts per turn of the encoder's shaft"},
    [ETHD__COUNTER_RATIO] = {"ratio", "1", 1e-3, 1e4, 1, "turns of the encoder's shaft per turn of the joint"},
    [ETHD__COUNTER_SIGN1] = {"sign1", "1|-1", 0, 1, 0, "-1: joint 1's counts rise while its angle falls"},
    [ETHD__COUNTER_SIGN2] = {"sign2", "1|-1", 0, 1, 0, "-1: joint 2's counts rise while its angle falls"},
    [ETHD__COUNTER_OFFSET1] = {"offset1", "rad", -10, 10, 0, "joint 1's angle at count 0, or at the home mark"},
    [ETHD__COUNTER_OFFSET2] = {"offset2", "rad", -10, 10, 0, "joint 2's angle at count 0, or at the home mark"},
    [ETHD__COUNTER_WIDTH] = {"width", ETHD_WHOLE, 0, 64, 0,
                             "bits of a counter whose ceiling the kernel doesn't give; 0: the kernel gives it"},
    [ETHD__COUNTER_HOME] = {"home", "no|yes", 0, 1, 0, "yes: the start waits for both index marks"},
    [ETHD__COUNTER_HOME_TIME] = {"home_time", "s", 0.001, 3600, 30, "longest wait for the index marks"},
    [ETHD__COUNTER_STAMPS] = {"stamps", "no|yes", 0, 1, 0, "yes: speeds are calculated from the times of the edges"},
    [ETHD__COUNTER_SPEED_MAX] = {"speed_max", "rad/s", 1e-3, 1e4, 30,
                                 "highest speed of a joint; a faster change of angle is a jump"},
    [ETHD__COUNTER_FREEZE_TORQUE] = {"freeze_torque", "Nm", 1e-6, (double)INFINITY, 0.4,
                                     "change of torque that must move a joint: four times its friction; inf: no check"},
    [ETHD__COUNTER_FREEZE_TIME] = {"freeze_time", "s", 1e-3, 10, 0.045,
                                   "longest time until that change moves the joint"},
    [ETHD__COUNTER_REVERSE_TORQUE] = {"reverse_torque", "Nm", 1e-6, (double)INFINITY, (double)INFINITY,
                                      "opposing torque against which a joint can't gain speed; inf: no check"},
    [ETHD__COUNTER_REVERSE_TIME] = {"reverse_time", "s", 1e-3, 10, 0.010,
                                    "time for which a joint may gain speed against that torque"},
    [ETHD__COUNTER_INERTIA] = {"inertia", "kg m^2", 1e-6, 1e3, 0.01, "inertia of a joint, known to a half"},
};

enum { DEVICE, DEVICE2, FUNCTION, COUNT1, COUNT2, CHANNEL1, CHANNEL2, KEYS };

const char *const ethd__counter_keys[] = {"device", "device2",  "function", "count1",
                                          "count2", "channel1", "channel2", NULL};

static ethd_status set_text(const ethd_device_def *def, const ethd_setting *s, char *out, char *message) {
  const ethd__key key = s ? ethd__setting_key(def, s, message) : (ethd__key){0};
  if (!s) return ETHD_OK;
  if (strlen(s->value) >= ETHD_COUNTER_TEXT_MAX) return ethd__key_found(&key, ETHD_E_RANGE, "at most 95 characters");
  strcpy(out, s->value);
  return ETHD_OK;
}

static ethd_status set_small(const ethd_device_def *def, const ethd_setting *s, uint8_t *out, char *message) {
  static const ethd_param row = {"count", ETHD_WHOLE, 0, 255, 0, "number of a count or a channel"};
  const ethd__key key = s ? ethd__setting_key(def, s, message) : (ethd__key){0};
  double value = *out;
  ethd_status status = s ? ethd__key_value(&key, &row, &value) : ETHD_OK;
  *out = (uint8_t)value;
  return status;
}

ethd_status ethd__counter_settings_read(const ethd_device_def *def, ethd__counter_settings *out,
                                        char message[ETHD_MESSAGE_MAX]) {
  const ethd_setting *texts[KEYS] = {NULL};
  *out = (ethd__counter_settings){
      .device = {"/dev/counter0"}, .function = "quadrature x4", .count = {0, 1}, .channel = {0, 1}};
  ethd_params_default(ethd__counter_params, ETHD__COUNTER_PARAMS, out->p);
  ethd_status status = ethd_settings_read(&ethd_driver_counter, def, out->p, texts, message);
  if (!status) status = set_text(def, texts[FUNCTION], out->function, message);
  for (int j = 0; j < 2 && !status; j++) {
    status = set_text(def, texts[DEVICE + j], out->device[j], message);
    if (!status) status = set_small(def, texts[COUNT1 + j], &out->count[j], message);
    if (!status) status = set_small(def, texts[CHANNEL1 + j], &out->channel[j], message);
  }
  if (!out->device[1][0]) strcpy(out->device[1], out->device[0]);
  return status;
}
