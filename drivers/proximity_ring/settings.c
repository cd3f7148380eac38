#include "proximity_ring/settings.h"

#include "text/error_text.h"

const ethd_param ethd__ring_params[ETHD__RING_PARAMS] = {
    [ETHD__RING_BAUD] = {"baud", "1/s", 9600, 12e6, 500000,
                         "baud rate of the board: 500000 or 400000, set by its strap"},
    [ETHD__RING_DELAY] = {"delay", "s", 0, 0.1, 0.0041,
                          "time from the first sample of a frame to the earliest arrival of its last byte"},
    [ETHD__RING_GATE] = {"gate", "m", 1e-5, 0.01, 1.5e-3,
                         "largest distance of a ray from the finger's circle; a ray further off is left out"},
    [ETHD__RING_SPEED] = {"speed", "m/s", 0.01, 100, 1, "highest speed of a distance; a faster one is left out"},
    [ETHD__RING_SLACK] = {"slack", "m", 1e-5, 0.01, 0.5e-3, "change of a distance that is allowed beyond that speed"},
    [ETHD__RING_PATIENCE] = {"patience", "s", 0.05, 60, 2, "longest wait for the first frames"},
    [ETHD__RING_EMPTY] = {"empty", "check|trust", 0, 1, 0,
                          "at the opening: measure the empty ring, or use the dark counts of the calibration"},
};

const char *const ethd__ring_keys[] = {"port", "calibration", NULL};

ethd_status ethd__ring_settings_read(const ethd_device_def *def, ethd__ring_settings *out,
                                     char message[ETHD_MESSAGE_MAX]) {
  const ethd_setting *texts[2] = {NULL, NULL};
  ethd_params_default(ethd__ring_params, ETHD__RING_PARAMS, out->p);
  ethd_status status = ethd_settings_read(&ethd_driver_ring, def, out->p, texts, message);
  out->port = texts[0];
  out->calibration = texts[1];
  if (status || out->port) return status;
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.port is missing: the ring's serial port, as /dev/ttyUSB0",
                   def->file ? def->file : "the defaults");
}
