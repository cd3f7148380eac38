/* A device: what moves the ring and measures ring and finger. Links from libethd-drivers and libethd.

   open [main] may block; start [main] enables; read and write [rt] are wait-free and bounded; service does
   one piece of blocking I/O: an I/O thread for each unit calls it, or the virtual clock in lock-step, so
   that a run with the same drivers repeats bit for bit; safe [any thread, any state] can't fail: zero torque
   from now on; stop [main] disables; close [main] frees. The simulated device is a driver like any other.

   A driver has what it has something to say in: any function but open and close may be NULL, and then there
   is nothing to do, to read or to limit. Only what takes torque must be able to let go: no write without safe.

   Several drivers may stand behind one device (a servo, its encoders, a proximity ring): each adds what it
   knows to the sense, and takes from the command what is its own.

        [device]                                  ethd_device_open
        driver = servo, ring                        servo  --.
        servo.map = svd48v.map                               +--> one driver, one device
        ring.port = /dev/ttyUSB0                    ring   --'                                            */
#ifndef ETHD_DRIVER_H
#define ETHD_DRIVER_H

#include <stdint.h>

#include "ethd/guard.h"
#include "ethd/param.h"
#include "ethd/sense.h"

ETHD_BEGIN_DECLS

#define ETHD_DRIVER_ABI 0u
#define ETHD_DRIVERS_MAX 4       /* behind one device */
#define ETHD_DRIVERS_TEXT_MAX 96 /* bytes of their ids in a row, the closing 0 included */
#define ETHD_UNITS_MAX 8         /* of blocking I/O, of all drivers together */
#define ETHD_FIGURES_MAX 64      /* likewise */

typedef struct ethd_driver ethd_driver;

/* One key of a configuration's [device] section, as text; keys the driver doesn't know are errors. */
typedef struct ethd_setting {
  const char *key, *value;
  int line;
} ethd_setting;

struct ethd_setup; /* of control.h, for drivers that look into it */

/* What a device is opened with. */
typedef struct ethd_device_def {
  const struct ethd_setup *setup; /* arm, ring, period that the controller assumes */
  const ethd_setting *settings;
  uint32_t setting_count;
  const char *folder; /* relative paths in settings start here */
  const char *file;   /* of the settings, for messages; NULL: they weren't in a file */
  int32_t is_virtual; /* 1: instants come from a virtual clock, and service waits for nothing; 0: they are
                         CLOCK_MONOTONIC's */
} ethd_device_def;

/* A number about the device for people: "feedback age p99", "s", 0.0012. */
typedef struct ethd_figure {
  const char *name, *unit;
  double value;
} ethd_figure;

struct ethd_driver {
  uint32_t size, abi;
  const char *id, *brief;
  const ethd_param *params; /* its settings that are numbers or one of several words; may be NULL */
  uint32_t param_count;
  const char *const *keys; /* its other settings, ended by NULL; may be NULL */
  /* On failure message holds one line: file:line, what was found, what is allowed; left empty, it is the
     status's sentence. What open leaves in *device is closed, also after a failure, unless it is NULL. */
  ethd_status (*open)(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]);
  ethd_status (*start)(void *device);
  /* Adds what is new to *out, which is zero when a step is over. ETHD_STALE: a joint sample is due from
     this driver and there is no newer one; the loop then holds the torque and steps when there is, or at
     once, with the last sample, when *out names a fault that ends the torque. Negative: nothing can be known of
     the device. */
  ethd_status (*read)(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT;
  /* Torque is zero where the command is the safe one. */
  ethd_status (*write)(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT;
  uint32_t (*units)(const void *device); /* of blocking I/O */
  /* unit: 0 .. units - 1. A positive status: there was nothing to do. */
  ethd_status (*service)(void *device, uint32_t unit, int64_t now_ns);
  void (*safe)(void *device) ETHD_RT;
  ethd_status (*stop)(void *device); /* NULL: as safe */
  void (*close)(void *device);
  ethd_limits (*limits)(const void *device);
  /* At most `max` figures, since the start; returns how many. [main], while it runs too. */
  uint32_t (*figures)(const void *device, ethd_figure *out, uint32_t max);
  /* What people should know of the device: the i-th sentence, a risk that stays open; NULL behind the last. [main] */
  const char *(*remark)(const void *device, uint32_t i);
  /* Asks the device to leave a fault of its own, which its service then does; nothing is enabled by it. [any] */
  void (*clear)(void *device);
  /* Finds out where the joints stand: q, rad, where they stand now, or NULL: as the device's settings say, which may
     move them, slowly. Blocks; the device is stopped before and after. [main] */
  ethd_status (*home)(void *device, const double q[2]);
  /* Why the last start or home failed, one line; "" where there is nothing to say. [main] */
  const char *(*why)(const void *device);
  /* What moves the ring, as far as the driver knows; what it doesn't, [arm] may say. [main] */
  ethd_dynamics (*dynamics)(const void *device);
};

ETHD_API extern const ethd_driver ethd_driver_sim, ethd_driver_hello;
ETHD_API extern const ethd_driver ethd_driver_servo;
ETHD_API extern const ethd_driver ethd_driver_ring;    /* a proximity ring, beside a driver that moves */
ETHD_API extern const ethd_driver ethd_driver_replay;  /* a recorded session, fed and compared */
ETHD_API extern const ethd_driver ethd_driver_counter; /* encoders, beside a driver that moves */

/* All that are built in, ended by NULL. */
ETHD_API extern const ethd_driver *const ethd_drivers[];

/* Opens the drivers that `ids` names ("sim", "servo, ring"), in that order, out of `from` (ended by NULL;
   NULL: ethd_drivers), as one. With several, a setting's key carries its driver's id ("ring.port"); with one
   it may. *driver and *device then go together, and *driver has all functions but open; device is closed by
   driver->close. Limits are the narrowest of all. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_open(const char *ids, const ethd_driver *const *from,
                                                      const ethd_device_def *def, const ethd_driver **driver,
                                                      void **device, char message[ETHD_MESSAGE_MAX]);

/* For a driver's open: what the configuration says by the driver's own table, values[i] of its params and
   texts[i] of its keys; where it says nothing they stay as they are. Keys that the table hasn't, and values
   that it doesn't allow, are refused by file and line. values, texts: NULL where the table has none. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_settings_read(const ethd_driver *driver, const ethd_device_def *def,
                                                        double *values, const ethd_setting **texts,
                                                        char message[ETHD_MESSAGE_MAX]);

ETHD_END_DECLS

#endif
