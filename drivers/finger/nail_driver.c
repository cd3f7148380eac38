/* The driver of a plate on the nail with one optical sensor, on the proximity ring's line, beside a driver of the
   motors. It uses one count of a frame, with that sensor's calibration. */
#include <stdlib.h>

#include "ethd/maths.h"
#include "finger/bus.h"
#include "finger/nail.h"
#include "no_joints.h"
#include "proximity_ring/calibration.h"
#include "text/error_text.h"
#include "text/text.h"

enum { SENSOR = ETHD__BUS_PARAMS, ANGLE, REST, RANGE, NOISE, PARAMS };
enum { PORT, CALIBRATION, KEYS };

static const ethd_param params[PARAMS] = {
    ETHD__BUS_ROWS,
    [SENSOR] = {"sensor", ETHD_WHOLE, 0, ETHD__FRAME_SENSORS - 1, 0, "number of the sensor in a frame"},
    [ANGLE] = {"angle", "rad", -7, 7, 0, "direction from the ring's centre to the sensor, in R_0"},
    [REST] = {"rest", "m", 0, 0.1, 5e-3, "distance of the plate when the finger is centred"},
    [RANGE] = {"range", "m", 1e-4, 0.1, 10e-3, "largest distance at which a plate is recognised"},
    [NOISE] = {"noise", "m", 1e-7, 0.01, 0.02e-3, "sd of a distance, without the step of a count, which is added"},
};

static const char *const keys[] = {[PORT] = "port", [CALIBRATION] = "calibration", [KEYS] = NULL};

typedef struct nail_plate {
  ethd__finger_bus bus; /* first, as its functions ask */
  ethd__nail nail;
  ethd__sensor sensor;
  uint32_t index;
  double noise;
} nail_plate;

/* The step of a count in metres grows with the plate's distance. The variance of a rounded value is a twelfth of its
   step squared. */
static bool means(const void *sensor, const uint16_t counts[ETHD__FRAME_SENSORS], ethd__sighting *out) {
  const nail_plate *n = sensor;
  uint16_t c = counts[n->index];
  if (c == ETHD__FRAME_MISSING || c == ETHD__FRAME_SATURATED) return false;
  double distance = ethd__sensor_distance(&n->sensor, c);
  double step = distance - ethd__sensor_distance(&n->sensor, (uint16_t)(c + 1));
  out->noise = sqrt(n->noise * n->noise + step * step / 12);
  ethd_vec centre;
  if (!ethd__nail_centre(&n->nail, distance, &centre)) return false;
  out->centre = (ethd_vec3){centre.x, centre.y, 0};
  return true;
}

static ethd_status load(const ethd_device_def *def, const ethd_setting *file, nail_plate *n, char *message) {
  ethd__calibration calibration;
  ETHD__FREED char *path = ethd__path_join(def->folder, file->value);
  ethd_status status = path ? ethd__calibration_load(path, &calibration, message) : ethd__no_memory(message, NULL);
  if (status) return status;
  n->sensor = calibration.sensors[n->index];
  if (!isnan(n->sensor.dark)) return ETHD_OK;
  return ethd__say(message, ETHD_E_ARGUMENT, "%s:%d: device.%s: %s has no dark of sensor %u",
                   def->file ? def->file : "", file->line, file->key, file->value, n->index);
}

static ethd_status check(const ethd_device_def *def, const ethd_setting *texts[KEYS], char *message) {
  const char *what = !texts[PORT]          ? "port is missing: the sensor's serial port, as /dev/ttyUSB0"
                     : !texts[CALIBRATION] ? "calibration is missing: the file from counts to distances"
                                           : NULL;
  if (!what) return ETHD_OK;
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.%s", def->file ? def->file : "the defaults", what);
}

static ethd_status nail_prepare(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  const ethd_setting *texts[KEYS] = {NULL};
  double p[PARAMS];
  *device = NULL;
  ethd_params_default(params, PARAMS, p);
  ethd_status status = ethd_settings_read(&ethd_driver_nail, def, p, texts, message);
  if (!status) status = check(def, texts, message);
  if (status) return status;
  nail_plate *n = calloc(1, sizeof *n);
  if (!n) return ETHD_E_MEMORY;
  n->index = (uint32_t)p[SENSOR];
  n->noise = p[NOISE];
  n->nail = (ethd__nail){.rest = p[REST], .furthest = p[RANGE]};
  ethd_sincos(p[ANGLE], &n->nail.u.y, &n->nail.u.x);
  n->bus.means = means;
  n->bus.sensor = n;
  status = load(def, texts[CALIBRATION], n, message);
  if (status) {
    free(n);
    return status;
  }
  *device = n;
  return ethd__finger_bus_prepare(&n->bus, def, texts[PORT]->value, p, message);
}

static ethd_status nail_open(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = nail_prepare(def, device, message);
  return status ? status : ethd__finger_bus_open(*device, message);
}

static const char *remark(const void *device, uint32_t i) {
  (void)device;
  return i ? NULL : "the nail's plate measures one direction; across it the ring may touch the finger";
}

const ethd_driver ethd_driver_nail = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "nail",
    .brief = "plate on the nail with one optical distance, on a serial port, beside a driver that moves",
    .params = params,
    .param_count = PARAMS,
    .keys = keys,
    .open = nail_open,
    .read = ethd__finger_bus_read,
    .units = ethd__finger_bus_units,
    .service = ethd__finger_bus_service,
    .close = ethd__finger_bus_close,
    .limits = ethd__finger_bus_limits,
    .figures = ethd__finger_bus_figures,
    .remark = remark,
    .joints = ethd__no_joints,
    .prepare = nail_prepare,
};
