/* A device: what moves the ring and measures ring and finger.

   open [main] may block; start [main] enables; read and write [rt] are wait-free and bounded; service does
   one unit of blocking I/O: the I/O thread calls it, or the virtual clock in lock-step, so that a run with
   the same drivers repeats bit for bit; safe [rt, any state] can't fail: zero torque from now on;
   stop [main] disables; close [main] frees. The simulated device is a driver like any other. */
#ifndef ETHD_DRIVER_H
#define ETHD_DRIVER_H

#include <stdint.h>

#include "ethd/control.h"

ETHD_BEGIN_DECLS

#define ETHD_DRIVER_ABI 0u

/* One key of a configuration's [device] section, as text; keys the driver doesn't know are errors. */
typedef struct ethd_setting {
  const char *key, *value;
  int line;
} ethd_setting;

/* What a driver is opened with. */
typedef struct ethd_device_def {
  const ethd_setup *setup; /* arm, ring, period that the controller assumes */
  const ethd_setting *settings;
  uint32_t setting_count;
  const char *folder; /* relative paths in settings start here */
} ethd_device_def;

typedef struct ethd_driver {
  uint32_t size, abi;
  const char *id, *brief;
  const ethd_param *params; /* documentation of its numeric settings; may be NULL */
  uint32_t param_count;
  ethd_status (*open)(const ethd_device_def *def, void **device, ethd_error *error);
  ethd_status (*start)(void *device);
  ethd_status (*read)(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT;
  ethd_status (*write)(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT;
  ethd_status (*service)(void *device, int64_t now_ns); /* NULL: no blocking I/O */
  void (*safe)(void *device) ETHD_RT;
  ethd_status (*stop)(void *device);
  void (*close)(void *device);
  ethd_limits (*limits)(const void *device);
} ethd_driver;

ETHD_API extern const ethd_driver ethd_driver_sim;

ETHD_END_DECLS

#endif
