#include "proximity_ring/settings.h"

#include <math.h>
#include <string.h>

#include "file/error_text.h"
#include "file/text.h"

const ethd_param ethd__ring_params[ETHD__RING_PARAMS] = {
    [ETHD__RING_BAUD] = {"baud", "1/s", 9600, 12e6, 500000, "of the board's UART: 500000 or 400000, by its strap"},
    [ETHD__RING_DELAY] = {"delay", "s", 0, 0.1, 0.0041, "from the beginning of a frame's sampling to its last byte's earliest arrival"},
    [ETHD__RING_GATE] = {"gate", "m", 1e-5, 0.01, 1.5e-3, "of a ray from the finger's circle: further off it is left out"},
    [ETHD__RING_SPEED] = {"speed", "m/s", 0.01, 100, 1, "of a distance: a faster one is left out"},
    [ETHD__RING_SLACK] = {"slack", "m", 1e-5, 0.01, 0.5e-3, "that a distance may change beyond that speed"},
    [ETHD__RING_PATIENCE] = {"patience", "s", 0.05, 60, 2, "for the first frames"},
    [ETHD__RING_EMPTY] = {"empty", "check|trust", 0, 1, 0, "measure the empty ring when it is opened, or trust the file's darks"},
};

static const char *file(const ethd_device_def *def) { return def->file ? def->file : "the defaults"; }

static ethd_status found(const ethd_device_def *def, const ethd_setting *s, ethd_status status, const char *allowed, char *message) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(message, status, "%s:%d: device.%s: found %s, %s is allowed", file(def), s->line, s->key,
                   ethd__quote(s->value, strlen(s->value), quote), allowed);
}

static ethd_status set_number(const ethd_device_def *def, const ethd_setting *s, const ethd_param *row, double *out, char *message) {
  char allowed[80];
  double value;
  snprintf(allowed, sizeof allowed, "%.10g to %.10g %s", row->min, row->max, row->unit);
  if (!ethd__number(s->value, strlen(s->value), &value) || !(value >= row->min && value <= row->max))
    return found(def, s, ETHD_E_RANGE, allowed, message);
  *out = value;
  return ETHD_OK;
}

static ethd_status set(const ethd_device_def *def, const ethd_setting *s, ethd__ring_settings *out, char *message) {
  int i = ethd_params_find(ethd__ring_params, ETHD__RING_PARAMS, s->key);
  if (!strcmp(s->key, "port")) return out->port = s, ETHD_OK;
  if (!strcmp(s->key, "calibration")) return out->calibration = s, ETHD_OK;
  if (i < 0)
    return ethd__say(message, ETHD_E_UNKNOWN,
                     "%s:%d: device.%s: a ring knows port, calibration, baud, delay, gate, speed, slack, patience, empty",
                     file(def), s->line, s->key);
  const ethd_param *row = &ethd__ring_params[i];
  if (!ethd_param_words(row)) return set_number(def, s, row, &out->p[i], message);
  int word = ethd_param_word(row, s->value);
  if (word < 0) return found(def, s, ETHD_E_UNKNOWN, row->unit, message);
  out->p[i] = word;
  return ETHD_OK;
}

ethd_status ethd__ring_settings_read(const ethd_device_def *def, ethd__ring_settings *out, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  memset(out, 0, sizeof *out);
  ethd_params_default(ethd__ring_params, ETHD__RING_PARAMS, out->p);
  for (uint32_t i = 0; i < def->setting_count && !status; i++) status = set(def, &def->settings[i], out, message);
  if (status || out->port) return status;
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.port is missing: the ring's serial port, as /dev/ttyUSB0", file(def));
}
