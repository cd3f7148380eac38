#include "sim/settings.h"

#include <math.h>

#include "finger/zones.h"

const ethd_param ethd__sim_params[ETHD__SIM_PARAMS] = {
    [ETHD__SIM_STEP] = {"step", "s", 1e-7, 1e-2, 1e-3, "longest integration step"},
    [ETHD__SIM_TOLERANCE] = {"tolerance", "m/s", 1e-14, 1, ETHD_SIM_GOLDEN,
                             "bound on the last terms of a step's series"},
    [ETHD__SIM_SEED] = {"seed", ETHD_WHOLE, 0, 0x1p53, 1, "key of every random number"},
    [ETHD__SIM_TAP] = {"tap", ETHD_WHOLE, 0, 0x1p53, 0, "number of the tap, which fixes its random numbers"},
    [ETHD__SIM_SPEED] = {"speed", "m/s", 1e-3, 10, 0.4, "commanded speed of the finger"},
    [ETHD__SIM_MEET_X] = {"meet_x", "m", -10, 10, 0.25,
                          "x of the ring's centre where the ring meets the wall on its left"},
    [ETHD__SIM_MEET_Y] = {"meet_y", "m", -10, 10, 0.25, "y of that place"},
    [ETHD__SIM_FINGER] = {"finger", "centre|rays|zones|nail|camera", 0, ETHD_READING_COUNT - 1, 0,
                          "sensor of the finger; not given: as in the plant file"},
    [ETHD__SIM_RATE] = {"finger_rate", "Hz", 1, 1e5, 300, "rate of the readings; not given: the sensor's own"},
    [ETHD__SIM_LATENCY] = {"finger_latency", "s", 0, 1, 0,
                           "time from a sample to its delivery; not given: the sensor's own"},
    [ETHD__SIM_NOISE] = {"finger_noise", "m", 0, 0.1, 0,
                         "sd of a centre, a barrier's reach or a distance; not given: the sensor's own"},
    [ETHD__SIM_ZONES] = {"zones", ETHD_WHOLE, ETHD__ZONES_MIN, ETHD__ZONES_MAX, 12, "number of light barriers"},
    [ETHD__SIM_REACH] = {"zone_reach", "m", 1e-4, 0.1, 3.5e-3,
                         "distance of the finger below which a barrier switches on"},
    [ETHD__SIM_ANGLE] = {"nail_angle", "rad", -7, 7, 0,
                         "direction from the ring's centre to the nail's sensor, in R_0"},
    [ETHD__SIM_EMPTY] = {"empty", "no|yes", 0, 1, 0, "yes: no finger in the ring, and no readings"},
};

const char *const ethd__sim_keys[] = {"plant", NULL};

ethd_status ethd__sim_settings_read(const ethd_device_def *def, ethd__sim_settings *out,
                                    char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__sim_settings){.plant = NULL};
  ethd_params_default(ethd__sim_params, ETHD__SIM_PARAMS, out->p);
  for (int i = ETHD__SIM_FINGER; i <= ETHD__SIM_ANGLE; i++) out->p[i] = (double)NAN;
  return ethd_settings_read(&ethd_driver_sim, def, out->p, &out->plant, message);
}

void ethd__sim_settings_finger(const ethd__sim_settings *s, ethd_plant *plant) {
  if (!isnan(s->p[ETHD__SIM_FINGER])) ethd_plant_finger(plant, (int32_t)s->p[ETHD__SIM_FINGER]);
  double zones = plant->zones;
  double *const to[] = {
      [ETHD__SIM_RATE] = &plant->rate, [ETHD__SIM_LATENCY] = &plant->latency,  [ETHD__SIM_NOISE] = &plant->noise,
      [ETHD__SIM_ZONES] = &zones,      [ETHD__SIM_REACH] = &plant->zone_reach, [ETHD__SIM_ANGLE] = &plant->nail_angle};
  for (int i = ETHD__SIM_RATE; i <= ETHD__SIM_ANGLE; i++)
    if (!isnan(s->p[i])) *to[i] = s->p[i];
  plant->zones = (int32_t)zones;
}
