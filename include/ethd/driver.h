/* A device moves the ring and measures ring and finger. Links from libethd-drivers and libethd.

   open [main] may block; start [main] enables; read and write [rt] are wait-free and bounded; service does
   one piece of blocking I/O: an I/O thread for each unit calls it, or the virtual clock in lock-step, so
   that a run with the same drivers repeats bit for bit; safe [any thread, any state] can't fail: zero torque
   from now on; stop [main] disables; close [main] frees. The simulated device is a driver like any other.

   A driver may have two pairs of functions: read and write for the plane, whose controller is control.h's, and
   read_space and write_space for space (space.h). A device is opened for one of the two.

   Any function except open and close may be NULL: the driver then has nothing to do, to read or to limit there. But a
   driver that has write or write_space must have safe too, because a device that moves must be able to stop.

   One device may consist of several drivers (a servo, its encoders, a proximity ring). Each adds its values to the
   sense and reads its part of the command. They are read and written in the order of their names: if two give the same
   number, the later one counts (servo, counter: the counter's angles). Drivers that have write start last and stop
   first, since an enabled drive mustn't wait for another driver.

        [device]                                  ethd_device_open
        driver = servo, ring                        servo  --.
        servo.map = svd48v.map                               +--> one ethd_device
        ring.port = /dev/ttyUSB0                    ring   --'

   A driver may be a shared object (driver = servo, file:mine.so), so that a vendor's SDK or another licence stays
   outside of this library; see ethd_driver_plugin. */
#ifndef ETHD_DRIVER_H
#define ETHD_DRIVER_H

#include <stddef.h>
#include <stdint.h>

#include "ethd/guard.h"
#include "ethd/param.h"
#include "ethd/sense.h"
#include "ethd/space.h"

ETHD_BEGIN_DECLS

/* The interface's version, 4, in 4 bits, and the size of each struct that a driver fills or gets, in units of 8 bytes,
   so that none grows unnoticed and a refusal names it: ethd_sense in 7 bits, ethd_space_sense and ethd_limits in 6,
   ethd_space_command, ethd_command and ethd_dynamics in 3 each. Never 0: that is a table whose abi wasn't set.
   (ethd_ability is part of ethd_space_sense.) */
#define ETHD_DRIVER_ABI                                                                                            \
  ((uint32_t)(4u << 28 | sizeof(ethd_sense) / 8 << 21 | sizeof(ethd_space_sense) / 8 << 15 |                       \
              sizeof(ethd_limits) / 8 << 9 | sizeof(ethd_space_command) / 8 << 6 | sizeof(ethd_command) / 8 << 3 | \
              sizeof(ethd_dynamics) / 8))
#define ETHD_DRIVERS_MAX 4         /* behind one device */
#define ETHD_DRIVERS_TEXT_MAX 1024 /* bytes of the list of their ids and files, the closing 0 included */
#define ETHD_DRIVER_FILE "file:"   /* before a path, among drivers' ids */
#define ETHD_UNITS_MAX 8           /* of blocking I/O, of all drivers together */
#define ETHD_FIGURES_MAX 64        /* of all drivers together */
#define ETHD_REMARKS_MAX 64        /* of one driver */

typedef struct ethd_driver ethd_driver;

/* One key of a configuration's [device] section, as text; a key that the driver doesn't know is an error. */
typedef struct ethd_setting {
  const char *key, *value;
  int line;
} ethd_setting;

/* The arguments of a device's opening. */
typedef struct ethd_device_def {
  const ethd_setup *setup; /* of the controller: arm, ring, period; NULL for a device in space */
  const ethd_setting *settings;
  uint32_t setting_count;
  const char *folder;            /* relative paths in settings start here */
  const char *file;              /* of the settings, for messages; NULL: they don't come from a file */
  int32_t is_virtual;            /* 1: instants come from a virtual clock, and service never waits; 0: they are those of
                         CLOCK_MONOTONIC */
  const ethd_space_setup *space; /* of the controller of a device in space; NULL: it is in the plane */
} ethd_device_def;

/* The state after `safe`. */
typedef enum ethd_safe_state {
  ETHD_SAFE_NO_TORQUE = 0, /* nothing drives the joints */
  ETHD_SAFE_NO_SPEED = 1,  /* the drives hold their positions */
  ETHD_SAFE_BRAKES = 2     /* the brakes are closed */
} ethd_safe_state;

/* A number about the device for the user: "feedback age p99", "s", 0.0012. */
typedef struct ethd_figure {
  const char *name, *unit;
  double value;
} ethd_figure;

struct ethd_driver {
  uint32_t size, abi;       /* sizeof(ethd_driver) as compiled; ETHD_DRIVER_ABI, exact */
  const char *id, *brief;   /* 1 to 31 of a-z 0-9 - _; 1 to ETHD_BRIEF_MAX printable ASCII characters */
  const ethd_param *params; /* its settings that are numbers or one of several words; may be NULL */
  uint32_t param_count;
  const char *const *keys; /* its other settings, ended by NULL; may be NULL */
  /* On failure message holds one line: file:line, the value found, the values allowed; if it stays empty, the status's
     sentence takes its place. If open sets *device, it is closed, also after a failure. */
  ethd_status (*open)(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]);
  ethd_status (*start)(void *device);
  /* Adds new data to *out, which is zero again after each step. ETHD_STATUS_STALE, or another positive status: this
     driver gives the joint samples and has no newer one. The loop then holds the torque until there is one. If *out
     reports a fault that ends the torque, it steps at once, with the last sample. Negative: the device can't be read
     any more. */
  ethd_status (*read)(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT;
  /* A command with `safe` set has zero torque. */
  ethd_status (*write)(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT;
  uint32_t (*units)(const void *device); /* of blocking I/O */
  /* unit: 0 .. units - 1. A positive status: there was nothing to do. */
  ethd_status (*service)(void *device, uint32_t unit, int64_t now_ns);
  void (*safe)(void *device) ETHD_RT;
  ethd_status (*stop)(void *device); /* NULL: safe is enough */
  void (*close)(void *device);
  ethd_limits (*limits)(const void *device); /* in space those that ethd_space_narrow takes */
  /* Writes at most `max` figures about the time since the start and returns how many. [main], also while it runs. */
  uint32_t (*figures)(const void *device, ethd_figure *out, uint32_t max);
  /* Returns the i-th sentence about the device for the user, such as a remaining risk; NULL after the last. [main] */
  const char *(*remark)(const void *device, uint32_t i);
  /* Asks the device to clear its own fault, which its service then does; this enables nothing. [any] */
  void (*clear)(void *device);
  /* Gives the device the present angles of its joints: q, rad. With q NULL the device finds them as its settings say,
     which may move them, slowly. Blocks; the device is stopped before and after. [main] */
  ethd_status (*home)(void *device, const double q[2]);
  /* Returns one line on why the last start or home failed; "" if no reason is known. [main] */
  const char *(*why)(const void *device);
  /* Returns the arm's dynamics, as far as the driver knows them; [arm] may give the rest. [main] */
  ethd_dynamics (*dynamics)(const void *device);
  /* As open, but without access to the device: it reads and checks settings and files. If it sets *device, the program
     asks that for limits, dynamics, figures and remarks, and closes it. NULL: these are known only once the device is
     open. [main] */
  ethd_status (*prepare)(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]);
  /* Returns which joints the device measures: bit 0 joint 1, bit 1 joint 2. It gets the *device of `prepare`, before
     anything is opened: a device that measures one joint alone is refused. NULL: not known, may be both. [main] */
  uint32_t (*joints)(const void *device);
  /* As read and write, for a device in space. The sense's x and v are the commanded ones if commands are velocities,
     and the measured ones if commands are forces. If the device changed a command, for example by scaling it to keep a
     joint's limit, the next sense has the changed command in `commanded`. */
  ethd_status (*read_space)(void *device, int64_t now_ns, ethd_space_sense *out) ETHD_RT;
  ethd_status (*write_space)(void *device, int64_t now_ns, const ethd_space_command *command) ETHD_RT;
  /* Returns the device's ability along n, a unit vector, in its present pose. NULL: not known. */
  ethd_ability (*able)(const void *device, const double n[3]) ETHD_RT;
  ethd_safe_state safe_is;
};

ETHD_API extern const ethd_driver ethd_driver_sim, ethd_driver_hello;
ETHD_API extern const ethd_driver ethd_driver_arm; /* in space, simulated */
ETHD_API extern const ethd_driver ethd_driver_servo;
ETHD_API extern const ethd_driver ethd_driver_ring;    /* a proximity ring, beside a driver of the motors */
ETHD_API extern const ethd_driver ethd_driver_zones;   /* on-off light barriers, beside a driver of the motors */
ETHD_API extern const ethd_driver ethd_driver_nail;    /* a plate on the nail, beside a driver of the motors */
ETHD_API extern const ethd_driver ethd_driver_camera;  /* a motion capture, beside a driver of the motors */
ETHD_API extern const ethd_driver ethd_driver_replay;  /* a recorded session, fed and compared */
ETHD_API extern const ethd_driver ethd_driver_counter; /* encoders, beside a driver of the motors */
ETHD_API extern const ethd_driver ethd_driver_excite;  /* multisine excitation, beside a driver of the motors */

/* All built-in drivers; the array ends with NULL. */
ETHD_API extern const ethd_driver *const ethd_drivers[];

/* The symbol that makes a shared object a driver, as plugin.h has one for laws; the object needs no other symbol:

        const ethd_driver ethd_driver_plugin = {.size = sizeof(ethd_driver), .abi = ETHD_DRIVER_ABI, .id = "mine", ...};
        cc -shared -fPIC mine.c -o mine.so $(pkg-config --cflags ethd-drivers)

   It stays loaded as long as the process lives. Like a law's file it is a program with your rights: its constructors
   run before any check, and the checks find mistakes; they don't stop an attacker. A table compiled with an older
   header of the same ABI may be shorter, down to ETHD_DRIVER_MIN; a longer one is refused. */
extern ETHD_API const ethd_driver ethd_driver_plugin;

#define ETHD_DRIVER_MIN (offsetof(ethd_driver, limits) + sizeof(void (*)(void)))

/* ---- a device: one or several drivers that are open ---- */

typedef struct ethd_device ethd_device;

/* Opens the drivers that `ids` names ("sim", "servo, ring", "servo, file:mine.so"), in that order, as one device of the
   plane or of space. They come from `from` (ended by NULL; NULL: ethd_drivers) and from files, whose paths start at
   def->folder. With several, a setting's key carries its driver's id ("ring.port"); with one it may. Before a driver is
   opened its table is checked: size, ABI, id, brief, settings, and functions that need each other (write and safe,
   units and service): ETHD_E_ABI, ETHD_E_SIZE, ETHD_E_ARGUMENT, ETHD_E_TABLE. ETHD_E_UNKNOWN, ETHD_E_DUPLICATE: an id,
   or a driver's key, with and without its id; ETHD_E_FILE, ETHD_E_LOAD, ETHD_E_SYMBOL: a file; ETHD_E_FULL: more than
   ETHD_DRIVERS_MAX, or units; ETHD_E_ARGUMENT: only one joint is measured, a driver doesn't work in such a device, or
   none takes commands in space; else the status of the driver's open. message holds one line. On failure *out is NULL.
   [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_open(const char *ids, const ethd_driver *const *from,
                                                      const ethd_device_def *def, ethd_device **out,
                                                      char message[ETHD_MESSAGE_MAX]);

/* The same by the drivers' `prepare`, without access to the device. For a driver without `prepare` only the name is
   checked, and its remark says so. *out gives limits, dynamics, figures and remarks, and must be closed. Fails as
   ethd_device_open does (ETHD_E_...). [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_prepare(const char *ids, const ethd_device_def *def, ethd_device **out,
                                                         char message[ETHD_MESSAGE_MAX]);

/* Closes the drivers and frees the device; NULL: does nothing. In a forked child it frees the memory without calling
   the drivers, which belong to the parent; start, stop, home and service refuse there (ETHD_E_DEVICE). [main] */
ETHD_API void ethd_device_close(ethd_device *device);

/* Call the functions of that name of all drivers of the device. A start that fails stops the drivers that had started;
   a driver whose start gives a positive status is stopped, too, and the start fails with ETHD_E_DEVICE. A driver
   without stop is made safe. q: rad. home: ETHD_E_ARGUMENT where no driver has one. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_start(ethd_device *device);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_stop(ethd_device *device);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_home(ethd_device *device, const double q[2]);

/* Read and write all drivers. The worst status counts: a driver's ETHD_E_..., ETHD_STATUS_STALE. [rt] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_read(ethd_device *device, int64_t now_ns, ethd_sense *out) ETHD_RT;
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_write(ethd_device *device, int64_t now_ns,
                                                       const ethd_command *command) ETHD_RT;

/* The same for a device in space: its drivers' read_space (a driver's ETHD_E_..., ETHD_STATUS_STALE) and write_space.
   [rt] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_read_space(ethd_device *device, int64_t now_ns,
                                                            ethd_space_sense *out) ETHD_RT;
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_write_space(ethd_device *device, int64_t now_ns,
                                                             const ethd_space_command *command) ETHD_RT;

/* Returns the device's ability along n, a unit vector of no unit, from the first of its drivers that knows it.
   [any, rt-safe] */
ETHD_API ethd_ability ethd_device_able(const ethd_device *device, const double n[3]) ETHD_RT;

/* Returns 1 for a device in space, 0 for one in the plane. [any, rt-safe] */
ETHD_API int32_t ethd_device_in_space(const ethd_device *device) ETHD_RT;

/* Returns the state after `safe`, from the first driver that takes commands. [any, rt-safe] */
ETHD_API ethd_safe_state ethd_device_safe_is(const ethd_device *device) ETHD_RT;

/* Makes all drivers safe; asks all of them to clear their own faults. [any] */
ETHD_API void ethd_device_safe(ethd_device *device) ETHD_RT;
ETHD_API void ethd_device_clear(ethd_device *device);

/* ethd_device_units returns how many units of blocking I/O the drivers have together; _service does one piece of I/O of
   a unit. Each unit has one caller. ETHD_E_ARGUMENT: no such unit; else the driver's status. [any] */
ETHD_API uint32_t ethd_device_units(const ethd_device *device);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_device_service(ethd_device *device, uint32_t unit, int64_t now_ns);

/* Return the narrowest of all limits; the dynamics, in which later drivers fill the unknown numbers of earlier ones;
   figures and remarks of all; `why` of the first driver that gives a reason, or "". [main] */
ETHD_API ethd_limits ethd_device_limits(const ethd_device *device);
ETHD_API ethd_dynamics ethd_device_dynamics(const ethd_device *device);
ETHD_API uint32_t ethd_device_figures(const ethd_device *device, ethd_figure *out, uint32_t max);
ETHD_API const char *ethd_device_remark(const ethd_device *device, uint32_t i);
ETHD_API const char *ethd_device_why(const ethd_device *device);

/* Reads a driver's settings, for its open: values[i] of its params and texts[i] of its keys. Those that the
   configuration doesn't have stay as they are. A key that the table doesn't have, or a value that it doesn't allow, is
   refused with file and line (ETHD_E_UNKNOWN, ETHD_E_RANGE). Values are in the unit of their row. values, texts: NULL
   where the table has none. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_settings_read(const ethd_driver *driver, const ethd_device_def *def,
                                                        double *values, const ethd_setting **texts,
                                                        char message[ETHD_MESSAGE_MAX]);

ETHD_END_DECLS

#endif
