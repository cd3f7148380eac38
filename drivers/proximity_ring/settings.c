#include "proximity_ring/settings.h"

#include "text/error_text.h"

const ethd_param ethd__ring_params[ETHD__RING_PARAMS] = {
    [ETHD__RING_BAUD] = {"baud", "1/s", 9600, 12e6, 500000, "of the board's UART: 500000 or 400000, by its strap"},
    [ETHD__RING_DELAY] = {"delay", "s", 0, 0.1, 0.0041,
                          "from the beginning of a frame's sampling to its last byte's earliest arrival"},
    [ETHD__RING_GATE] = {"gate", "m", 1e-5, 0.01, 1.5e-3,
                         "of a ray from the finger's circle: further off it is left out"},
    [ETHD__RING_SPEED] = {"speed", "m/s", 0.01, 100, 1, "of a distance: a faster one is left out"},
    [ETHD__RING_SLACK] = {"slack", "m", 1e-5, 0.01, 0.5e-3, "that a distance may change beyond that speed"},
    [ETHD__RING_PATIENCE] = {"patience", "s", 0.05, 60, 2, "for the first frames"},
    [ETHD__RING_EMPTY] = {"empty", "check|trust", 0, 1, 0,
                          "measure the empty ring when it is opened, or trust the file's darks"},
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
