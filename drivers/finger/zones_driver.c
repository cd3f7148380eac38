/* The driver of a ring of on-off light barriers on the proximity ring's line, beside a driver of the motors. A barrier
   is lit if its count reaches `level`. */
#include <stdlib.h>

#include "finger/bus.h"
#include "finger/zones.h"
#include "no_joints.h"
#include "text/error_text.h"

enum { ZONES = ETHD__BUS_PARAMS, REACH, SWITCHING, LEVEL, PARAMS };

static const ethd_param params[PARAMS] = {
    ETHD__BUS_ROWS,
    [ZONES] = {"zones", ETHD_WHOLE, ETHD__ZONES_MIN, ETHD__ZONES_MAX, 12,
               "number of light barriers, from sensor 0 of a frame on"},
    [REACH] = {"reach", "m", 1e-4, 0.1, 3.5e-3, "distance of the finger below which a barrier switches on"},
    [SWITCHING] = {"switching", "m", 0, 0.01, 0.1e-3, "sd of the distance at which a barrier switches"},
    [LEVEL] = {"level", "1", 1, 65535, 32768, "least counts of a barrier that is on"},
};

static const char *const keys[] = {"port", NULL};

typedef struct zones_ring {
  ethd__finger_bus bus; /* first, as its functions ask */
  ethd__zones zones;
  double level;
} zones_ring;

/* Refuses a frame in which a barrier doesn't answer, since it may be lit or not. */
static bool means(const void *sensor, const uint16_t counts[ETHD__FRAME_SENSORS], ethd__sighting *out) {
  const zones_ring *r = sensor;
  uint32_t lit = 0;
  for (uint32_t k = 0; k < r->zones.count; k++) {
    if (counts[k] == ETHD__FRAME_MISSING) return false;
    lit |= (uint32_t)(counts[k] >= r->level) << k;
  }
  ethd_vec centre;
  if (!ethd__zones_centre(&r->zones, lit, &centre, &out->noise)) return false;
  out->centre = (ethd_vec3){centre.x, centre.y, 0};
  return true;
}

static ethd_status zones_prepare(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  const ethd_setting *port = NULL;
  double p[PARAMS];
  *device = NULL;
  ethd_params_default(params, PARAMS, p);
  ethd_status status = ethd_settings_read(&ethd_driver_zones, def, p, &port, message);
  if (status) return status;
  if (!port)
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.port is missing: the barriers' serial port, as /dev/ttyUSB0",
                     def->file ? def->file : "the defaults");
  zones_ring *r = *device = calloc(1, sizeof *r);
  if (!r) return ETHD_E_MEMORY;
  ethd__zones_prepare((uint32_t)p[ZONES], p[REACH], def->setup->ring_radius, def->setup->finger_radius, p[SWITCHING],
                      &r->zones);
  r->level = p[LEVEL];
  r->bus.means = means;
  r->bus.sensor = r;
  return ethd__finger_bus_prepare(&r->bus, def, port->value, p, message);
}

static ethd_status zones_open(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = zones_prepare(def, device, message);
  return status ? status : ethd__finger_bus_open(*device, message);
}

const ethd_driver ethd_driver_zones = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "zones",
    .brief = "ring of on-off light barriers on a serial port, beside a driver that moves",
    .params = params,
    .param_count = PARAMS,
    .keys = keys,
    .open = zones_open,
    .read = ethd__finger_bus_read,
    .units = ethd__finger_bus_units,
    .service = ethd__finger_bus_service,
    .close = ethd__finger_bus_close,
    .limits = ethd__finger_bus_limits,
    .figures = ethd__finger_bus_figures,
    .joints = ethd__no_joints,
    .prepare = zones_prepare,
};
