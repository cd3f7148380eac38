/* The simulated device's keys of the [device] section. */
#ifndef ETHD__SIM_SETTINGS_H
#define ETHD__SIM_SETTINGS_H

#include "ethd/driver.h"
#include "ethd/sim.h"

enum {
  ETHD__SIM_STEP,
  ETHD__SIM_TOLERANCE,
  ETHD__SIM_SEED,
  ETHD__SIM_TAP,
  ETHD__SIM_SPEED,
  ETHD__SIM_MEET_X,
  ETHD__SIM_MEET_Y,
  ETHD__SIM_FINGER,
  ETHD__SIM_RATE,
  ETHD__SIM_LATENCY,
  ETHD__SIM_NOISE,
  ETHD__SIM_ZONES,
  ETHD__SIM_REACH,
  ETHD__SIM_ANGLE,
  ETHD__SIM_EMPTY,
  ETHD__SIM_PARAMS
};

extern const ethd_param ethd__sim_params[ETHD__SIM_PARAMS];
extern const char *const ethd__sim_keys[]; /* ends with NULL */

typedef struct ethd__sim_settings {
  double p[ETHD__SIM_PARAMS]; /* ETHD__SIM_FINGER to ETHD__SIM_ANGLE: NaN: the plant's value */
  const ethd_setting *plant;  /* NULL: ETHD__PLANT */
} ethd__sim_settings;

/* Reads the settings; a refusal names the setting's line. [main] */
ethd_status ethd__sim_settings_read(const ethd_device_def *def, ethd__sim_settings *out,
                                    char message[ETHD_MESSAGE_MAX]);

/* Puts the finger sensor of the settings into a plant. [any] */
void ethd__sim_settings_finger(const ethd__sim_settings *settings, ethd_plant *plant);

#endif
